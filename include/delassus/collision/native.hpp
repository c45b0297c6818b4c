/// The collision backend that needs nothing else: our own broad phase and our own kernel.
#pragma once

#include <delassus/collision/box_tree.hpp>
#include <delassus/collision/engine.hpp>
#include <delassus/core/defined_once.hpp>
#include <delassus/core/roles.hpp>

namespace delassus {

/// The backend with this kernel, as its refusals call it.
template <class Kernel>
inline constexpr const char* name_of_backend = "NativeCollision";

/// Pairs from `Broad`, distances from `Kernel`. A template, so that only a program that detects collisions compiles it.
template <NarrowKernel Kernel, BroadPhase Broad>
struct NativeDetection {
  using plays = role::Collision;

  double margin = -1;  ///< contacts up to this gap, m; negative: by size and speed (CollisionSettings)
  double contact_distance = 0;  ///< thickness between the bodies, m
  int max_points = 4;           ///< of one pair
  inner::DefinedOnce<CollisionEngine<Kernel, Broad>> engine{};

  void check() const { CollisionSettings{margin, contact_distance, max_points}.check(name_of_backend<Kernel>); }
  template <class Filter = NoFilter>
  CollisionReport detect(std::span<const Collider> colliders, double h, std::vector<ContactPoint>& contacts,
                         const Filter& filter = {});
};

template <NarrowKernel Kernel, BroadPhase Broad>
template <class Filter>
CollisionReport NativeDetection<Kernel, Broad>::detect(std::span<const Collider> colliders, double h,
                                                       std::vector<ContactPoint>& contacts, const Filter& filter) {
  return engine.detect(colliders, h, {margin, contact_distance, max_points}, contacts, filter);
}

/// Trees of boxes, then formulas, GJK and EPA.
using NativeCollision = NativeDetection<GjkEpa, BoxTree>;

}  // namespace delassus
