/// Collision detection with FCL, the Flexible Collision Library 0.7.
#pragma once

#include <delassus/adapters/fcl_kernel.hpp>
#include <delassus/adapters/fcl_tree.hpp>
#include <delassus/collision/engine.hpp>
#include <delassus/core/roles.hpp>

namespace delassus {

/// FCL's tree and FCL's distances, each answer certified; a refused one is computed by GjkEpa and counted as
/// a reject. A warm step allocates nothing of ours; FCL itself allocates in `collide` (its list of contact
/// points).
struct FclCollision {
  using plays = role::Collision;

  double margin = -1;  ///< contacts up to this gap, m; negative: by size and speed (CollisionSettings)
  double contact_distance = 0;  ///< thickness between the bodies, m
  int max_points = 4;           ///< of one pair
  CollisionEngine<FclKernel, FclTree> engine{};

  void check() const { CollisionSettings{margin, contact_distance, max_points}.check("FclCollision"); }
  template <class Filter = NoFilter>
  CollisionReport detect(std::span<const Collider> colliders, double h, std::vector<ContactPoint>& contacts,
                         const Filter& filter = {}) {
    return engine.detect(colliders, h, {margin, contact_distance, max_points}, contacts, filter);
  }
};

}  // namespace delassus
