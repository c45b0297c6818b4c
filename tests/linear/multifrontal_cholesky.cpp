#include <delassus/linear/block_cholesky.hpp>
#include <delassus/linear/factorization.hpp>
#include <delassus/linear/multifrontal_cholesky.hpp>

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>

#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "catch.hpp"
#include "linear/block_graphs.hpp"

namespace multifrontal_cholesky_tests {

using namespace delassus;
using namespace block_graphs;

static_assert(Factorization<BlockCholesky<3, double>, 3, double>);
static_assert(Factorization<MultifrontalCholesky<3, double>, 3, double>);
static_assert(Factorization<MultifrontalCholesky<6, float>, 6, float>);

namespace {

/// A random graph: repeats and both orders occur, and parts without any neighbour.
template <int w>
Blocks<w> random_graph(Index n, Index pairs, unsigned seed) {
  Blocks<w> g;
  g.n = n;
  std::mt19937 random(seed);
  std::uniform_int_distribution<Index> pick(0, n - 1);
  while (Index(g.pairs.size()) < pairs) {
    const Index i = pick(random), j = pick(random);
    if (i != j) g.pairs.emplace_back(i, j);
  }
  g.draw(seed);
  return g;
}

/// |A x − b| / |b| of a solve with a random b.
template <int w, class T>
double residual(const Blocks<w>& g, const MultifrontalCholesky<w, T>& f) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> draw(-1, 1);
  std::vector<Vec<w, T>> x(g.n);
  Eigen::VectorXd b(w * g.n), solved(w * g.n);
  for (Index i = 0; i < g.n; ++i) x[i] = Vec<w, T>::NullaryExpr([&] { return T(draw(random)); });
  for (Index i = 0; i < g.n; ++i) b.segment<w>(w * i) = x[i].template cast<double>();
  f.solve(x);
  for (Index i = 0; i < g.n; ++i) solved.segment<w>(w * i) = x[i].template cast<double>();
  return (g.sparse() * solved - b).norm() / b.norm();
}

}  // namespace

// |A| / shift < 200 here, so a backward stable solve leaves |A x − b| ≤ c n ε |A| |x| ≤ 200 c n ε |b|; the
// sums of a front are far shorter than n, and 1e-12 = 4500 ε holds with c n ~ 20.
TEST_CASE(
    "the multifrontal factor solves what was put in: grids and random graphs, with and without positions") {
  for (const auto& g :
       {grid<3>(1, 1, 1, 1), grid<3>(2, 3, 2, 2), grid<3>(6, 5, 9, 3), grid<3>(30, 1, 1, 4),
        random_graph<3>(40, 60, 5), random_graph<3>(150, 100, 6), random_graph<3>(60, 900, 7)}) {
    MultifrontalCholesky<3, double> f;
    f.analyse(g.n, g.pairs);
    g.fill(f);
    REQUIRE(f.factor());
    CHECK(residual(g, f) < 1e-12);
    if (g.positions.empty()) continue;
    f.analyse(g.n, g.pairs, g.positions);
    g.fill(f);
    REQUIRE(f.factor());
    CHECK(residual(g, f) < 1e-12);
  }
  const auto six = grid<6>(4, 4, 5, 8);
  MultifrontalCholesky<6, double> f;
  f.analyse(six.n, six.pairs, six.positions);
  six.fill(f);
  REQUIRE(f.factor());
  CHECK(residual(six, f) < 1e-12);
}

TEST_CASE("the multifrontal solution is that of Eigen's LDLT") {
  const auto g = grid<3>(7, 6, 8, 11);
  MultifrontalCholesky<3, double> f;
  f.analyse(g.n, g.pairs, g.positions);
  g.fill(f);
  REQUIRE(f.factor());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> ldlt(g.sparse());
  std::vector<Vec3> x(g.n, Vec3(1, -2, 3));
  const Eigen::VectorXd y = ldlt.solve(Eigen::VectorXd(Vec3(1, -2, 3).replicate(g.n, 1)));
  f.solve(x);
  // cond A < 200: both are within 200 c ε of the solution.
  for (Index i = 0; i < g.n; ++i) CHECK((x[i] - y.segment<3>(3 * i)).norm() < 1e-12 * y.norm());
}

TEST_CASE("a float factor solves to single precision") {
  const auto g = grid<3>(6, 5, 9, 3);
  MultifrontalCholesky<3, float> f;
  f.analyse(g.n, g.pairs, g.positions);
  g.fill(f);
  REQUIRE(f.factor());
  CHECK(residual(g, f) < 5e-4);   // 4500 ε again
  CHECK(residual(g, f) > 1e-12);  // it was float
}

TEST_CASE("the compliance of nodes is their part of the inverse") {
  const auto g = grid<3>(5, 4, 6, 21);
  MultifrontalCholesky<3, double> f;
  f.analyse(g.n, g.pairs, g.positions);
  g.fill(f);
  REQUIRE(f.factor());
  const Eigen::MatrixXd inverse = Eigen::MatrixXd(g.sparse()).inverse();
  for (const std::vector<Index>& nodes : {std::vector<Index>{17}, {119, 0, 60, 61, 3}, {5, 4, 3, 2, 1, 0}}) {
    const int m = 3 * int(nodes.size());
    std::vector<double> C(m * m);
    f.compliance(nodes, C);
    for (int a = 0; a < m; ++a)
      for (int b = 0; b < m; ++b) {
        const double exact = inverse(3 * nodes[a / 3] + a % 3, 3 * nodes[b / 3] + b % 3);
        CHECK(std::abs(C[a + b * m] - exact) < 1e-12);  // |A⁻¹| ≤ 1 / shift = 1
      }
  }
}

TEST_CASE(
    "a matrix that is not positive definite is refused, wherever it fails, and the next good one is "
    "factored") {
  const auto g = grid<3>(4, 4, 4, 31);
  MultifrontalCholesky<3, double> f;
  f.analyse(g.n, g.pairs, g.positions);
  for (const Index node : {0, 21, 42, 63})
    for (const double bad :
         {-1e6, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      g.fill(f);
      f.add_diagonal(node, bad * Mat3::Identity());
      CHECK_FALSE(f.factor());
    }
  g.fill(f);
  REQUIRE(f.factor());
  CHECK(residual(g, f) < 1e-12);
}

TEST_CASE("nested dissection fills less than the order of numbering") {
  const auto g = grid<3>(12, 12, 12, 51);
  MultifrontalCholesky<3, double> f;
  f.analyse(g.n, g.pairs, g.positions);
  // In the order of numbering every column fills a plane of 144 nodes, but for those of the last plane.
  CHECK(f.size() < std::size_t(9) * (1728 - 144) * 144);
  CHECK(f.size() > std::size_t(9) * 1728);
}

}  // namespace multifrontal_cholesky_tests
