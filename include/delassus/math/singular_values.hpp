/// Singular values of a 3 × 3 matrix between two rotations, and eigenvalues of a symmetric one.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/math/linear.hpp>

#include <algorithm>

namespace delassus {

/// F = U diag(σ) Vᵀ with det U = det V = 1 and σ₀ ≥ σ₁ ≥ |σ₂|: the last one is negative where F mirrors. U Vᵀ
/// is then the rotation next to F, also where F is flat or worse.
struct SingularValues {
  Mat3 U, V;
  Vec3 sigma;
};

namespace inner {

/// cos and sin of Jacobi's turn that makes [a g; g b] diagonal; |turn| ≤ 45°.
struct JacobiTurn {
  double c, s;
  JacobiTurn(double a, double b, double g) {
    const double zeta = (b - a) / (2 * g);
    const double t = (zeta < 0 ? -1 : 1) / (std::abs(zeta) + std::sqrt(1 + zeta * zeta));
    c = 1 / std::sqrt(1 + t * t);
    s = c * t;
  }
  /// Columns p and q of A ← A J.
  void turn(Mat3& A, int p, int q) const {
    for (int i = 0; i < 3; ++i) {
      const double x = A(i, p), y = A(i, q);
      A(i, p) = c * x - s * y;
      A(i, q) = s * x + c * y;
    }
  }
};

inline constexpr int pairs_of_three[3][2] = {{0, 1}, {0, 2}, {1, 2}};

/// A unit vector at right angles to the unit vector u.
inline Vec3 any_normal(const Vec3& u) {
  const Vec3 e = unit_axis((largest_entry(u) + 1) % 3);
  const Vec3 n = e - dot(u, e) * u;
  return n / norm(n);
}

}  // namespace inner

/// One-sided Jacobi: turns from the right make the columns of F V orthogonal, then they are σ_i u_i. The
/// smallest σ is as exact as F itself, which it is not by way of FᵀF. Source: [Hestenes1958].
inline SingularValues singular_values(const Mat3& F) {
  const double scale = F.cwiseAbs().maxCoeff();
  Mat3 B = scale > 0 ? Mat3(F / scale) : F, V = Mat3::Identity();
  bool is_turning = true;
  for (int sweep = 0; sweep < 12 && is_turning; ++sweep) {
    is_turning = false;
    for (const auto& [p, q] : inner::pairs_of_three) {
      const Vec3 x = B.col(p), y = B.col(q);
      const double a = dot(x, x), b = dot(y, y), g = dot(x, y);
      if (!(std::abs(g) > 4e-16 * std::sqrt(a * b)) || !(std::abs(g) > 1e-300)) continue;
      const inner::JacobiTurn turn(a, b, g);
      turn.turn(B, p, q);
      turn.turn(V, p, q);
      is_turning = true;
    }
  }
  for (const auto& [p, q] : inner::pairs_of_three) {
    const Vec3 x = B.col(p), y = B.col(q);
    if (dot(x, x) >= dot(y, y)) continue;
    for (Mat3* A : {&B, &V})
      for (int i = 0; i < 3; ++i) std::swap((*A)(i, p), (*A)(i, q)), (*A)(i, q) = -(*A)(i, q);
  }
  const Vec3 b[3] = {B.col(0), B.col(1), B.col(2)};
  const double longest = norm(b[0]);
  const Vec3 u0 = longest > 0 ? Vec3(b[0] / longest) : unit_axis(0);
  const Vec3 rest = b[1] - dot(u0, b[1]) * u0;
  const double length = norm(rest);
  const Vec3 u1 = length > 1e-14 * longest ? Vec3(rest / length) : inner::any_normal(u0), u2 = cross(u0, u1);
  return {columns(u0, u1, u2), V, scale * Vec3(dot(u0, b[0]), dot(u1, b[1]), dot(u2, b[2]))};
}

/// The symmetric positive semidefinite matrix next to a symmetric A: eigenvalues below zero become zero.
/// Jacobi's method.
inline Mat3 positive_part(const Mat3& A) {
  const double m2 = A(0, 0) * A(1, 1) - A(0, 1) * A(0, 1);
  const double m3 = A(0, 0) * (A(1, 1) * A(2, 2) - A(1, 2) * A(1, 2)) -
                    A(0, 1) * (A(0, 1) * A(2, 2) - A(1, 2) * A(0, 2)) +
                    A(0, 2) * (A(0, 1) * A(1, 2) - A(1, 1) * A(0, 2));
  if (A(0, 0) > 0 && m2 > 0 && m3 > 0) return A;  // Sylvester: nothing to cut
  Mat3 D = A, V = Mat3::Identity();
  const double size = A.cwiseAbs().maxCoeff();
  for (int sweep = 0; sweep < 12; ++sweep)
    for (const auto& [p, q] : inner::pairs_of_three) {
      if (!(std::abs(D(p, q)) > 1e-17 * size)) continue;
      const inner::JacobiTurn turn(D(p, p), D(q, q), D(p, q));
      turn.turn(D, p, q);
      D.transposeInPlace();
      turn.turn(D, p, q);
      D.transposeInPlace();
      turn.turn(V, p, q);
    }
  Mat3 cut = V;
  for (int k = 0; k < 3; ++k) {
    const double value = std::max(0.0, D(k, k));
    for (int i = 0; i < 3; ++i) cut(i, k) *= value;
  }
  return cut * V.transpose();
}

}  // namespace delassus
