/// AC-04: a free body of moments (1, 2, 3) that starts with (1, 1, 1) rad/s, against Jacobi's closed form.
#pragma once

#include <delassus/delassus.hpp>

#include <algorithm>
#include <cmath>

namespace euler_top {

using namespace delassus;

struct Errors {
  double angle, rate;       ///< rad, rad/s
  double energy, momentum;  ///< relative drifts
};

/// After 10 s in `steps` steps. The inertia is given in axes turned by `frame` against the body's principal
/// ones.
template <class Integrator>
Errors after_ten_seconds(Integrator integrator, int steps, const Quat& frame = Quat::Identity()) {
  AnimationLoop loop{World{RigidBodies{}}, integrator};
  auto& set = bodies<RigidBodies>(loop.world());
  set.gravity.setZero();
  const Mat3 R = frame.toRotationMatrix();
  const auto body = set.add({.orientation = frame.conjugate(),
                             .angular_velocity = {1, 1, 1},
                             .mass = 1.0,
                             .inertia = Mat3(R * Vec3(1, 2, 3).asDiagonal() * R.transpose())});
  const double energy = kinetic_energy(set);
  const Vec3 momentum = angular_momentum(set);
  for (int n = 0; n < steps; ++n) loop.step(10.0 / steps);
  const Quat turn(0.46254544055464281993, -0.31433514514460551582, 0.049429631279299836969,
                  0.8275275484844136788);
  const Vec3 rate(-0.60347042309251812895, -1.2789931385478724147, 0.88772678821573304257);
  const Quat q = set.orientation(body) * frame;
  const double chord = std::min((q.coeffs() - turn.coeffs()).norm(), (q.coeffs() + turn.coeffs()).norm());
  return {4 * std::asin(0.5 * chord), (q.conjugate() * set.angular_velocity(body) - rate).norm(),
          std::abs(kinetic_energy(set) / energy - 1),
          (angular_momentum(set) - momentum).norm() / momentum.norm()};
}

/// What L and the energy, invariants of the midpoint rule, are off by as shares after so many steps. What
/// rounding leaves is a walk: ω goes through R three times a step and L twice, and each time a component is
/// three products and two sums, off by 2.1 · 2^-53 at most in the mean square, as a step is by √5 times that
/// and a little. Four standard deviations are allowed. At the 1600 steps of [Verification], for its 1e-14,
/// one is up to 2.1e-14; the run has 1.05e-14 and 0.97e-14. A drift comes to it: ω₊ and L are products with
/// the same I, whose roundings are not quite of no sign, some 0.03 · 2^-53 a step for moments of 1.1, 2.3
/// and 3.07.
inline double of_rounding(double steps) { return (4 * 4.8 * std::sqrt(steps) + 0.05 * steps) * 0x1p-53; }

/// The constant of [Verification] is that of h = 1/160 s.
inline constexpr int steps_of_constant = 1600;

}  // namespace euler_top
