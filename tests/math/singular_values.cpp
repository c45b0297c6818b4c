#include <delassus/math/singular_values.hpp>

#include <cmath>
#include <random>

#include "catch.hpp"

using namespace delassus;

namespace {

struct Draw {
  std::mt19937 random{7};
  Mat3 matrix() {
    std::uniform_real_distribution<double> draw(-1, 1);
    Mat3 F;
    for (int k = 0; k < 9; ++k) F.data()[k] = draw(random);
    return F;
  }
};

double distance(const Mat3& A, const Mat3& B) { return (A - B).cwiseAbs().maxCoeff(); }

/// U and V are rotations, σ is sorted with the sign on the last, and the product is F.
void check_of(const Mat3& F) {
  const SingularValues s = singular_values(F);
  const double size = F.cwiseAbs().maxCoeff();
  for (const Mat3& Q : {s.U, s.V}) {
    CHECK(distance(Q * Q.transpose(), Mat3::Identity()) < 1e-14);
    CHECK(std::abs(Q.determinant() - 1) < 1e-14);
  }
  CHECK(s.sigma[0] >= s.sigma[1] * (1 - 1e-14));
  CHECK(s.sigma[1] >= std::abs(s.sigma[2]) - 1e-14 * size);
  Mat3 product = s.U;
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i) product(i, k) *= s.sigma[k];
  // Some ten turns, each of 1 ε in every entry.
  CHECK(distance(product * s.V.transpose(), F) <= 1e-14 * size);
}

}  // namespace

TEST_CASE("singular values between two rotations make the matrix, regular, flat, mirrored or zero") {
  Draw draw;
  for (int n = 0; n < 200; ++n) {
    const Mat3 F = draw.matrix();
    check_of(F);
    const Vec3 x = F.col(0), y = F.col(1);
    check_of(columns(x, y, Vec3(x + y)));
    check_of(columns(x, Vec3(2 * x), Vec3(-1 * x)));
    check_of(1e-160 * F);
    check_of(1e160 * F);
  }
  check_of(Mat3::Zero());
  check_of(Mat3::Identity());
  check_of(-1 * Mat3(Mat3::Identity()));
}

TEST_CASE("the smallest singular value keeps its digits when the others are 1e8 times as large") {
  Draw draw;
  for (int n = 0; n < 50; ++n) {
    // Columns scaled after a well-conditioned matrix: Jacobi from the right is exact column by column, FᵀF is
    // not.
    const SingularValues q = singular_values(draw.matrix());
    Mat3 F = q.U;
    const double sigma[3] = {1, 1e-4, 1e-8};
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < 3; ++i) F(i, k) *= sigma[k];
    const SingularValues s = singular_values(F);
    for (int k = 0; k < 3; ++k) CHECK(std::abs(s.sigma[k] / sigma[k] - 1) < 1e-13);
  }
}

TEST_CASE("the rotation of a turned matrix is the turned rotation") {
  Draw draw;
  for (int n = 0; n < 100; ++n) {
    Mat3 F = draw.matrix() + 3 * Mat3(Mat3::Identity());
    const SingularValues s = singular_values(F), turn = singular_values(draw.matrix());
    const SingularValues t = singular_values(turn.U * F);
    // ε over the gap σ₁ + σ₂ ≥ 2 that defines R.
    CHECK(distance(t.U * t.V.transpose(), turn.U * (s.U * s.V.transpose())) < 1e-14);
  }
}

TEST_CASE("the positive part of a symmetric matrix has its eigenvalues cut at zero") {
  Draw draw;
  for (int n = 0; n < 100; ++n) {
    const Mat3 Q = singular_values(draw.matrix()).U;
    const Vec3 values(1 + n % 3, n % 2 ? 0.5 : -0.5, n % 5 ? -2.0 : 1e-3);
    Mat3 A = Mat3::Zero(), expected = Mat3::Zero();
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          A(i, j) += values[k] * Q(i, k) * Q(j, k);
          expected(i, j) += std::max(0.0, values[k]) * Q(i, k) * Q(j, k);
        }
    CHECK(distance(positive_part(A), expected) < 1e-14);
  }
}
