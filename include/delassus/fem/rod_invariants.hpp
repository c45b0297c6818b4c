/// Energy and momentum of rods.
#pragma once

#include <delassus/bodies/inner/point_invariants.hpp>
#include <delassus/fem/rods.hpp>
#include <delassus/rows/alive.hpp>

namespace delassus {
namespace inner {

/// f(b, v, M v) of the nodes that move, in double.
template <class T, class F>
void each_momentum(const BasicRods<T>& set, F&& f) {
  each_moving(set, [&](Index b) {
    f(b, Vec<6>(converted<double>(set.velocity()[b])),
      Vec<6>(converted<double>(set.momentum(b, set.velocity()[b]))));
  });
}

}  // namespace inner

/// Σ ½ v·M v of the nodes that move, J.
template <class T>
double kinetic_energy(const BasicRods<T>& set) {
  double sum = 0;
  inner::each_momentum(set, [&](Index, const Vec<6>& v, const Vec<6>& p) { sum += 0.5 * v.dot(p); });
  return sum;
}

/// Σ m v, kg·m/s.
template <class T>
Vec3 momentum(const BasicRods<T>& set) {
  Vec3 sum = Vec3::Zero();
  inner::each_momentum(set, [&](Index, const Vec<6>&, const Vec<6>& p) { sum += linear_part(p); });
  return sum;
}

/// Σ x × m v + R I Rᵀ ω about the world's origin, kg·m²/s.
template <class T>
Vec3 angular_momentum(const BasicRods<T>& set) {
  Vec3 sum = Vec3::Zero();
  inner::each_momentum(set, [&](Index b, const Vec<6>&, const Vec<6>& p) {
    sum += set.position(set.handle(b)).cross(linear_part(p)) + angular_part(p);
  });
  return sum;
}

}  // namespace delassus
