#include <delassus/math/pivoted_lu.hpp>

#include <Eigen/Dense>

#include <random>

#include "catch.hpp"

using namespace delassus;

// |A x − b| of elimination with row pivots is a few roundings of |A| |x|: 1e-14 is a hundred of them, whatever the condition.
TEST_CASE("the pivoted LU leaves a residual of rounding, however ill conditioned the matrix") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> draw(-1, 1);
  for (int n = 0; n < 200; ++n) {
    Mat<6, 6> A = Mat<6, 6>::NullaryExpr([&] { return draw(random); });
    A.row(n % 6) *= std::pow(10.0, n % 12);
    A.col(n % 5) = A.col(5) + 1e-9 * A.col(n % 5);
    Mat<6, 2> B = Mat<6, 2>::NullaryExpr([&] { return draw(random); }), X = B;
    PivotedLu<6, double> lu;
    REQUIRE(lu.factor(A));
    lu.solve(X);
    const Mat<6, 2> bound = A.cwiseAbs() * X.cwiseAbs();
    REQUIRE((A * X - B).cwiseAbs().maxCoeff() <= 1e-14 * bound.maxCoeff());
  }
}

TEST_CASE("the sign of the determinant is told by the pivoted LU") {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> draw(-1, 1);
  int negative = 0;
  for (int n = 0; n < 200; ++n) {
    const Mat<3, 3> A = Mat<3, 3>::NullaryExpr([&] { return draw(random); });
    const double determinant = A.row(0).cross(A.row(1)).dot(A.row(2));
    PivotedLu<3, double> lu;
    if (std::abs(determinant) < 1e-10 || !lu.factor(A)) continue;
    REQUIRE(lu.is_negative() == (determinant < 0));
    negative += determinant < 0;
  }
  REQUIRE(negative > 50);
  REQUIRE(negative < 150);
}
