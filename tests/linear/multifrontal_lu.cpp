#include <delassus/linear/block_lu.hpp>
#include <delassus/linear/multifrontal_lu.hpp>
#include <delassus/linear/sparse_lu.hpp>

#include <Eigen/Dense>

#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "catch.hpp"
#include "linear/block_graphs.hpp"

namespace multifrontal_lu_tests {

using namespace delassus;
using namespace block_graphs;

namespace {

/// The same unsymmetric matrix for any factorization: 1, random blocks, and a diagonal that outweighs its row
/// by `dominance`.
template <int w, class F>
void fill(F& f, Index blocks, const Pairs& pairs, double dominance) {
  f.set_identity();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> draw(-1, 1);
  const auto add = [&](Index i, Index j) {
    f.at(i, j) += Mat<w, w>::NullaryExpr([&] { return draw(random); });
  };
  for (Index i = 0; i < blocks; ++i) add(i, i);
  for (auto [i, j] : pairs) add(i, j), add(j, i);
  std::vector<double> reach(blocks, double(w));
  for (auto [i, j] : pairs) reach[i] += w, reach[j] += w;
  for (Index i = 0; i < blocks; ++i) f.at(i, i) += dominance * reach[i] * Mat<w, w>::Identity();
}

/// A dense matrix that takes blocks as a factorization does.
template <int w>
struct Dense {
  Eigen::MatrixXd A;
  void set_identity() { A.setIdentity(); }
  auto at(Index i, Index j) { return A.block<w, w>(w * i, w * j); }
};

template <int w, class F>
std::vector<Vec<w>> solved(const F& f, Index blocks) {
  std::vector<Vec<w>> x(blocks);
  for (Index i = 0; i < blocks; ++i) x[i] = Vec<w>::LinSpaced(-1 + i, 2 - 3 * i);
  f.solve(x);
  return x;
}

template <int w>
double difference(const std::vector<Vec<w>>& a, const std::vector<Vec<w>>& b) {
  double apart = 0, size = 0;
  for (std::size_t i = 0; i < a.size(); ++i) apart += (a[i] - b[i]).squaredNorm(), size += b[i].squaredNorm();
  return std::sqrt(apart / size);
}

template <int w>
void compare(Index blocks, const Pairs& pairs) {
  CAPTURE(w, blocks, pairs.size());
  MultifrontalLu<w, double> fronts;
  fronts.analyse(blocks, pairs);
  Dense<w> dense{Eigen::MatrixXd(w * blocks, w * blocks)};
  for (int repeat = 0; repeat < 2; ++repeat) {
    fill<w>(fronts, blocks, pairs, 1);
    REQUIRE(fronts.factor());
  }
  fill<w>(dense, blocks, pairs, 1);
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(dense.A);
  std::vector<Vec<w>> expected(blocks);
  Eigen::VectorXd b(w * blocks);
  for (Index i = 0; i < blocks; ++i) b.segment<w>(w * i) = Vec<w>::LinSpaced(-1 + i, 2 - 3 * i);
  b = lu.solve(b).eval();
  for (Index i = 0; i < blocks; ++i) expected[i] = b.segment<w>(w * i);
  CHECK(difference<w>(solved<w>(fronts, blocks), expected) <= 1e-13);
}

}  // namespace

// A dominant diagonal keeps the condition below ten and the growth below two; 1e-13 is a thousand roundings.
TEST_CASE("the fronts of an LU solve what a dense factorization solves") {
  for (const Index n : {2, 3, 9}) compare<3>(Net(n).joints(), Net(n).pairs);
  for (const Index n : {2, 4, 6}) compare<6>(n * n * n, grid<6>(n, n, n, 1).pairs);
  compare<3>(40, {});
  std::mt19937 random(3);
  std::uniform_int_distribution<Index> pick(0, 79);
  Pairs pairs;  // repeats and both orders occur
  while (pairs.size() < 600)
    if (const Index i = pick(random), j = pick(random); i != j) pairs.emplace_back(i, j);
  compare<3>(80, pairs);
}

// Both pivots have zeros on their diagonal; (3, 1, 2, 1, −1, 2) is the answer to what is asked. The condition
// is below a hundred.
TEST_CASE("rows are exchanged inside a block of a front") {
  MultifrontalLu<3, double> A;
  A.analyse(2, Pairs{{0, 1}});
  A.set_identity();
  for (const Index i : {0, 1}) A.at(i, i) << 0, 2, 0, 0, 0, 4, 8, 0, 0;
  A.at(0, 1).setIdentity();
  A.at(1, 0) = 2 * Mat3::Identity();
  REQUIRE(A.factor());
  std::vector<Vec3> x{Vec3(3, 7, 26), Vec3(4, 10, 12)};
  A.solve(x);
  CHECK((x[0] - Vec3(3, 1, 2)).norm() <= 1e-14);
  CHECK((x[1] - Vec3(1, -1, 2)).norm() <= 1e-14);
}

TEST_CASE("a singular pivot block of a front and one that is not finite are refused") {
  for (const double last : {0.0, std::numeric_limits<double>::quiet_NaN()}) {
    MultifrontalLu<3, double> A;
    A.analyse(2, Pairs{{0, 1}});
    A.set_identity();
    A.at(1, 1)(2, 2) = last;
    REQUIRE(!A.factor());
  }
}

TEST_CASE("block pivots tell the sign of the determinant") {
  const Net net(4);
  for (const bool is_flipped : {false, true}) {
    BlockLu<3, double> A;
    A.analyse(net.joints(), net.pairs);
    fill<3>(A, net.joints(), net.pairs, 1);
    for (Index j = 0; is_flipped && j < net.joints(); ++j) {  // the first row of block 7 with the other sign
      const bool is_there = j == 7 || std::any_of(net.pairs.begin(), net.pairs.end(), [&](auto p) {
                              return p == std::pair(Index(7), j) || p == std::pair(j, Index(7));
                            });
      if (is_there) A.at(7, j).row(0) *= -1;
    }
    REQUIRE(A.factor());
    CHECK(A.is_negative() == is_flipped);
  }
}

TEST_CASE("a chain is factored by blocks, a large net by fronts, and a net by either the same") {
  Pairs chain;
  for (Index i = 1; i < 5000; ++i) chain.emplace_back(i - 1, i);
  SparseLu<3, double> f;
  f.analyse(5000, chain);
  CHECK(!f.has_fronts());
  const Net net(24);
  f.analyse(net.joints(), net.pairs);
  REQUIRE(f.has_fronts());
  BlockLu<3, double> plain;
  plain.analyse(net.joints(), net.pairs);
  fill<3>(f, net.joints(), net.pairs, 1);
  fill<3>(plain, net.joints(), net.pairs, 1);
  REQUIRE((f.factor() && plain.factor()));
  CHECK(difference<3>(solved<3>(f, net.joints()), solved<3>(plain, net.joints())) <= 1e-13);
}

}  // namespace multifrontal_lu_tests
