/// The points of a contact patch.
#pragma once

#include <delassus/collision/contact_area.hpp>
#include <delassus/collision/inner/clip.hpp>
#include <delassus/core/fixed_array.hpp>
#include <delassus/math/linear.hpp>

#include <cstdint>

namespace delassus {

/// One point of a patch. b − a = gap · normal; `name` says which corners or edges make it.
struct PatchPoint {
  Vec3 a, b;
  double gap;
  std::uint32_t name;
};

struct Patch {
  static constexpr int capacity = inner::ClipPolygon::capacity + 1;
  static constexpr std::uint32_t witness = 0;  ///< the name of the kernel's own witness
  FixedArray<PatchPoint, capacity> point;
  int count = 0;
  int corners = 0;   ///< of a triangle's patch: the first points, which go around where it is lain on
  ContactArea area;  ///< of the faces that touch
  void clear() {
    count = corners = 0;
    area = {};
  }
  void add(const PatchPoint& p) {
    if (count < capacity) point[count++] = p;
  }
};

namespace inner {

/// Of the polygon whose corners the points on A are, in order, seen along n.
inline ContactArea area_of_patch(const Patch& patch, const Vec3& n, const RoundFace& first = {}, const RoundFace& second = {}) {
  return area_of(patch.count, [&](int k) -> const Vec3& { return patch.point[k].a; }, n, first, second);
}

/// Of a patch that is not empty.
inline int deepest(const Patch& patch) {
  int best = 0;
  for (int i = 1; i < patch.count; ++i)
    if (patch.point[i].gap < patch.point[best].gap) best = i;
  return best;
}

}  // namespace inner
}  // namespace delassus
