/// An end of a constraint: a material point of some body, with a frame where the body has one.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>

#include <cstdint>

namespace delassus {

/// Names a material point by set, block and local coordinates; the set alone knows which blocks move it.
/// `local` is in the body's frame (m) for bodies with a frame, ignored for a particle. The world is the
/// anchor without a set; its `local` is in world coordinates, so that `Anchor{}`, an end that was not given, is the
/// world's origin.
struct Anchor {
  Index set = -1;
  Index block = -1;
  Vec3 local = zero<Vec3>();
  Quat frame = Quat::Identity();
  bool has_frame = true;
  std::uint32_t generation = 0;
  std::uint32_t owner = 0;
  Index element = -1;  ///< of a body with elements: the one the point is in; `local` is its place there

  bool is_world() const { return set < 0; }
};

/// An item that holds two material points, a and b. One that couples two joints says c and d as well.
template <class Item>
concept HasEnds = requires(const Item& item) { item.a.owner, item.b.owner; };

/// f(anchor) for every end of an item; nothing for one without ends.
template <class Item, class F>
void each_end(Item& item, F&& f) {
  if constexpr (HasEnds<Item>) f(item.a), f(item.b);
  if constexpr (requires { item.c.owner, item.d.owner; }) f(item.c), f(item.d);
}

/// A point of the world (m), with a frame.
inline Anchor world_anchor(const Vec3& point, const Quat& frame = Quat::Identity()) {
  return {.local = point, .frame = frame};
}

}  // namespace delassus
