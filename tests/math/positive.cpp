#include "catch.hpp"

#include <delassus/math/positive.hpp>

#include <random>
#include <type_traits>

using namespace delassus;

namespace {

/// Q diag(1 … 10^decades) Qᵀ with a random rotation Q.
template <int R>
Mat<R, R> of_condition(double decades, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Mat<R, R> Q;
  for (int i = 0; i < R * R; ++i) Q.data()[i] = normal(random);
  // Gram–Schmidt, twice for orthogonality to rounding. Eigen's factorizations take long to compile for every R.
  for (int k = 0; k < R; ++k) {
    for (int twice = 0; twice < 2; ++twice)
      for (int before = 0; before < k; ++before) Q.col(k) -= Q.col(before).dot(Q.col(k)) * Q.col(before);
    Q.col(k).normalize();
  }
  Vec<R> values;
  for (int i = 0; i < R; ++i) values[i] = std::pow(10.0, R > 1 ? decades * i / (R - 1) : 0);
  return Q * values.asDiagonal() * Q.transpose();
}

/// |S S⁻¹ − 1| ≤ c ε cond(S), c a small multiple of R².
template <int R>
void check(double decades) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Mat<R, R> S = of_condition<R>(decades, seed);
    const Mat<R, R> error = S * inverse_of_positive(S) - Mat<R, R>::Identity();
    REQUIRE(error.norm() <= 4 * R * R * 2.2e-16 * std::pow(10.0, decades));
  }
}

}  // namespace

TEST_CASE("the inverse of a positive matrix is one to the rounding its condition allows") {
  for (const double decades : {0.0, 3.0, 9.0}) {
    CAPTURE(decades);
    check<1>(decades);
    check<2>(decades);
    check<3>(decades);
    check<5>(decades);
    check<6>(decades);
  }
}

TEST_CASE("the inverse of a positive matrix is symmetric to the bit, so that impulses stay pairs") {
  const Mat<3, 3> inverse = inverse_of_positive(of_condition<3>(6, 3));
  REQUIRE(inverse == Mat<3, 3>(inverse.transpose()));
}

// Backward stable: |S x − b| ≤ c ε |S| |x|, whatever the condition, c a small multiple of R².
TEST_CASE("one right-hand side of a positive matrix is met to rounding, and only the lower triangle is read") {
  const auto check = []<int R>(std::integral_constant<int, R>) {
    for (const double decades : {0.0, 3.0, 9.0})
      for (unsigned seed = 1; seed <= 20; ++seed) {
        const Mat<R, R> S = of_condition<R>(decades, seed);
        Mat<R, R> lower = S.template triangularView<Eigen::Lower>();
        lower.template triangularView<Eigen::StrictlyUpper>().setConstant(1e300);
        const Vec<R> b = Vec<R>::LinSpaced(R, -1, 2), x = solve_positive<R, double>(lower, b);
        REQUIRE((S * x - b).norm() <= 4 * R * R * 2.2e-16 * S.norm() * x.norm());
      }
  };
  check(std::integral_constant<int, 1>{});
  check(std::integral_constant<int, 3>{});
  check(std::integral_constant<int, 6>{});
}

// Rows two and four are sums of others, to rounding: a consistent b is met, and x stays of the size of b.
TEST_CASE("redundant rows of a positive matrix get nothing, in any units") {
  for (const double unit : {1e-12, 1.0, 1e12}) {
    Mat<5, 3> H;
    H << 1, 2, 3, 0.1, 0.2, 0.3, 0, 1, -1, 1, 3, 2, 0.3, -0.7, 1.1;
    H.row(4) *= unit;
    const Mat<5, 5> S = H * H.transpose();
    const Vec<5> b = H * Vec<3>(1, -2, 0.5), x = solve_positive<5, double>(S, b);
    CAPTURE(unit);
    REQUIRE(x[1] == 0);
    REQUIRE(x[3] == 0);
    REQUIRE((H.transpose() * x - Vec<3>(1, -2, 0.5)).norm() <= 1e-13);
  }
}
