/// Which of the triangles whose answer is doubtful are believed: those off which nothing shallower takes the
/// shape.
#pragma once

#include <delassus/collision/triangle_patch.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/geometry/inner/flat_tree.hpp>

#include <algorithm>

namespace delassus::inner {

/// The answers of the triangles of one surface about one shape. At the rim of a cliff the top, too, says how
/// deep the shape is below it, and is wrong: a push off the side, which is shallower, takes the shape off
/// both. On a plain, however many its triangles, no push off one takes it off those where it is deeper.
class PatchDoubts {
 public:
  /// Calls add(t, patch, normal) for the triangles that the shape, posed in their frame, comes
  /// as near as `reach` m, and judges them. Returns how many triangles were looked at. skip(triangle, t) is called for those whose
  /// neighbours are nearer to the shape.
  template <class Surface, class Add, class Skip>
  Index collect(const Surface& surface, const Shape& shape, const Pose& pose, double reach, double scale,
                const Add& add, const Skip& skip) {
    answers_.clear();
    false_.clear();
    const Bounds near = bounds_around(shape, pose, reach);
    if (!is_finite(near.low) || !is_finite(near.high)) return 0;
    Index queries = 0;
    const auto meets = [&](const Bounds& box) { return box.meets(near); };
    surface.visit(meets, [&](Index t) {
      const Triangle triangle = surface.triangle(t);
      if (is_zero(triangle.normal)) return;
      ++queries;
      Vec3 n;
      const PatchTrust trust = triangle_patch(triangle, shape, pose, reach, scale, patch_, n);
      if (trust == PatchTrust::none) return skip(triangle, t);
      add(t, patch_, n);
      answers_.push_back({t, n, patch_.point[deepest(patch_)].gap, trust});
    });
    judge(surface, shape, pose, scale);
    return queries;
  }

  /// Whether what the triangle said is not to be believed.
  bool is_false(Index triangle) const { return inner::is_listed(false_, triangle); }

 private:
  struct Answer {
    Index triangle;
    Vec3 normal;
    double gap;
    PatchTrust trust;
  };

  /// What doubtful answers say is false where it is deeper, by 5e-3 L, than all that is sure, or without any
  /// than the shallowest, and a push off one that is as much shallower takes the shape off the triangle. Where the
  /// two face more than 45° apart, that is a push out of the whole plane of the other.
  void judge(const auto& surface, const Shape& shape, const Pose& pose, double scale) {
    const auto is_doubtful = [](const Answer& a) { return a.trust == PatchTrust::doubtful; };
    if (std::none_of(answers_.begin(), answers_.end(), is_doubtful)) return;
    inner::sort(answers_, [](const Answer& a, const Answer& b) {
      return a.gap != b.gap ? a.gap > b.gap : a.triangle < b.triangle;
    });
    const double slack = 5e-3 * scale;
    double limit = answers_[0].gap;
    for (const Answer& a : answers_)
      if (!is_doubtful(a)) limit = a.gap;
    const auto depth_along = [&](const Answer& a) {
      const Vec3 lowest = pose.to_world(support(shape, Vec3(-transposed_times(pose.rotation, a.normal))));
      return dot(a.normal, core_support(surface.triangle(a.triangle), a.normal) - lowest);
    };
    pushes_.clear();
    for (const Answer& a : answers_) {
      const bool is_deep = is_doubtful(a) && a.gap < limit - slack;
      const double depth = is_deep ? depth_along(a) : 0;
      const auto frees = [&](const Answer& push) {
        const bool is_steep = dot(push.normal, a.normal) < 0.7;
        const double way = is_steep ? depth_along(push) : -push.gap;
        if (!(way < (is_steep ? depth : -a.gap) - slack)) return false;
        const Vec3 by = (std::max(way, 0.0) + slack) * push.normal;
        return is_off(surface.triangle(a.triangle), shape, {pose.position + by, pose.rotation});
      };
      if (is_deep && std::any_of(pushes_.begin(), pushes_.end(), frees)) false_.push_back(a.triangle);
      keep_push(a);
    }
    inner::sort(false_);
  }

  /// Whether the shape is off the triangle, and has not got below it by another one's way.
  static bool is_off(const Triangle& t, const Shape& s, const Pose& pose) {
    const SignedPair r = s.kind == ShapeKind::sphere
                             ? triangle_and_sphere(t, s.size[0], pose.to_world(middle(s)))
                             : GjkEpa::convex(t, s, pose, 0, t.normal);
    if (r.status == PairStatus::near && !(r.distance >= 0)) return false;
    const Vec3 lowest = pose.to_world(support(s, Vec3(-transposed_times(pose.rotation, t.normal))));
    return !(t.height(lowest) < 0 && is_over(t, lowest, 0));
  }

  /// Of pushes within 5° the deepest stays, which is the last.
  void keep_push(const Answer& a) {
    for (Answer& push : pushes_)
      if (dot(push.normal, a.normal) > 0.9962) {
        push = a;
        return;
      }
    pushes_.push_back(a);
  }

  Array<Answer> answers_, pushes_;
  Array<Index> false_;
  Patch patch_;
};

}  // namespace delassus::inner
