/// Contacts of surfaces of triangles with convex shapes and with each other: collected by triangle, chosen by
/// normal, named from step to step.
#pragma once

#include <delassus/collision/collider.hpp>
#include <delassus/collision/inner/deep_surfaces.hpp>
#include <delassus/collision/inner/face_pieces.hpp>
#include <delassus/collision/inner/hull_of_patch.hpp>
#include <delassus/collision/inner/margins.hpp>
#include <delassus/collision/inner/name_points.hpp>
#include <delassus/collision/inner/patch_doubts.hpp>
#include <delassus/collision/inner/share_area.hpp>
#include <delassus/collision/inner/surface_crossing.hpp>
#include <delassus/collision/triangle_patch.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/fixed_array.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/geometry/inner/flat_tree.hpp>

#include <algorithm>
#include <span>
#include <vector>

namespace delassus::inner {

/// What outlives a step: for every pair and every direction in which it touched, the points, in the surface's
/// frame.
class SurfacePairs {
 public:
  void begin() { next_.clear(); }
  void end() { memory_.swap(next_); }
  void memory(auto& archive) { archive(memory_); }

  /// Appends the contacts of the surface, posed and moving as the collider `job.a`, with the convex collider or
  /// the half-space `job.b`. Call by ascending pairs. Returns how many triangles were looked at.
  template <class Surface>
  Index collide(const Surface& surface, std::span<const Collider> colliders, const PairJob& job, double h,
                const CollisionSettings& settings, std::vector<ContactPoint>& out) {
    const Collider &a = colliders[job.a], &b = colliders[job.b];
    const bool is_plane = b.shape.kind == ShapeKind::half_space;
    const Pair pair(job, a, b, length_scale(is_plane ? a.shape : b.shape), h, settings);
    points_.clear();
    pieces_.clear();
    Index queries = 0;
    if (is_plane) {
      queries = collect_on_plane(surface, plane_of(b.shape, pair.b_in_a), pair.reach);
    } else {
      const auto add = [&](Index t, const Patch& patch, const Vec3& n) {
        for (int i = 0; i < patch.count; ++i) add_within_margin(pair, patch.point[i], n, t);
        const auto corner = [&](int k) -> const Vec3& { return patch.point[k].a; };
        if (patch.corners >= 3) pieces_.add(patch.corners, corner, n, patch.point[deepest(patch)].gap);
      };
      queries = doubts_.collect(surface, b.shape, pair.b_in_a, pair.reach, pair.scale, add);
      erase_if(points_, [&](const SurfaceContact& p) { return doubts_.is_false(p.triangle); });
    }
    emit(pair, out);
    return queries;
  }

  /// The same for two surfaces; returns how many pairs of triangles were looked at. What is deeper than the
  /// margin and than 2e-2 L is looked for where nothing else overlaps.
  template <class SurfaceA, class SurfaceB>
  Index cross(const SurfaceA& surface_a, const SurfaceB& surface_b, std::span<const Collider> colliders,
              const PairJob& job, double h, const CollisionSettings& settings, std::vector<ContactPoint>& out) {
    const Collider &a = colliders[job.a], &b = colliders[job.b];
    const double scale = pair_scale(a.shape, b.shape);
    const Pair pair(job, a, b, scale, h, settings);
    const TouchRange range{std::max(pair.reach, 2e-2 * scale), 0.5 * scale, scale};
    features_.clear();
    const PosedSurface<SurfaceA> posed_a{surface_a};
    const PosedSurface<SurfaceB> posed_b{surface_b, pair.b_in_a};
    const Index queries = SurfaceCrossing(posed_a, posed_b, range, features_).collect();
    const auto overlaps = [](const FeatureContact& f) { return f.point.gap < 0; };
    if (std::none_of(features_.begin(), features_.end(), overlaps))
      collect_deep(posed_a, posed_b, scale, cuts_, features_);
    points_.clear();
    pieces_.clear();
    for (const FeatureContact& f : features_) add_within_margin(pair, f.point, f.normal, -1);
    emit(pair, out);
    return queries;
  }

 private:
  struct Pair {
    const PairJob& job;
    const Collider &a, &b;
    double scale, h;
    const CollisionSettings& settings;
    Pose b_in_a;
    double reach;

    Pair(const PairJob& j, const Collider& first, const Collider& second, double size, double step,
         const CollisionSettings& s)
        : job(j), a(first), b(second), scale(size), h(step), settings(s), b_in_a(a.pose.to_local(b.pose)),
          reach(s.contact_distance + widest_margin(top_speed(a) + top_speed(b), size, step, s)) {}
  };

  void add_within_margin(const Pair& pair, const PatchPoint& p, const Vec3& n, Index triangle) {
    const Pose& pose = pair.a.pose;
    const double margin = margin_along(pair.a, pair.b, pose.rotation * n, pose.to_world(p.a), pair.scale,
                                       pair.h, pair.settings);
    if (p.gap <= pair.settings.contact_distance + margin) points_.push_back({p, n, triangle});
  }

  /// Corners of the surface with a gap up to `reach` over a plane.
  template <class Surface>
  Index collect_on_plane(const Surface& surface, const Plane& plane, double reach) {
    Index queries = 0;
    const auto meets = [&](const Bounds& box) {
      double lowest = -plane.offset;
      for (int k = 0; k < 3; ++k)
        lowest += plane.normal[k] * (plane.normal[k] > 0 ? box.low[k] : box.high[k]);
      return lowest <= reach;
    };
    surface.visit(meets, [&](Index t) {
      ++queries;
      const Triangle triangle = surface.triangle(t);
      if (dot(triangle.normal, plane.normal) <= -0.9962) {
        double lowest = reach, highest = -reach;
        for (const Vec3& corner : triangle.point) {
          const double gap = dot(plane.normal, corner) - plane.offset;
          lowest = std::min(lowest, gap), highest = std::max(highest, gap);
        }
        if (highest <= reach) pieces_.add(3, [&](int k) -> const Vec3& { return triangle.point[k]; }, -plane.normal, lowest);
      }
      for (int k = 0; k < 3; ++k) {
        const Vec3& corner = triangle.point[k];
        const double gap = dot(plane.normal, corner) - plane.offset;
        if (!(gap <= reach)) continue;
        const Vec3 foot = corner - gap * plane.normal;
        points_.push_back({{corner, foot, gap, vertex_name(true, triangle.corner[k])}, -plane.normal});
      }
    });
    return queries;
  }

  void find_last(std::uint64_t key) {
    const auto less = [](const PairMemory& m, std::uint64_t k) { return m.pair < k; };
    last_ = std::size_t(inner::lower_bound(memory_.data(), memory_.data() + memory_.size(), key, less) - memory_.begin());
    is_claimed_.clear();
    for (std::size_t i = last_; i < memory_.size() && memory_[i].pair == key; ++i)
      is_claimed_.push_back(false);
  }

  /// Turns the points into contacts of the pair, group by group, sorted by feature.
  void emit(const Pair& pair, std::vector<ContactPoint>& out) {
    find_last(pair.job.pair);
    const std::size_t first_out = out.size();
    while (!points_.empty()) {
      split_group();
      emit_group(pair, first_out, out);
    }
    inner::sort(out.data() + first_out, out.data() + out.size(),
              [](const ContactPoint& p, const ContactPoint& q) { return p.feature < q.feature; });
  }

  /// Moves the first point, and all whose normals are within 5° of its own, into `group_`.
  void split_group() {
    const Vec3 n = points_[0].normal;
    group_.clear();
    erase_if(points_, [&](const SurfaceContact& p) {
      if (dot(p.normal, n) < 0.9962) return false;
      group_.push_back(p);
      return true;
    });
  }

  /// What is remembered of this pair in about this direction.
  PairMemory remembered(const Vec3& n) {
    int best = -1;
    double closeness = 0.9;
    for (std::size_t i = 0; i < is_claimed_.size(); ++i) {
      const double c = dot(memory_[last_ + i].normal, n);
      if (!is_claimed_[i] && c > closeness) closeness = c, best = int(i);
    }
    if (best < 0) return {};
    is_claimed_[best] = true;
    return memory_[last_ + std::size_t(best)];
  }

  /// The cap with which B meets a surface whose normal is n, or none.
  static RoundFace round_face_against(const Pair& pair, const Vec3& n) {
    const Shape& s = pair.b.shape;
    if (s.kind != ShapeKind::cylinder && s.kind != ShapeKind::cone) return {};
    const Face face = face_towards(s, Vec3(-transposed_times(pair.b_in_a.rotation, n)));
    return round_face(s, posed(face, pair.b_in_a), pair.b_in_a.position);
  }

  /// The area is that of the pieces, where they are known, and not of the hull.
  void find_area(const Vec3& n, double reach) {
    double least = group_[0].point.gap;
    for (const SurfaceContact& p : group_) least = std::min(least, p.point.gap);
    const ContactArea area = pieces_.area(n, least + reach);
    if (area.size > 0) patch_.area = area;
  }

  void emit_group(const Pair& pair, std::size_t first_out, std::vector<ContactPoint>& out) {
    const Vec3 n = group_[0].normal;
    const RoundFace round = round_face_against(pair, n);
    hull_.choose(group_, n, pair.scale, round, patch_, source_);
    if (!(round.radius > 0)) find_area(n, 1e-3 * pair.scale);
    PairMemory now;
    now.pair = pair.job.pair;
    now.normal = n;
    const auto add = [&](int i, std::uint32_t id) {
      const Vec3 normal = pair.a.pose.rotation * group_[source_[i]].normal;
      out.push_back(contact_of(pair.job, pair.a.pose, patch_.point[i], normal, pair.settings.contact_distance, id));
      if (pair.a.key >= pair.b.key) out.back().exchange_bodies();
    };
    name_points(patch_, remembered(n), pair.b_in_a, n, pair.scale, pair.settings.max_points, first_out, out, now,
                add);
    share_area(now.area, pair.a.pose, now.count, out);
    next_.push_back(now);
  }

  Array<SurfaceContact> points_, group_;
  std::vector<FeatureContact> features_;
  Array<Cut> cuts_;
  Patch patch_;
  PatchDoubts doubts_;
  FixedArray<Index, Patch::capacity> source_{};
  HullOfPatch hull_;
  FacePieces pieces_;
  Array<PairMemory> memory_, next_;
  std::size_t last_ = 0;
  Array<char> is_claimed_;
};

}  // namespace delassus::inner
