/// The contacts of a pair from the points of its patch: which of them, under which names.
#pragma once

#include <delassus/collision/collider.hpp>
#include <delassus/collision/inner/reduce.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace delassus::inner {

/// Two colliders of a call that are to be asked for contacts.
struct PairJob {
  std::uint64_t pair;
  Index a, b;
  bool operator<(const PairJob& o) const { return pair < o.pair; }
};

/// The id, or the next number that no contact has from the place `first` on.
inline std::uint32_t unused(std::uint32_t id, std::size_t first, const std::vector<ContactPoint>& out) {
  for (;; ++id) {
    bool is_used = false;
    for (std::size_t i = first; i < out.size(); ++i) is_used = is_used || out[i].feature == id;
    if (!is_used) return id;
  }
}

/// The contact of a point in the frame of A, whose world normal is n.
inline ContactPoint contact_of(const PairJob& job, const Pose& a, const PatchPoint& p, const Vec3& n,
                               double contact_distance, std::uint32_t id) {
  const Vec3 shift = 0.5 * contact_distance * n;
  return {.a = job.a,
          .b = job.b,
          .point_a = a.to_world(p.a) + shift,
          .point_b = a.to_world(p.b) - shift,
          .normal = n,
          .gap = p.gap - contact_distance,
          .pair = job.pair,
          .feature = id};
}

/// Chooses up to `most` points of the patch with the normal n, both in the frame of A, and takes them down in
/// `now`: first those that continue a point of `last`, by its id, then the others by their names or the next
/// number that is free. Calls add(i, id) for each, which appends it to `out`, where the pair's contacts begin at
/// `first`.
template <class Add>
void name_points(const Patch& patch, const PairMemory& last, const Pose& b_in_a, const Vec3& n, double scale,
                 int most, std::size_t first, const std::vector<ContactPoint>& out, PairMemory& now,
                 const Add& add) {
  const Continuation continues(patch, last, b_in_a, scale);
  const Choice choice = reduce(patch, continues, n, scale, std::clamp(most, 1, PairMemory::capacity));
  now.area = patch.area;
  for (const bool is_old : {true, false})
    for (int k = 0; k < choice.count; ++k) {
      const int i = choice.index[k], before = continues.of[i];
      if ((before >= 0) != is_old) continue;
      const PatchPoint& p = patch.point[i];
      const std::uint32_t id = unused(is_old ? last.point[before].id : p.name, first, out);
      now.point[now.count++] = {p.name, id, p.a, b_in_a.to_local(p.b)};
      add(i, id);
    }
}

}  // namespace delassus::inner
