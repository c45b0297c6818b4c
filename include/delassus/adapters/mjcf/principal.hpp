/// Principal moments of a symmetric matrix, and masses of several parts together.
#pragma once

#include <delassus/geometry/inertia.hpp>
#include <delassus/math/pose.hpp>

#include <span>
#include <utility>

namespace delassus::inner::mjcf {

struct PrincipalMoments {
  Vec3 moments;  ///< descending
  Mat3 axes;     ///< in columns, right-handed
};

/// By Jacobi's turns, each of which removes one entry beside the diagonal. Pre: finite.
inline PrincipalMoments principal_moments(const Mat3& matrix) {
  Mat3 A = matrix, V = identity<Mat3>();
  for (int turn = 0; turn < 100; ++turn) {
    int i = 0, j = 1;
    for (const auto& [a, b] : {std::pair{0, 2}, {1, 2}})
      if (std::abs(A(a, b)) > std::abs(A(i, j))) i = a, j = b;
    if (!(std::abs(A(i, j)) > 1e-17 * (std::abs(A(0, 0)) + std::abs(A(1, 1)) + std::abs(A(2, 2))))) break;
    const double tau = (A(j, j) - A(i, i)) / (2 * A(i, j));
    const double t = (tau >= 0 ? 1 : -1) / (std::abs(tau) + std::sqrt(1 + tau * tau));
    const double c = 1 / std::sqrt(1 + t * t), s = t * c;
    Mat3 R = identity<Mat3>();
    R(i, i) = R(j, j) = c;
    R(i, j) = s;
    R(j, i) = -s;
    A = Mat3(transposed_times(R, Mat3(A * R)));
    A(i, j) = A(j, i) = 0;
    V = Mat3(V * R);
  }
  PrincipalMoments p{{A(0, 0), A(1, 1), A(2, 2)}, V};
  for (const auto& [a, b] : {std::pair{0, 1}, {1, 2}, {0, 1}})
    if (p.moments[a] < p.moments[b]) {
      std::swap(p.moments[a], p.moments[b]);
      for (int row = 0; row < 3; ++row) {  // a turn by a right angle, so that the axes stay right-handed
        const double x = p.axes(row, a);
        p.axes(row, a) = p.axes(row, b);
        p.axes(row, b) = -x;
      }
    }
  return p;
}

/// V diag(m) Vᵀ.
inline Mat3 inertia_of(const PrincipalMoments& p) {
  Mat3 scaled = p.axes;
  for (int k = 0; k < 3; ++k)
    for (int row = 0; row < 3; ++row) scaled(row, k) *= p.moments[k];
  return times_transposed(scaled, p.axes);
}

/// Of a solid in another frame, which sees it at `pose`.
inline MassProperties seen_at(const Pose& pose, const MassProperties& p) {
  const Mat3 I = times_transposed(Mat3(pose.rotation * p.inertia), pose.rotation);
  MassProperties seen{p.mass, pose.to_world(p.centre), I};
  for (int k = 0; k < 3; ++k) {  // symmetric to the bit
    const int i = k, j = (k + 1) % 3;
    seen.inertia(i, j) = seen.inertia(j, i) = 0.5 * (I(i, j) + I(j, i));
  }
  return seen;
}

/// Of several solids as one; each is moved by Steiner's theorem.
inline MassProperties together(std::span<const MassProperties> parts) {
  MassProperties all;
  for (const MassProperties& p : parts) {
    all.mass += p.mass;
    all.centre += p.mass * p.centre;
  }
  if (!(all.mass > 0)) return {};
  all.centre /= all.mass;
  for (const MassProperties& p : parts) {
    const Vec3 r = p.centre - all.centre;
    all.inertia += p.inertia;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        all.inertia(i, j) += p.mass * ((i == j ? squared_norm(r) : 0) - r[i] * r[j]);
  }
  return all;
}

}  // namespace delassus::inner::mjcf
