/// Where a contact acts, whatever its law.
#pragma once

#include <delassus/rows/contact_record.hpp>

namespace delassus {

/// Points to a contact's item and record.
struct ContactPlace {
  const ContactRecord* record = nullptr;
  const Vec3* point = nullptr;  ///< world, m
  const Mat3* frame = nullptr;  ///< rows n, t₁, t₂: unit vectors of the world, n from a to b

  Vec3 axis(int k) const { return {(*frame)(k, 0), (*frame)(k, 1), (*frame)(k, 2)}; }
  /// Where friction acts, world, m.
  Vec3 friction_point() const { return *point + record->friction_arm; }
  /// How the surface of b runs beside its body, against that of a: what friction sees besides H v, m/s.
  Vec3 running(const auto& world) const {
    const Vec3 at = friction_point();
    return world.surface(record->b, at).running - world.surface(record->a, at).running;
  }
};

}  // namespace delassus
