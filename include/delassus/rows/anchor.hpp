/// An end of a constraint: a material point of some body, with a frame where the body has one.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>

#include <cstdint>
#include <cstring>

namespace delassus {

/// Names a material point by set, block and local coordinates; the set alone knows which blocks move it.
/// `local` is in the body's frame (m) for bodies with a frame, ignored for a particle. The world is the
/// anchor without a set; its `local` is in world coordinates, so that `Anchor{}`, an end that was not given, is the
/// world's origin.
struct Anchor {
  Index set = -1;                 ///< of the world, in its order; −1: the world itself, or not yet told
  Index block = -1;               ///< of the set
  Vec3 local = zero<Vec3>();      ///< place in the body or in the world, m
  Quat frame = Quat::Identity();  ///< of a joint, in the body or in the world; unit
  bool has_frame = true;          ///< false of a particle and of a point on an element
  std::uint32_t generation = 0;   ///< that of the handle it was made of
  std::uint32_t owner = 0;        ///< the number of its set; 0: the world, and of an end of a contact
  Index element = -1;  ///< of a body with elements: the one the point is in; `local` is its place there

  /// Also true of an anchor of a body that no loop has seen: its `set` is not told before.
  bool is_world() const { return set < 0; }
};

/// to = from, as bytes: Eigen's assignment of a quaternion is a dozen functions in a build without inlining.
inline void assign(Anchor& to, const Anchor& from) { std::memcpy(static_cast<void*>(&to), &from, sizeof(Anchor)); }

/// An item that holds an array `parts` of pairs of material points, each with a and b.
template <class Item>
concept HasParts = requires(const Item& item) { item.parts[0].a.owner, item.parts[0].b.owner; };

/// An item that holds two material points, a and b, or pairs of them. One that couples two joints says c and d as well.
template <class Item>
concept HasEnds = HasParts<Item> || requires(const Item& item) { item.a.owner, item.b.owner; };

/// f(a, b) for every pair of ends that an item holds apart or together; nothing for one without ends.
template <class Item, class F>
[[gnu::always_inline]] inline void each_pair(Item& item, F&& f) {
  if constexpr (HasParts<Item>) {
    for (auto& part : item.parts)
      if (part.is_given()) f(part.a, part.b);
  } else if constexpr (HasEnds<Item>) {
    f(item.a, item.b);
  }
}
/// f(anchor) for every end of an item; nothing for one without ends.
template <class Item, class F>
[[gnu::always_inline]] inline void each_end(Item& item, F&& f) {
  each_pair(item, [&](auto& a, auto& b) __attribute__((always_inline)) { f(a), f(b); });
  if constexpr (requires { item.c.owner, item.d.owner; }) f(item.c), f(item.d);
}

/// A point of the world (m), with a frame.
inline Anchor world_anchor(const Vec3& point, const Quat& frame = Quat::Identity()) {
  return {.local = point, .frame = frame};
}

}  // namespace delassus
