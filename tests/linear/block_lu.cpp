#include <delassus/linear/block_lu.hpp>

#include <Eigen/Dense>

#include <random>
#include <utility>
#include <vector>

#include "catch.hpp"

namespace block_lu_tests {

using namespace delassus;

namespace {

/// 1 + a random unsymmetric sparse matrix of w × w blocks, dense and sparse at once; `size` scales what is
/// added.
template <int w>
struct RandomBlocks {
  Eigen::MatrixXd dense;
  BlockLu<w, double> sparse;

  RandomBlocks(int blocks, int pairs, unsigned seed, double size) {
    dense = Eigen::MatrixXd::Identity(w * blocks, w * blocks);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> draw(-size, size);
    std::uniform_int_distribution<int> pick(0, blocks - 1);
    std::vector<std::pair<Index, Index>> pattern;
    while (int(pattern.size()) < pairs) {
      const int i = pick(random), j = pick(random);
      if (i != j) pattern.emplace_back(i, j);  // repeats and both orders occur
    }
    sparse.analyse(blocks, pattern);
    sparse.set_identity();
    const auto add = [&](Index i, Index j) {
      const Mat<w, w> block = Mat<w, w>::NullaryExpr([&] { return draw(random); });
      sparse.at(i, j) += block;
      dense.block<w, w>(w * i, w * j) += block;
    };
    for (Index i = 0; i < blocks; ++i) add(i, i);
    for (auto [i, j] : pattern) {
      add(i, j);
      add(j, i);
    }
    // Diagonal dominance, so that no exchange of rows between blocks is called for.
    for (Index i = 0; i < blocks; ++i) {
      const double reach = dense.middleRows<w>(w * i).cwiseAbs().rowwise().sum().maxCoeff();
      sparse.at(i, i) += reach * Mat<w, w>::Identity();
      dense.block<w, w>(w * i, w * i) += reach * Mat<w, w>::Identity();
    }
  }

  /// |x − A⁻¹ b|/|A⁻¹ b| for a random b, A⁻¹ by Eigen's dense LU.
  double error() const {
    const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(dense.rows(), -1, 2);
    const Eigen::VectorXd expected = dense.partialPivLu().solve(b);
    std::vector<Vec<w>> x(dense.rows() / w);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = b.segment<w>(w * i);
    sparse.solve(x);
    Eigen::VectorXd found(dense.rows());
    for (std::size_t i = 0; i < x.size(); ++i) found.segment<w>(w * i) = x[i];
    return (found - expected).norm() / expected.norm();
  }
};

}  // namespace

// A dominant diagonal keeps the condition below ten and the growth below two; 1e-13 is a thousand roundings.
TEST_CASE("the block LU solves what a dense factorization solves") {
  unsigned seed = 0;
  for (const int blocks : {1, 2, 5, 20, 60})
    for (const int pairs : {0, blocks, 3 * blocks, blocks * blocks / 2}) {
      if (blocks == 1 && pairs > 0) continue;
      CAPTURE(blocks, pairs);
      RandomBlocks<6> six(blocks, pairs, ++seed, 10);
      REQUIRE(six.sparse.factor());
      REQUIRE(six.error() <= 1e-13);
      RandomBlocks<3> three(blocks, pairs, ++seed, 1e6);
      REQUIRE(three.sparse.factor());
      REQUIRE(three.error() <= 1e-13);
    }
}

// As the first test, with blocks that have 1 to 6 rows of their own, and all right sides of A⁻¹ at once; what stands
// behind the rows of a block is the identity's, and is never read.
TEST_CASE("blocks of fewer rows are solved for many right sides at once") {
  for (const int pairs : {0, 20, 60, 400}) {
    CAPTURE(pairs);
    constexpr int w = 6, blocks = 20;
    RandomBlocks<w> full(blocks, pairs, unsigned(pairs) + 7, 10);
    std::vector<Index> first{0}, kept;
    for (Index i = 0; i < blocks; ++i) {
      const int rows = 1 + i * 5 % w;
      first.push_back(first.back() + rows);
      for (int r = 0; r < w; ++r) {
        if (r < rows) {
          kept.push_back(w * i + r);
          continue;
        }
        const Index k = w * i + r;
        full.dense.row(k).setZero(), full.dense.col(k).setZero();
        full.dense(k, k) = 1;
      }
    }
    // Off the pattern `dense` is zero, and `at` has no entry.
    for (Index i = 0; i < blocks; ++i)
      for (Index j = 0; j < blocks; ++j)
        if (const Mat<w, w> block = full.dense.block<w, w>(w * i, w * j); !block.isZero(0)) full.sparse.at(i, j) = block;
    const int n = int(kept.size());
    REQUIRE(n == first.back());
    Eigen::MatrixXd small(n, n);
    for (int r = 0; r < n; ++r)
      for (int c = 0; c < n; ++c) small(r, c) = full.dense(kept[std::size_t(r)], kept[std::size_t(c)]);
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> X = Eigen::MatrixXd::Identity(n, n);
    REQUIRE(full.sparse.factor_own_rows(first));
    full.sparse.solve(X.data(), n, first);
    const Eigen::MatrixXd expected = small.inverse();
    REQUIRE((X - expected).norm() <= 1e-13 * expected.norm());
  }
}

TEST_CASE("rows are exchanged inside a block") {
  BlockLu<3, double> A;
  A.analyse(1, {});
  A.at(0, 0) << 0, 2, 0, 0, 0, 4, 8, 0, 0;
  REQUIRE(A.factor());
  std::vector<Vec3> x{Vec3(2, 8, 24)};
  A.solve(x);
  REQUIRE((x[0] - Vec3(3, 1, 2)).norm() == 0);
}

TEST_CASE("a singular pivot block and one that is not finite are refused") {
  for (const double last : {0.0, std::numeric_limits<double>::quiet_NaN()}) {
    BlockLu<3, double> A;
    A.analyse(1, {});
    A.set_identity();
    A.at(0, 0)(2, 2) = last;
    REQUIRE(!A.factor());
  }
}

// A chain and a star, numbered against the elimination: neither may fill.
TEST_CASE("a chain and a star are eliminated without fill") {
  std::vector<std::pair<Index, Index>> chain, star;
  for (Index i = 1; i < 50; ++i) {
    chain.emplace_back(i - 1, i);
    star.emplace_back(0, i);
  }
  BlockPattern pattern;
  pattern.analyse(50, chain);
  REQUIRE(pattern.entries() == 49);
  pattern.analyse(50, star);
  REQUIRE(pattern.entries() == 49);
}

// The joints of a machine, each with those that hold one of its two bodies. A graph whose cliques hang in a tree has an
// order without fill, and the joint of fewest neighbours is always one of its ends. In a chain one neighbour is left
// then, 1 + 1 · 2 products of blocks; where two joints hang on each body two are, 1 + 2 · 3.
TEST_CASE("the factorization of chains and trees of joints grows linearly") {
  for (const Index n : {10, 100, 300, 1000})
    for (const int children : {1, 2}) {
      CAPTURE(n, children);
      std::vector<std::pair<Index, Index>> pairs;
      for (Index i = 1; i < n; ++i) {
        const Index parent = (i - 1) / children;
        pairs.emplace_back(parent, i);
        for (Index other = i + 1; other < n && (other - 1) / children == parent; ++other) pairs.emplace_back(i, other);
      }
      BlockLu<6, double> A;
      A.analyse(n, pairs);
      REQUIRE(A.products() <= (children == 1 ? 3. : 7.) * n);
    }
}

}  // namespace block_lu_tests
