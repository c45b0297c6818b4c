#include <delassus/math/linear.hpp>

#include "catch.hpp"

#include <limits>
#include <type_traits>

using namespace delassus;

namespace {

/// Of products of entries below 1 with three terms: each order of summation is within 3 roundings of the exact sum.
template <class A, class B>
bool agree(const A& ours, const B& eigens) {
  return (Mat3::Zero().leftCols(ours.cols()) + ours - eigens).cwiseAbs().maxCoeff() <=
         6 * std::numeric_limits<double>::epsilon();
}

}  // namespace

TEST_CASE("sums and multiples of 3-vectors and 3 × 3 matrices are values, with the bits of Eigen's expressions") {
  const Vec3 a = Vec3::Random(), b = Vec3::Random();
  const Mat3 A = Mat3::Random(), B = Mat3::Random();
  STATIC_REQUIRE(std::is_same_v<decltype(a + 2 * b), Vec3>);
  STATIC_REQUIRE(std::is_same_v<decltype(A.transpose() * (a - b)), Vec3>);
  STATIC_REQUIRE(std::is_same_v<decltype(A * B.transpose()), Mat3>);
  REQUIRE(a + b == a.binaryExpr(b, [](double x, double y) { return x + y; }));
  REQUIRE(A - B == A.binaryExpr(B, [](double x, double y) { return x - y; }));
  REQUIRE(-a == a.unaryExpr([](double x) { return -x; }));
  REQUIRE(0.3 * A == A.unaryExpr([](double x) { return 0.3 * x; }));
  REQUIRE(a / 3 == a.unaryExpr([](double x) { return x / 3; }));
  Vec3 c = a;
  c += b, c -= a, c *= 2, c /= 3;
  REQUIRE(c == ((a + b) - a) * 2 / 3);
}

TEST_CASE("products of 3 × 3 matrices are Eigen's to rounding") {
  for (int k = 0; k < 100; ++k) {
    const Vec3 x = Vec3::Random();
    const Mat3 A = Mat3::Random(), B = Mat3::Random();
    REQUIRE(agree(A * x, A.lazyProduct(x)));
    REQUIRE(agree(A * B, A.lazyProduct(B)));
    REQUIRE(agree(A.transpose() * x, A.transpose().lazyProduct(x)));
    REQUIRE(agree(A.transpose() * B, A.transpose().lazyProduct(B)));
    REQUIRE(agree(A * B.transpose(), A.lazyProduct(B.transpose())));
  }
}

TEST_CASE("the inverse of a 3 × 3 matrix times the matrix is one") {
  const Mat3 A = Mat3::Random() + 3 * Mat3(Mat3::Identity());  // |A⁻¹| < 2: rows are dominated by their diagonal
  REQUIRE((inverse(A) * A - Mat3(Mat3::Identity())).cwiseAbs().maxCoeff() < 1e-14);
}
