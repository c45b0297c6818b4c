#include <delassus/linear/dense_elimination.hpp>

#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace dense_elimination_tests {

using namespace delassus;

namespace {

/// Numbers of [−1, 1], row by row.
std::vector<double> draw(Index count, unsigned seed) {
  std::minstd_rand random(seed);
  std::uniform_real_distribution<double> any(-1, 1);
  std::vector<double> numbers;
  for (Index k = 0; k < count; ++k) numbers.push_back(any(random));
  return numbers;
}

}  // namespace

// Backward error of elimination with row pivots: |A x − b| ≤ c n ε |A| |x|, c a small growth for random
// numbers.
TEST_CASE("dense systems of changing sizes are solved to rounding, zero pivots on the diagonal included") {
  DenseElimination lu;
  for (const Index n : {1, 2, 3, 17, 60, 5, 33}) {
    auto A = draw(n * n, unsigned(n));
    const auto b = draw(n, 99);
    for (Index i = 0; n > 1 && i < n; ++i) A[std::size_t(i * n + i)] = 0;
    lu.resize(n);
    for (Index i = 0; i < n; ++i)
      for (Index j = 0; j < n; ++j) lu.at(i, j) = A[std::size_t(i * n + j)];
    REQUIRE(lu.factor());
    auto x = b;
    lu.solve(x);
    double size = 0;
    for (const double e : x) size = std::max(size, std::abs(e));
    for (Index i = 0; i < n; ++i) {
      double left = -b[std::size_t(i)];
      for (Index j = 0; j < n; ++j) left += A[std::size_t(i * n + j)] * x[std::size_t(j)];
      REQUIRE(std::abs(left) <= 20 * n * 2.3e-16 * n * size);
    }
  }
}

TEST_CASE("a dense matrix with a column of zeros, or one that is no number, has no factors") {
  DenseElimination lu;
  lu.resize(2);
  lu.at(0, 0) = 1;
  REQUIRE_FALSE(lu.factor());
  lu.resize(1);
  lu.at(0, 0) = std::nan("");
  REQUIRE_FALSE(lu.factor());
}

}  // namespace dense_elimination_tests
