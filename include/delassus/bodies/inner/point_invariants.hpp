/// Energy and momentum of sets of points that have mass: particles and the nodes of soft bodies.
#pragma once

#include <delassus/math/linear.hpp>
#include <delassus/rows/alive.hpp>

namespace delassus {
namespace inner {

template <class Set>
concept PointMasses = Set::width == 3 && requires(const Set set) { set.mass(0); };

/// Of springs or of elements, J.
template <class Set>
double stored_energy(const Set& set) {
  if constexpr (requires { set.elastic_energy(); })
    return set.elastic_energy();
  else
    return set.spring_energy();
}

template <class Set>
Vec3 momentum_of(const Set& set, Index b) {
  return double(set.mass(b)) * Vec3(set.velocity()[b].template cast<double>());
}

}  // namespace inner

/// Σ ½ m v² of the points that move, J.
template <inner::PointMasses Set>
double kinetic_energy(const Set& set) {
  double sum = 0;
  for (const Index b : alive(set))
    if (set.moves(b)) sum += 0.5 * double(set.mass(b)) * double(set.velocity()[b].squaredNorm());
  return sum;
}

/// What springs or elements store, − Σ m g·x, J.
template <inner::PointMasses Set>
double potential_energy(const Set& set) {
  double sum = inner::stored_energy(set);
  for (const Index b : alive(set))
    if (set.moves(b)) sum -= double(set.mass(b)) * set.gravity.dot(set.pose(b).position);
  return sum;
}

/// Σ m v, kg·m/s.
template <inner::PointMasses Set>
Vec3 momentum(const Set& set) {
  Vec3 sum = Vec3::Zero();
  for (const Index b : alive(set))
    if (set.moves(b)) sum += inner::momentum_of(set, b);
  return sum;
}

/// Σ x × m v about the world's origin, kg·m²/s.
template <inner::PointMasses Set>
Vec3 angular_momentum(const Set& set) {
  Vec3 sum = Vec3::Zero();
  for (const Index b : alive(set))
    if (set.moves(b)) sum += set.pose(b).position.cross(inner::momentum_of(set, b));
  return sum;
}

}  // namespace delassus
