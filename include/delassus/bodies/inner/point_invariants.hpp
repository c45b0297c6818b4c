/// Energy and momentum of sets of points that have mass (particles, the nodes of soft bodies), and what of them all sets
/// with mass have in common.
#pragma once

#include <delassus/math/linear.hpp>
#include <delassus/math/twist.hpp>
#include <delassus/rows/alive.hpp>

namespace delassus {
namespace inner {

template <class Set>
concept HasMasses = requires(const Set set) {
  set.mass(0);
  set.position(set.handle(0));
};
template <class Set>
concept PointMasses = HasMasses<Set> && Set::width == 3;

/// f(b) for the bodies that move.
template <class Set, class F>
void each_moving(const Set& set, F&& f) {
  for (const Index b : alive(set))
    if (set.moves(b)) f(b);
}

template <class Set>
Vec3 momentum_of(const Set& set, Index b) {
  return double(set.mass(b)) * Vec3(converted<double>(linear_part(set.velocity()[b])));
}

}  // namespace inner

/// Σ ½ m v² of the points that move, J.
template <inner::PointMasses Set>
double kinetic_energy(const Set& set) {
  double sum = 0;
  inner::each_moving(set, [&](Index b) { sum += 0.5 * double(set.mass(b)) * double(squared_norm(set.velocity()[b])); });
  return sum;
}

/// What springs or elements store, − Σ m g·x of all that moves, J.
template <inner::HasMasses Set>
double potential_energy(const Set& set) {
  double sum = 0;
  if constexpr (requires { set.elastic_energy(); })
    sum = set.elastic_energy();
  else if constexpr (requires { set.spring_energy(); })
    sum = set.spring_energy();
  inner::each_moving(set, [&](Index b) { sum -= double(set.mass(b)) * dot(set.gravity, set.position(set.handle(b))); });
  return sum;
}

/// Σ m v of all that moves, kg·m/s.
template <inner::HasMasses Set>
Vec3 momentum(const Set& set) {
  Vec3 sum = zero<Vec3>();
  inner::each_moving(set, [&](Index b) { sum += inner::momentum_of(set, b); });
  return sum;
}

/// Σ x × m v about the world's origin, kg·m²/s.
template <inner::PointMasses Set>
Vec3 angular_momentum(const Set& set) {
  Vec3 sum = zero<Vec3>();
  inner::each_moving(set, [&](Index b) { sum += cross(set.pose(b).position, inner::momentum_of(set, b)); });
  return sum;
}

}  // namespace delassus
