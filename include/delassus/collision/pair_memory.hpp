/// What is kept of a pair from step to step: its normal and its points, so that contacts keep their names.
#pragma once

#include <delassus/collision/inner/snap_normal.hpp>
#include <delassus/collision/manifold.hpp>
#include <delassus/core/fixed_array.hpp>

#include <cstdint>

namespace delassus {

/// A contact as it was: its name in the patch, the id it was given when it was born, and where it was on each
/// body.
struct RememberedPoint {
  std::uint32_t name = 0, id = 0;
  Vec3 local_a, local_b;
};

/// Where two bodies that were apart met: the normal and the arms of the middle of their patch. World frame, m.
struct RememberedImpact {
  Vec3 normal = zero<Vec3>(), arm_a = zero<Vec3>(), arm_b = zero<Vec3>();
  std::uint32_t id = 0;  ///< of the first contact there
  bool is_there = false;
};

/// One of them, of a pair that may have several.
struct PairImpact {
  std::uint64_t pair = 0;
  RememberedImpact impact;
};

struct PairMemory {
  static constexpr int capacity = 8;
  // What all pairs are asked for comes first, in one or two lines of the cache.
  std::uint64_t pair = 0;
  Vec3 normal = zero<Vec3>();  ///< world frame
  std::uint8_t count = 0;
  inner::NormalOwner owner = inner::NormalOwner::kernel;
  bool is_plain = true;  ///< a witness or nothing, and no impact: a pair that touches in one point needs no more
  FixedArray<RememberedPoint, capacity> point;
  ContactArea area;  ///< of the whole patch, in the frame of A
  RememberedImpact impact;  ///< of the last step

  /// What another one remembers, without the places of points that it does not have.
  void copy(const PairMemory& other) {
    pair = other.pair, normal = other.normal, count = other.count, owner = other.owner, is_plain = other.is_plain;
    for (int k = 0; k < count; ++k) point[k] = other.point[k];
    area = other.area;
    impact.is_there = other.impact.is_there;
    if (impact.is_there) impact = other.impact;
  }
};

namespace inner {

/// For each point of the patch the remembered one it continues, or −1: first by name, then by place. The
/// place may have moved by 2e-2 of the scale on one of the bodies: a corner that slides over a face stays
/// where it is on its own. The lowest point of a rim that has come to lie flat leaves its place to the corner
/// next to it, over which the body had tipped.
struct Continuation {
  FixedArray<std::int8_t, Patch::capacity> of;

  Continuation(const Patch& patch, const PairMemory& last, const Pose& b_in_a, double scale) {
    of.fill(-1);
    FixedArray<bool, PairMemory::capacity> is_taken{};
    for (int i = 0; i < patch.count; ++i)
      for (int k = 0; k < last.count && of[i] < 0; ++k)
        if (!is_taken[k] && last.point[k].name == patch.point[i].name) take(i, k, is_taken);
    for (int k = 0; k < last.count; ++k) {
      if (is_taken[k]) continue;
      int nearest = -1;
      double best = is_lowest_of_rim(last.point[k].name) ? std::numeric_limits<double>::infinity()
                                                         : 4e-4 * scale * scale;
      for (int i = 0; i < patch.count; ++i) {
        if (of[i] >= 0) continue;
        const double on_a = squared_norm(patch.point[i].a - last.point[k].local_a);
        const double on_b = squared_norm(b_in_a.to_local(patch.point[i].b) - last.point[k].local_b);
        if (std::min(on_a, on_b) < best) best = std::min(on_a, on_b), nearest = i;
      }
      if (nearest >= 0) take(nearest, k, is_taken);
    }
  }

 private:
  void take(int i, int k, FixedArray<bool, PairMemory::capacity>& is_taken) {
    of[i] = std::int8_t(k);
    is_taken[k] = true;
  }
};

}  // namespace inner
}  // namespace delassus
