#include <delassus/linear/block_cholesky.hpp>

#include <Eigen/Dense>

#include <random>
#include <utility>
#include <vector>

#include "catch.hpp"

namespace block_cholesky_tests {

using namespace delassus;

namespace {

/// A random sparse symmetric matrix of 3 × 3 blocks, dense and sparse at once.
template <class T>
struct RandomBlocks {
  Eigen::MatrixXd dense;
  BlockCholesky<3, T> sparse;

  RandomBlocks(int blocks, int pairs, unsigned seed, double shift)
      : dense(Eigen::MatrixXd::Zero(3 * blocks, 3 * blocks)) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> draw(-1, 1);
    std::uniform_int_distribution<int> pick(0, blocks - 1);
    std::vector<std::pair<Index, Index>> pattern;
    std::vector<Mat3> off;
    while (int(pattern.size()) < pairs) {
      const int i = pick(random), j = pick(random);
      if (i == j) continue;
      pattern.emplace_back(i, j);  // repeats and both orders occur
      off.push_back(Mat3::NullaryExpr([&] { return draw(random); }));
    }
    sparse.analyse(blocks, pattern);
    sparse.set_zero();
    for (std::size_t k = 0; k < pattern.size(); ++k) {
      const auto [i, j] = pattern[k];
      dense.block<3, 3>(3 * i, 3 * j) += off[k];
      dense.block<3, 3>(3 * j, 3 * i) += off[k].transpose();
      sparse.add_pair(i, j, off[k].cast<T>());
    }
    // |a_ii| above the sum of its row makes the matrix positive definite; `shift` scales how far.
    for (int i = 0; i < blocks; ++i) {
      Mat3 diagonal = Mat3::Zero();
      for (int k = 0; k < 3; ++k) diagonal(k, k) = shift * (0.1 + dense.row(3 * i + k).cwiseAbs().sum());
      dense.block<3, 3>(3 * i, 3 * i) = diagonal;
      sparse.add_diagonal(i, diagonal.cast<T>());
    }
  }

  /// |x − A⁻¹ b|/|A⁻¹ b| for a random b, A⁻¹ by Eigen's dense LDLᵀ.
  double error(unsigned seed) {
    const Eigen::VectorXd b = [&] {
      std::mt19937 random(seed);
      std::normal_distribution<double> draw;
      return Eigen::VectorXd::NullaryExpr(dense.rows(), [&] { return draw(random); }).eval();
    }();
    const Eigen::VectorXd expected = dense.ldlt().solve(b);
    std::vector<Vec<3, T>> x(dense.rows() / 3);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = b.segment<3>(3 * i).template cast<T>();
    sparse.solve(x);
    Eigen::VectorXd found(dense.rows());
    for (std::size_t i = 0; i < x.size(); ++i) found.segment<3>(3 * i) = x[i].template cast<double>();
    return (found - expected).norm() / expected.norm();
  }
};

}  // namespace

// Diagonal dominance by 10 % bounds the condition by about 2e2 · rows' spread; each of the two solves errs by
// condition · 2^-53 · a few rows' length, 1e-12 with room.
TEST_CASE("the block Cholesky solves what a dense factorization solves") {
  unsigned seed = 0;
  for (const int blocks : {1, 2, 5, 20, 60})
    for (const int pairs : {0, blocks, 3 * blocks, blocks * blocks / 2}) {
      if (blocks == 1 && pairs > 0) continue;
      RandomBlocks<double> A(blocks, pairs, ++seed, 1.1);
      REQUIRE(A.sparse.factor());
      CAPTURE(blocks, pairs);
      REQUIRE(A.error(seed) <= 1e-12);
    }
}

TEST_CASE("in single precision the block Cholesky solves to single precision") {
  RandomBlocks<float> A(40, 120, 3, 1.1);
  REQUIRE(A.sparse.factor());
  REQUIRE(A.error(4) <= 1e-12 * 0x1p29);  // the bound above times the ratio of the roundings
}

TEST_CASE("the block Cholesky refuses a matrix that is not positive definite") {
  for (unsigned seed = 1; seed < 20; ++seed) {
    RandomBlocks<double> A(10, 30, seed, 0.2);
    // The dense eigenvalues say whether the sample is what the claim speaks of.
    REQUIRE(A.dense.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff() < 0);
    REQUIRE_FALSE(A.sparse.factor());
  }
}

TEST_CASE("one analysed pattern serves many factorizations") {
  const std::vector<std::pair<Index, Index>> chain{{0, 1}, {1, 2}, {2, 3}};
  BlockCholesky<3, double> A;
  A.analyse(4, chain);
  for (double stiffness : {1.0, 10.0}) {
    A.set_zero();
    for (Index i = 0; i < 4; ++i) A.add_diagonal(i, (1 + 2 * stiffness) * Mat3::Identity());
    for (const auto& [i, j] : chain) A.add_pair(i, j, -stiffness * Mat3::Identity());
    REQUIRE(A.factor());
    std::vector<Vec3> x(4, Vec3::Ones());
    A.solve(x);
    // (1 + 2 s) x_1 − s (x_0 + x_2) = 1: a dozen roundings of numbers below 21.
    REQUIRE(((1 + 2 * stiffness) * x[1] - stiffness * (x[0] + x[2]) - Vec3::Ones()).norm() <= 1e-13);
  }
}

}  // namespace block_cholesky_tests
