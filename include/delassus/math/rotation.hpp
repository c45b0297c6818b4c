/// Rotations: the exponential, the Cayley map, and the midpoint rule of a free rigid body.
#pragma once

#include <delassus/math/linear.hpp>

#include <limits>

namespace delassus {

/// The quaternion of a turn by the vector θ (rad): exp(θ/2).
template <class T>
Eigen::Quaternion<T> exponential(const Vec<3, T>& theta) {
  const T angle = theta.norm();
  // sin(x/2)/x to rounding for small x: the next term of the series is x⁴/3840.
  const T s = angle < T(1e-3) ? T(0.5) - angle * angle / T(48) : std::sin(angle / 2) / angle;
  Eigen::Quaternion<T> q;
  q.w() = std::cos(angle / 2);
  q.vec() = s * theta;
  return q;
}

/// The vector θ of a unit quaternion, |θ| ≤ π: the inverse of `exponential`.
template <class T>
Vec<3, T> logarithm(Eigen::Quaternion<T> q) {
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const T s = q.vec().norm();
  return s < T(1e-12) ? Vec<3, T>(T(2) * q.vec()) : Vec<3, T>(T(2) * std::atan2(s, q.w()) / s * q.vec());
}

/// The Cayley map as a quaternion: (I − θ̂/2)⁻¹ (I + θ̂/2) turns like (1, θ/2) normalised.
template <class T>
Eigen::Quaternion<T> cayley(const Vec<3, T>& theta) {
  Eigen::Quaternion<T> q;
  q.w() = T(1);
  q.vec() = T(0.5) * theta;
  q.normalize();
  return q;
}

/// One step of free rotation by the implicit midpoint rule, in the body's frame:
///
///   I (Ω₊ − Ω) + h Ω̄ × I Ω̄ = 0,   Ω̄ = (Ω + Ω₊)/2,   R₊ = R cay(h Ω̄).
///
/// Keeps ½ Ω·IΩ (the rule keeps quadratic invariants) and the angular momentum R I Ω, since the equation is
/// cay(h Ω̄) I Ω₊ = I Ω multiplied by I + h Ω̄^/2. Returns Ω̄; Ω₊ = 2 Ω̄ − Ω. Newton's method with step halving:
/// F(Ω̄) = 2 I (Ω̄ − Ω) + h Ω̄ × I Ω̄, F′ = 2 I + h (Ω̄^ I − (I Ω̄)^). Source: [SimoWong1991], the midpoint member.
template <class T>
Vec<3, T> midpoint_rate(const Mat<3, 3, T>& inertia, const Vec<3, T>& rate, T h) {
  Vec<3, T> mid = rate;
  Vec<3, T> momentum = inertia * mid;
  Vec<3, T> residual = h * mid.cross(momentum);
  const T start = residual.norm();
  const T floor = std::numeric_limits<T>::epsilon() * momentum.norm();
  T size = start;
  for (int iteration = 0; iteration < 20 && size > floor; ++iteration) {
    const Mat<3, 3, T> slope = T(2) * inertia + h * (skew(mid) * inertia - skew(momentum));
    const Vec<3, T> move = slope.inverse() * residual;
    T step = 1;
    for (int halving = 0; halving < 8; ++halving, step /= 2) {
      const Vec<3, T> trial = mid - step * move;
      const Vec<3, T> trial_momentum = inertia * trial;
      const Vec<3, T> trial_residual = T(2) * (trial_momentum - inertia * rate) + h * trial.cross(trial_momentum);
      const T trial_size = trial_residual.norm();
      if (!(trial_size < size) && halving < 7) continue;
      if (!(trial_size < size)) return mid;
      mid = trial;
      momentum = trial_momentum;
      residual = trial_residual;
      size = trial_size;
      break;
    }
  }
  return mid;
}

}  // namespace delassus
