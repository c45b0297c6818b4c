/// Where a contact acts, whatever its law.
#pragma once

#include <delassus/rows/anchor.hpp>

namespace delassus {

/// Refers to a contact's item and record.
struct ContactPlace {
  const Anchor &a, &b;
  const Vec3& point;  ///< world, m
  const Mat3& frame;  ///< rows n, t₁, t₂: unit vectors of the world, n from a to b

  Vec3 axis(int k) const { return {frame(k, 0), frame(k, 1), frame(k, 2)}; }

  /// How the surface of b runs beside its body, against that of a: what friction sees besides H v, m/s.
  Vec3 running(const auto& world) const { return world.surface(b, point).running - world.surface(a, point).running; }
};

}  // namespace delassus
