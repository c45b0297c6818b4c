/// Collision detection with libccd 2.1.
#pragma once

#include <delassus/adapters/ccd_kernel.hpp>
#include <delassus/collision/box_tree.hpp>
#include <delassus/collision/engine.hpp>
#include <delassus/core/roles.hpp>

namespace delassus {

/// Our trees of boxes, and libccd's penetrations, each certified; a refused one is computed by GjkEpa and
/// counted as a reject. Nothing is allocated in a warm step, by us or by libccd.
struct CcdCollision {
  using plays = role::Collision;

  double margin = -1;  ///< contacts up to this gap, m; negative: by size and speed (CollisionSettings)
  double contact_distance = 0;  ///< thickness between the bodies, m
  int max_points = 4;           ///< of one pair
  CollisionEngine<CcdKernel, BoxTree> engine{};

  void check() const { CollisionSettings{margin, contact_distance, max_points}.check("CcdCollision"); }
  template <class Filter = NoFilter>
  CollisionReport detect(std::span<const Collider> colliders, double h, std::vector<ContactPoint>& contacts,
                         const Filter& filter = {}) {
    return engine.detect(colliders, h, {margin, contact_distance, max_points}, contacts, filter);
  }
};

}  // namespace delassus
