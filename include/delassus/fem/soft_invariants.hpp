/// Energy and momentum of deformable bodies.
#pragma once

#include <delassus/fem/basic_fem.hpp>
#include <delassus/rows/alive.hpp>

namespace delassus {

/// Σ ½ m v² of the nodes that move, J.
template <class E, ElasticMaterial M, class T>
double kinetic_energy(const BasicFem<E, M, T>& set) {
  double sum = 0;
  for (const Index b : alive(set))
    if (set.moves(b)) sum += 0.5 * double(set.mass(b)) * double(set.velocity()[b].squaredNorm());
  return sum;
}

/// ∫Ψ − Σ m g·x, J.
template <class E, ElasticMaterial M, class T>
double potential_energy(const BasicFem<E, M, T>& set) {
  double sum = set.elastic_energy();
  for (const Index b : alive(set))
    if (set.moves(b)) sum -= double(set.mass(b)) * set.gravity.dot(set.pose(b).position);
  return sum;
}

/// Σ m v, kg·m/s.
template <class E, ElasticMaterial M, class T>
Vec3 momentum(const BasicFem<E, M, T>& set) {
  Vec3 sum = Vec3::Zero();
  for (const Index b : alive(set))
    if (set.moves(b)) sum += double(set.mass(b)) * Vec3(set.velocity()[b].template cast<double>());
  return sum;
}

/// Σ x × m v about the world's origin, kg·m²/s.
template <class E, ElasticMaterial M, class T>
Vec3 angular_momentum(const BasicFem<E, M, T>& set) {
  Vec3 sum = Vec3::Zero();
  for (const Index b : alive(set))
    if (set.moves(b))
      sum +=
          set.pose(b).position.cross(double(set.mass(b)) * Vec3(set.velocity()[b].template cast<double>()));
  return sum;
}

}  // namespace delassus
