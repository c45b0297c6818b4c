#include <delassus/linear/block_chain.hpp>
#include <delassus/linear/factorization.hpp>

#include <Eigen/Dense>

#include <random>
#include <vector>

#include "catch.hpp"

namespace block_chain_tests {

using namespace delassus;

static_assert(Factorization<BlockChain<6, double>, 6, double>);

namespace {

/// A random positive definite chain of 4 × 4 blocks, dense and as a chain.
struct RandomChain {
  Eigen::MatrixXd dense;
  BlockChain<4, double> chain;

  explicit RandomChain(Index blocks) : dense(Eigen::MatrixXd::Zero(4 * blocks, 4 * blocks)) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> draw(-1, 1);
    chain.analyse(blocks);
    chain.set_zero();
    for (Index i = 0; i < blocks; ++i) {
      Mat<4, 4> X;
      for (int k = 0; k < 16; ++k) X.data()[k] = draw(random);
      if (i > 0) {
        dense.block<4, 4>(4 * i, 4 * i - 4) = X;
        dense.block<4, 4>(4 * i - 4, 4 * i) = X.transpose();
        if (i % 2 == 0)
          chain.add_pair(i, i - 1, X);
        else
          chain.add_pair(i - 1, i, X.transpose());
      }
    }
    for (Index i = 0; i < blocks; ++i) {
      Mat<4, 4> D = Mat<4, 4>::Identity();
      for (int k = 0; k < 4; ++k) D(k, k) += dense.row(4 * i + k).cwiseAbs().sum();
      D(0, 1) = D(1, 0) = 0.3;
      dense.block<4, 4>(4 * i, 4 * i) = D;
      chain.add_diagonal(i, D);
    }
  }
};

}  // namespace

TEST_CASE("a chain of blocks is solved as a dense matrix is") {
  for (const Index blocks : {1, 2, 9}) {
    RandomChain s(blocks);
    REQUIRE(s.chain.factor());
    const Eigen::MatrixXd inverse = s.dense.inverse();
    std::vector<Vec<4>> x(blocks);
    Eigen::VectorXd b(4 * blocks);
    for (Index i = 0; i < 4 * blocks; ++i) x[i / 4][i % 4] = b[i] = std::cos(3 * i);
    s.chain.solve(x);
    const Eigen::VectorXd expected = inverse * b;
    for (Index i = 0; i < 4 * blocks; ++i) CHECK(std::abs(x[i / 4][i % 4] - expected[i]) < 1e-14);  // κ < 10
  }
}

TEST_CASE("the compliance of chosen blocks of a chain is their part of the inverse, in any order") {
  RandomChain s(9);
  REQUIRE(s.chain.factor());
  const Eigen::MatrixXd inverse = s.dense.inverse();
  for (const std::vector<Index>& nodes : std::vector<std::vector<Index>>{{0}, {8}, {5, 2}, {8, 0, 3, 4}}) {
    const std::size_t n = nodes.size();
    std::vector<double> C(16 * n * n, 1e9);
    s.chain.compliance(nodes, C);
    for (std::size_t i = 0; i < 4 * n; ++i)
      for (std::size_t j = 0; j < 4 * n; ++j)
        CHECK(std::abs(C[i + 4 * n * j] - inverse(4 * nodes[i / 4] + i % 4, 4 * nodes[j / 4] + j % 4)) <
              1e-14);
  }
}

TEST_CASE("a chain that is not positive has no factor") {
  BlockChain<4, double> chain;
  chain.analyse(2);
  chain.set_zero();
  chain.add_diagonal(0, Mat<4, 4>::Identity());
  chain.add_diagonal(1, Mat<4, 4>::Identity());
  chain.add_pair(0, 1, Mat<4, 4>::Identity());
  CHECK(!chain.factor());
}

}  // namespace block_chain_tests
