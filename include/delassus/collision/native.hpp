/// The collision backend that needs nothing else: our own broad phase and our own kernel.
#pragma once

#include <delassus/collision/collider.hpp>
#include <delassus/collision/settings.hpp>
#include <delassus/core/on_demand.hpp>
#include <delassus/core/roles.hpp>

#include <span>
#include <vector>

// With compiled.hpp it is read where it is compiled. A kernel, a broad phase or a filter of your own needs it then.
#ifndef DELASSUS_COMPILED
#include <delassus/collision/native_engine.hpp>
#endif

namespace delassus {

template <class Kernel, class Broad>
class CollisionEngine;
struct GjkEpa;
template <class T>
class BasicBoxTree;
using BoxTree = BasicBoxTree<double>;

/// The backend with this kernel, as its refusals call it.
template <class Kernel>
inline constexpr const char* name_of_backend = "NativeCollision";

/// Pairs from `Broad`, distances from `Kernel`: see CollisionEngine. A template, so that only a program that detects
/// collisions compiles it.
template <class Kernel, class Broad>
struct NativeDetection {
  using plays = role::Collision;

  double margin = -1;  ///< contacts up to this gap, m; negative: by size and speed (CollisionSettings)
  double contact_distance = 0;  ///< thickness between the bodies, m
  int max_points = 4;           ///< of one pair
  inner::OnDemand<CollisionEngine<Kernel, Broad>> engine{};  ///< made by the first detection

  void check() const;
  /// What outlives a step.
  void memory(auto& archive) { engine->memory(archive); }
  template <class Filter = NoFilter>
  CollisionReport detect(std::span<const Collider> colliders, double h, std::vector<ContactPoint>& contacts,
                         const Filter& filter = {});
  /// Those of the pairs that have none since then and meet by the velocities that the colliders have now.
  template <class Filter>
  void detect_missed(std::span<const Collider> colliders, double h, std::vector<ContactPoint>& contacts, const Filter& filter);
};

template <class Kernel, class Broad>
void NativeDetection<Kernel, Broad>::check() const {
  CollisionSettings{margin, contact_distance, max_points}.check(name_of_backend<Kernel>);
}
template <class Kernel, class Broad>
template <class Filter>
CollisionReport NativeDetection<Kernel, Broad>::detect(std::span<const Collider> colliders, double h,
                                                       std::vector<ContactPoint>& contacts, const Filter& filter) {
  return engine->detect(colliders, h, {margin, contact_distance, max_points}, contacts, filter);
}
template <class Kernel, class Broad>
template <class Filter>
void NativeDetection<Kernel, Broad>::detect_missed(std::span<const Collider> colliders, double h, std::vector<ContactPoint>& contacts,
                                                   const Filter& filter) {
  engine->detect_missed(colliders, h, {margin, contact_distance, max_points}, contacts, filter);
}

/// Trees of boxes, then formulas, GJK and EPA.
using NativeCollision = NativeDetection<GjkEpa, BoxTree>;

}  // namespace delassus
