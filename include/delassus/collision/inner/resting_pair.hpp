/// What a pair that rests keeps of its patch, so that the patch is not cut anew while nothing moves.
#pragma once

#include <delassus/collision/pair_memory.hpp>
#include <delassus/core/fixed_array.hpp>
#include <delassus/core/sort.hpp>


namespace delassus::inner {

/// The points of two faces that overlap, made in full at one step and repeated in those that follow. While no
/// point, no gap and no normal has moved by more than ε = 1e-6 (of the scale L) since they were made, the
/// planes of both faces give every gap exactly,
///
///   owner A:  b = x_B + R y,  gap = n · (b − a),  a ← b − gap n;      owner B:  n = R m,  b ← a + gap n,
///
/// and only where along the faces a point lies is older than the step, by ε L at most. Where both faces serve
/// equally, a detection in full may take n from the other one: 4e-5 and, in the least gap, 7e-6 L were seen
/// between the two. Jolt keeps manifolds in this way up to 1 mm and 2°.
struct RestingPair : PairMemory {
  static constexpr double stillness = 1e-6;

  double margin = -1;        ///< up to this gap there are no other points; negative: not to be repeated
  std::uint64_t shapes = 0;  ///< fingerprint of both, and of the most points asked for
  Vec3 normal_a = zero<Vec3>(), normal_b = zero<Vec3>();  ///< as A sees it, as B does
  FixedArray<double, capacity> gap{};                     ///< when the points were made, m
  FixedArray<std::uint8_t, capacity> by_id{};             ///< the points' places in the order of their ids

  /// Begins anew, for this pair.
  void reset(std::uint64_t of) {
    pair = of;
    set_zero(normal);
    count = 0;
    owner = NormalOwner::kernel;
    is_plain = true;
    area = {};
    impact.is_there = false;
    margin = -1;
  }
  /// To be asked when the pair was detected in full.
  void see_if_plain() {
    is_plain = margin < 0 && !impact.is_there && count <= 1 && (count == 0 || (point[0].name == Patch::witness && point[0].id == Patch::witness));
  }

  /// Takes down what was just made in full, for the normal n in the frame of A.
  void keep(std::uint64_t of, const Pose& b_in_a, const Vec3& n, double up_to) {
    if (owner == NormalOwner::kernel || count < 3) return;
    margin = up_to;
    shapes = of;
    normal_a = n;
    normal_b = transposed_times(b_in_a.rotation, n);
    for (int k = 0; k < count; ++k) {
      gap[k] = dot(n, b_in_a.to_world(point[k].local_b) - point[k].local_a);
      by_id[k] = std::uint8_t(k);
    }
    inner::sort(by_id.data(), by_id.data() + count,
              [this](std::uint8_t i, std::uint8_t k) { return point[i].id < point[k].id; });
  }

  /// The points as they are now, in the order of their ids, and the normal n, in the frame of A; false when
  /// they have to be made in full.
  bool repeat(std::uint64_t of, const Pose& b_in_a, double reach, double scale,
              FixedArray<PatchPoint, capacity>& now, Vec3& n) const {
    if (!(reach <= margin) || of != shapes) return false;
    const bool is_a = owner == NormalOwner::a;
    const Vec3 turned = b_in_a.rotation * normal_b;
    n = is_a ? normal_a : turned;
    if (!(squared_norm(turned - normal_a) <= stillness * stillness)) return false;
    const double still = stillness * scale;
    for (int k = 0; k < count; ++k) {
      const RememberedPoint& p = point[by_id[k]];
      const Vec3 &a = p.local_a, b = b_in_a.to_world(p.local_b), apart = b - a;
      const double g = dot(n, apart);
      if (!(squared_norm(apart - g * n) <= still * still) || !(std::abs(g - gap[by_id[k]]) <= still))
        return false;
      now[k] = is_a ? PatchPoint{b - g * n, b, g, p.id} : PatchPoint{a, a + g * n, g, p.id};
    }
    return true;
  }
};

}  // namespace delassus::inner
