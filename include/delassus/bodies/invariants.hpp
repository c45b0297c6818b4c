/// Energy and momentum of a body set: what a step may and may not change.
#pragma once

#include <delassus/bodies/inner/point_invariants.hpp>
#include <delassus/bodies/particles.hpp>
#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/math/twist.hpp>
#include <delassus/rows/alive.hpp>

namespace delassus {

/// ½ m v² + ½ ω·Iω, J, of all dynamic bodies.
template <class T>
double kinetic_energy(const BasicRigidBodies<T>& set) {
  double sum = 0;
  inner::each_moving(set, [&](Index b) {
    const Vec<6> v = converted<double>(set.velocity()[b]);
    const Vec3 rate = transposed_times(set.pose(b).rotation, angular_part(v));
    sum += 0.5 * double(set.mass(b)) * squared_norm(linear_part(v)) +
           0.5 * dot(rate, Mat3(converted<double>(set.inertia(b))) * rate);
  });
  return sum;
}

/// Σ x × m v + R I Rᵀ ω about the world's origin, kg·m²/s.
template <class T>
Vec3 angular_momentum(const BasicRigidBodies<T>& set) {
  Vec3 sum = zero<Vec3>();
  inner::each_moving(set, [&](Index b) {
    const Pose pose = set.pose(b);
    const Vec<6> v = converted<double>(set.velocity()[b]);
    const Vec3 rate = transposed_times(pose.rotation, angular_part(v));
    sum += cross(pose.position, inner::momentum_of(set, b)) +
           pose.rotation * (Mat3(converted<double>(set.inertia(b))) * rate);
  });
  return sum;
}

}  // namespace delassus
