/// What a pair that rests keeps of its patch, so that the patch is not cut anew while nothing moves.
#pragma once

#include <delassus/collision/pair_memory.hpp>
#include <delassus/geometry/support.hpp>

#include <bit>

namespace delassus::inner {

/// A number for what a shape is, the same wherever the shape lies in memory.
inline std::uint64_t fingerprint(const Shape& s) {
  std::uint64_t sum = std::uint64_t(s.kind) + 1;
  const auto mix = [&](double x) { sum = (sum ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15ull; };
  if (s.kind == ShapeKind::convex_hull) {
    sum = (sum ^ s.hull->fingerprint()) * 0x9e3779b97f4a7c15ull;
  } else {
    for (const double x : s.size) mix(x);
  }
  return sum ^ sum >> 29;
}

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
  Vec3 normal_a = Vec3::Zero(), normal_b = Vec3::Zero();  ///< as A sees it, as B does
  std::array<double, capacity> gap{};                     ///< when the points were made, m

  /// Takes down what was just made in full, for the normal n in the frame of A.
  void keep(std::uint64_t of, const Pose& b_in_a, const Vec3& n, double up_to) {
    if (owner == NormalOwner::kernel || count < 3) return;
    margin = up_to;
    shapes = of;
    normal_a = n;
    normal_b = b_in_a.rotation.transpose() * n;
    for (int k = 0; k < count; ++k) gap[k] = n.dot(b_in_a.to_world(point[k].local_b) - point[k].local_a);
  }

  /// The points of `last` as they are now and the normal n, in the frame of A; false when they have to be
  /// made in full.
  bool repeat(const RestingPair& last, std::uint64_t of, const Pose& b_in_a, double reach, double scale,
              std::array<PatchPoint, capacity>& now, Vec3& n) {
    if (!(reach <= last.margin) || of != last.shapes) return false;
    const bool is_a = last.owner == NormalOwner::a;
    const Vec3 turned = b_in_a.rotation * last.normal_b;
    n = is_a ? last.normal_a : turned;
    if (!((turned - last.normal_a).squaredNorm() <= stillness * stillness)) return false;
    const double still = stillness * scale;
    for (int k = 0; k < last.count; ++k) {
      const Vec3 &a = last.point[k].local_a, b = b_in_a.to_world(last.point[k].local_b), apart = b - a;
      const double g = n.dot(apart);
      if (!((apart - g * n).squaredNorm() <= still * still) || !(std::abs(g - last.gap[k]) <= still))
        return false;
      now[k] = is_a ? PatchPoint{b - g * n, b, g, 0} : PatchPoint{a, a + g * n, g, 0};
    }
    margin = last.margin;
    shapes = last.shapes;
    normal_a = last.normal_a;
    normal_b = last.normal_b;
    owner = last.owner;
    count = last.count;
    for (int k = 0; k < count; ++k) point[k] = last.point[k], gap[k] = last.gap[k];
    return true;
  }
};

}  // namespace delassus::inner
