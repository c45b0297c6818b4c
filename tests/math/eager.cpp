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

namespace {

/// Entries below 1, sums of at most six products: each order of summation is within 6 roundings of the exact sum.
template <int R, int K, int C>
void compare_with_eigen() {
  const Mat<R, K> A = Mat<R, K>::Random(), B = Mat<R, K>::Random();
  const Mat<K, C> X = Mat<K, C>::Random();
  const Mat<K, R> At = A.transpose();
  const Mat<C, K> Xt = X.transpose();
  const double rounding = 12 * std::numeric_limits<double>::epsilon();
  const auto is_near = [&](const Eigen::MatrixXd& ours, const Eigen::MatrixXd& eigens) {
    return (ours - eigens).cwiseAbs().maxCoeff() <= rounding;
  };
  const Eigen::MatrixXd a = A, b = B, product = Eigen::MatrixXd(A) * Eigen::MatrixXd(X);
  REQUIRE(is_near(A * X, product));
  REQUIRE(transposed(A) == At);
  if constexpr (R * C > 1) {
    REQUIRE(is_near(At.transpose() * X, product));
    REQUIRE(is_near(A * Xt.transpose(), product));
  }
  REQUIRE((A + B == Mat<R, K>(a + b) && A - B == Mat<R, K>(a - b) && -A == Mat<R, K>(-a)));
  REQUIRE((3 * A == Mat<R, K>(3 * a) && A / 7 == Mat<R, K>(a / 7)));
  Mat<R, K> c = A;
  c += B, c -= A, c *= 2, c /= 3;
  REQUIRE(c == ((A + B) - A) * 2 / 3);
  REQUIRE(std::abs(dot(A, B) - a.cwiseProduct(b).sum()) <= R * K * rounding);
  REQUIRE(std::abs(norm(A) - a.norm()) <= R * K * rounding);
  REQUIRE(squared_norm(A) == dot(A, A));
  set_all(c, 0.25);
  REQUIRE(c == Mat<R, K>(Mat<R, K>::Constant(0.25)));
  REQUIRE(c != A);
  REQUIRE(zero<Mat<R, K>>() == Mat<R, K>(Mat<R, K>::Zero()));
  REQUIRE(diagonal_of<R>(2.) == Mat<R, R>(2 * Eigen::MatrixXd::Identity(R, R)));
}

}  // namespace

TEST_CASE("sums and products of all small sizes are Eigen's to rounding") {
  compare_with_eigen<1, 6, 1>();
  compare_with_eigen<2, 6, 2>();
  compare_with_eigen<3, 6, 3>();
  compare_with_eigen<6, 3, 1>();
  compare_with_eigen<5, 6, 5>();
  compare_with_eigen<6, 6, 6>();
  compare_with_eigen<4, 1, 4>();
  compare_with_eigen<1, 1, 1>();
}

TEST_CASE("matrices stored by rows stay Eigen's, and beside others are no riddle") {
  const Mat3 A = Mat3::Random(), B = Mat3::Random();
  const Vec3 x = Vec3::Random();
  const auto by_rows = B.transpose().eval();
  static_assert(decltype(by_rows)::IsRowMajor);
  const Mat3 sum = A + by_rows, product = A * by_rows, twice = by_rows + by_rows, other = by_rows * A;
  const Vec3 turned = by_rows * x;
  for (int i = 0; i < 3; ++i) {
    double of_vector = 0;
    for (int k = 0; k < 3; ++k) {
      double first = 0, second = 0;
      for (int j = 0; j < 3; ++j) first += A(i, j) * B(k, j), second += B(j, i) * A(j, k);
      of_vector += B(k, i) * x[k];
      REQUIRE(sum(i, k) == A(i, k) + B(k, i));
      REQUIRE(twice(i, k) == 2 * B(k, i));
      REQUIRE(std::abs(product(i, k) - first) < 1e-15);  // three products of numbers in [−1, 1]
      REQUIRE(std::abs(other(i, k) - second) < 1e-15);
    }
    REQUIRE(std::abs(turned[i] - of_vector) < 1e-15);
  }
}

TEST_CASE("the inverse of a 3 × 3 matrix times the matrix is one") {
  const Mat3 A = Mat3::Random() + 3 * Mat3(Mat3::Identity());  // |A⁻¹| < 2: rows are dominated by their diagonal
  REQUIRE((inverse(A) * A - Mat3(Mat3::Identity())).cwiseAbs().maxCoeff() < 1e-14);
}

TEST_CASE("named sums and products of vectors are Eigen's") {
  constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();  // of three products below 1
  for (int k = 0; k < 100; ++k) {
    const Vec3 a = Vec3::Random(), b = Vec3::Random();
    const Mat3 A = Mat3::Random(), B = Mat3::Random();
    REQUIRE(std::abs(dot(a, b) - a.dot(b)) <= rounding);
    REQUIRE(std::abs(squared_norm(a) - a.squaredNorm()) <= rounding);
    REQUIRE(std::abs(norm(a) - a.norm()) <= rounding);
    REQUIRE(cross(a, b) == Vec3(a.cross(b)));
    REQUIRE(agree(normalized(a), a.normalized()));
    REQUIRE(agree(transposed_times(A, a), A.transpose().lazyProduct(a)));
    REQUIRE(agree(transposed_times(A, B), A.transpose().lazyProduct(B)));
    REQUIRE(agree(times_transposed(A, B), A.lazyProduct(B.transpose())));
    REQUIRE(max_entry(a) == a.maxCoeff());
    REQUIRE(column(A, 1) == Vec3(A.col(1)));
  }
  REQUIRE(normalized(Vec3(0, 0, 0)) == Vec3(0, 0, 0));
}

TEST_CASE("the same names take blocks, and vectors of any length") {
  const Eigen::Matrix<double, 6, 1> v = Eigen::Matrix<double, 6, 1>::Random();
  const Eigen::VectorXd x = Eigen::VectorXd::Random(20);
  REQUIRE(norm(v.head<3>()) == v.head<3>().norm());
  REQUIRE(dot(x, x) == x.squaredNorm());
  REQUIRE(squared_norm(x) == x.squaredNorm());
  REQUIRE(cross(v.head<3>(), v.tail<3>()) == Vec3(v.head<3>().cross(v.tail<3>())));
}

TEST_CASE("zeros, ones and copies of matrices") {
  Mat<2, 3> M;
  set_all(M, 2);
  REQUIRE(M == Mat<2, 3>(Mat<2, 3>::Constant(2)));
  Mat<2, 3> copy = zero<Mat<2, 3>>();
  REQUIRE(is_zero(copy));
  assign(copy, M);
  REQUIRE(copy == M);
  set_zero(copy);
  REQUIRE(is_zero(copy));
  REQUIRE(identity<Mat3>() == Mat3(Mat3::Identity()));
}
