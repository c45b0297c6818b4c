/// Contacts of surfaces of triangles with convex shapes and with each other: collected by triangle, chosen by
/// normal, named from step to step.
#pragma once

#include <delassus/collision/collider.hpp>
#include <delassus/collision/inner/deep_surfaces.hpp>
#include <delassus/collision/inner/hull_of_patch.hpp>
#include <delassus/collision/inner/margins.hpp>
#include <delassus/collision/inner/patch_doubts.hpp>
#include <delassus/collision/inner/reduce.hpp>
#include <delassus/collision/inner/surface_crossing.hpp>
#include <delassus/collision/triangle_patch.hpp>
#include <delassus/core/array.hpp>
#include <delassus/geometry/inner/flat_tree.hpp>

#include <algorithm>
#include <array>
#include <cmath>
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

  /// Appends the contacts of the surface, posed and moving as the collider at `place_a`, with the convex
  /// collider or the half-space at `place_b`. Call by ascending pairs. Returns how many triangles were looked
  /// at.
  template <class Surface>
  Index collide(const Surface& surface, std::span<const Collider> colliders, Index place_a, Index place_b,
                double h, const CollisionSettings& settings, std::vector<ContactPoint>& out) {
    const Collider &a = colliders[place_a], &b = colliders[place_b];
    const Pose b_in_a{.position = a.pose.to_local(b.pose.position),
                      .rotation = a.pose.rotation.transpose() * b.pose.rotation};
    const bool is_plane = b.shape.kind == ShapeKind::half_space;
    const double scale = length_scale(is_plane ? a.shape : b.shape);
    const double reach = settings.contact_distance + widest_margin(a, b, scale, h, settings);
    const Index queries = is_plane ? collect_on_plane(surface, plane_of(b.shape, b_in_a), reach)
                                   : collect(surface, a, b, b_in_a, reach, scale, h, settings);
    emit({a, b, b_in_a, pair_key(a.key, b.key), place_a, place_b, scale}, settings, out);
    return queries;
  }

  /// The same for two surfaces; returns how many pairs of triangles were looked at. What is deeper than the
  /// margin and than 2e-2 L is looked for where nothing else overlaps.
  template <class SurfaceA, class SurfaceB>
  Index cross(const SurfaceA& surface_a, const SurfaceB& surface_b, std::span<const Collider> colliders,
              Index place_a, Index place_b, double h, const CollisionSettings& settings,
              std::vector<ContactPoint>& out) {
    const Collider &a = colliders[place_a], &b = colliders[place_b];
    const Pose b_in_a{.position = a.pose.to_local(b.pose.position),
                      .rotation = a.pose.rotation.transpose() * b.pose.rotation};
    const double scale = pair_scale(a.shape, b.shape);
    const double reach = settings.contact_distance + widest_margin(a, b, scale, h, settings);
    const TouchRange range{std::max(reach, 2e-2 * scale), 0.5 * scale, scale};
    features_.clear();
    const PosedSurface<SurfaceA> posed_a{surface_a};
    const PosedSurface<SurfaceB> posed_b{surface_b, b_in_a};
    const Index queries = SurfaceCrossing(posed_a, posed_b, range, features_).collect();
    const auto overlaps = [](const FeatureContact& f) { return f.point.gap < 0; };
    if (std::none_of(features_.begin(), features_.end(), overlaps))
      collect_deep(posed_a, posed_b, scale, cuts_, features_);
    points_.clear();
    for (const FeatureContact& f : features_)
      add_within_margin(a, b, f.point, f.normal, -1, scale, h, settings);
    emit({a, b, b_in_a, pair_key(a.key, b.key), place_a, place_b, scale}, settings, out);
    return queries;
  }

 private:
  struct Pair {
    const Collider &a, &b;
    const Pose& b_in_a;
    std::uint64_t key;
    Index place_a, place_b;
    double scale;
  };

  template <class Surface>
  Index collect(const Surface& surface, const Collider& a, const Collider& b, const Pose& b_in_a,
                double reach, double scale, double h, const CollisionSettings& settings) {
    points_.clear();
    doubts_.begin();
    const Aabb tight = tight_box(b.shape, b_in_a);
    const Bounds near{tight.min() - Vec3::Constant(reach), tight.max() + Vec3::Constant(reach)};
    if (!is_finite(near.low) || !is_finite(near.high)) return 0;
    Index queries = 0;
    const auto meets = [&](const Bounds& box) { return box.meets(near); };
    surface.visit(meets, [&](Index t) {
      ++queries;
      Vec3 n;
      const PatchTrust trust = triangle_patch(surface.triangle(t), b.shape, b_in_a, reach, scale, patch_, n);
      if (trust == PatchTrust::none) return;
      for (int i = 0; i < patch_.count; ++i)
        add_within_margin(a, b, patch_.point[i], n, t, scale, h, settings);
      doubts_.add(t, patch_, n, trust);
    });
    doubts_.judge([&](Index t) { return surface.triangle(t); }, b.shape, b_in_a, scale);
    erase_if(points_, [&](const SurfaceContact& p) { return doubts_.is_false(p.triangle); });
    return queries;
  }

  void add_within_margin(const Collider& a, const Collider& b, const PatchPoint& p, const Vec3& n,
                         Index triangle, double scale, double h, const CollisionSettings& settings) {
    const double margin = margin_along(a, b, a.pose.rotation * n, a.pose.to_world(p.a), scale, h, settings);
    if (p.gap <= settings.contact_distance + margin) points_.push_back({p, n, triangle});
  }

  /// Corners of the surface with a gap up to `reach` over a plane.
  template <class Surface>
  Index collect_on_plane(const Surface& surface, const Plane& plane, double reach) {
    points_.clear();
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
      for (int k = 0; k < 3; ++k) {
        const Vec3& corner = triangle.point[k];
        const double gap = plane.normal.dot(corner) - plane.offset;
        if (!(gap <= reach)) continue;
        const std::uint32_t name = corner_name(true, std::uint32_t(triangle.corner[k]) & 0x3fffffffu);
        points_.push_back({{corner, corner - gap * plane.normal, gap, name}, -plane.normal});
      }
    });
    return queries;
  }

  void find_last(std::uint64_t key) {
    const auto less = [](const PairMemory& m, std::uint64_t k) { return m.pair < k; };
    last_ = std::size_t(std::lower_bound(memory_.begin(), memory_.end(), key, less) - memory_.begin());
    is_claimed_.clear();
    for (std::size_t i = last_; i < memory_.size() && memory_[i].pair == key; ++i)
      is_claimed_.push_back(false);
  }

  /// Turns the points into contacts of the pair, group by group, sorted by feature.
  void emit(const Pair& pair, const CollisionSettings& settings, std::vector<ContactPoint>& out) {
    find_last(pair.key);
    const std::size_t first_out = out.size();
    while (!points_.empty()) {
      split_group();
      emit_group(pair, settings, first_out, out);
    }
    std::sort(out.begin() + std::ptrdiff_t(first_out), out.end(),
              [](const ContactPoint& p, const ContactPoint& q) { return p.feature < q.feature; });
  }

  /// Moves the first point, and all whose normals are within 5° of its own, into `group_`.
  void split_group() {
    const Vec3 n = points_[0].normal;
    group_.clear();
    erase_if(points_, [&](const SurfaceContact& p) {
      if (p.normal.dot(n) < 0.9962) return false;
      group_.push_back(p);
      return true;
    });
  }

  /// What is remembered of this pair in about this direction.
  PairMemory remembered(const Vec3& n) {
    int best = -1;
    double closeness = 0.9;
    for (std::size_t i = 0; i < is_claimed_.size(); ++i) {
      const double c = memory_[last_ + i].normal.dot(n);
      if (!is_claimed_[i] && c > closeness) closeness = c, best = int(i);
    }
    if (best < 0) return {};
    is_claimed_[best] = true;
    return memory_[last_ + std::size_t(best)];
  }

  void emit_group(const Pair& pair, const CollisionSettings& settings, std::size_t first_out,
                  std::vector<ContactPoint>& out) {
    const Vec3 n = group_[0].normal;
    hull_.choose(group_, n, pair.scale, patch_, source_);
    const PairMemory last = remembered(n);
    const Continuation continues(patch_, last, pair.b_in_a, pair.scale);
    const int limit = std::clamp(settings.max_points, 1, PairMemory::capacity);
    const Choice choice = reduce(patch_, continues, n, pair.scale, limit);
    PairMemory now;
    now.pair = pair.key;
    now.normal = n;
    for (const bool is_old : {true, false})
      for (int k = 0; k < choice.count; ++k) {
        const int i = choice.index[k], before = continues.of[i];
        if ((before >= 0) != is_old) continue;
        const PatchPoint& p = patch_.point[i];
        const std::uint32_t id = unused(is_old ? last.point[before].id : p.name, first_out, out);
        now.point[now.count++] = {p.name, id, p.a, pair.b_in_a.to_local(p.b)};
        out.push_back(contact(pair, p, group_[source_[i]].normal, settings.contact_distance, id));
      }
    next_.push_back(now);
  }

  /// The id, or the next number that no contact of the pair has.
  static std::uint32_t unused(std::uint32_t id, std::size_t first, const std::vector<ContactPoint>& out) {
    for (;; ++id) {
      bool is_used = false;
      for (std::size_t i = first; i < out.size(); ++i) is_used = is_used || out[i].feature == id;
      if (!is_used) return id;
    }
  }

  static ContactPoint contact(const Pair& pair, const PatchPoint& p, const Vec3& n, double contact_distance,
                              std::uint32_t id) {
    const Vec3 normal = pair.a.pose.rotation * n, shift = 0.5 * contact_distance * normal;
    ContactPoint c{.a = pair.place_a,
                   .b = pair.place_b,
                   .point_a = pair.a.pose.to_world(p.a) + shift,
                   .point_b = pair.a.pose.to_world(p.b) - shift,
                   .normal = normal,
                   .gap = p.gap - contact_distance,
                   .pair = pair.key,
                   .feature = id};
    if (pair.a.key < pair.b.key) return c;
    std::swap(c.a, c.b);
    std::swap(c.point_a, c.point_b);
    c.normal = -normal;
    return c;
  }

  Array<SurfaceContact> points_, group_;
  std::vector<FeatureContact> features_;
  Array<Cut> cuts_;
  Patch patch_;
  PatchDoubts doubts_;
  std::array<Index, Patch::capacity> source_{};
  HullOfPatch hull_;
  Array<PairMemory> memory_, next_;
  std::size_t last_ = 0;
  std::vector<bool> is_claimed_;
};

}  // namespace delassus::inner
