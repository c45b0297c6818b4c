/// What a host asks of the bodies between steps: rays, nearest points, overlaps, distances.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/collision/certified_pair.hpp>
#include <delassus/collision/inner/time_of_impact.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/sort.hpp>

#include <algorithm>
#include <concepts>
#include <limits>
#include <vector>

namespace delassus {

/// A point on a body. `anchor` names it as joints do, so that it can be held from here on.
struct SurfacePoint {
  bool is_found = false;  ///< false: nothing within reach
  Anchor anchor{};  ///< by the body's own coordinates
  Vec3 point = zero<Vec3>();   ///< on the surface, world frame, m
  Vec3 normal = zero<Vec3>();  ///< unit, out of the body
  double distance = 0;         ///< m: along the ray, or from the point asked for, negative inside
  explicit operator bool() const { return is_found; }
};

/// The shortest way between two bodies, or out of each other. World frame, m; b − a = distance · normal.
struct Separation {
  double distance = 0;  ///< negative: how deep they overlap
  Vec3 normal = zero<Vec3>() /**< unit, from a to b */, point_a = zero<Vec3>() /**< on a */, point_b = zero<Vec3>();  ///< on b
};

namespace inner {

inline constexpr double forever = std::numeric_limits<double>::infinity();

/// Signed distance of two posed shapes, at most one of them a half-space, in the frame of A; `far` beyond
/// `reach`.
inline SignedPair measure(const Shape& a, const Shape& b, const Pose& b_in_a, double reach) {
  Patch patch;
  return distance_of(a, b, b_in_a, reach, pair_scale(a, b), zero<Vec3>(), patch);
}

/// The signed distance of a point from a shape, in its frame: `normal` points from the shape to the point.
inline SignedPair measure_point(const Shape& s, const Vec3& point) {
  const Shape dot = Sphere{0};
  if (s.kind == ShapeKind::half_space) return measure(s, dot, Pose{.position = point}, forever);
  PairCache cache;
  return GjkEpa{}.pair(s, dot, Pose{.position = point}, forever, cache);
}

/// Where the ray enters the shape, in its frame; false when it misses within `reach`. Each plane that
/// separates the point from the shape is where the ray can go without touching it: x ← x + d / (−n · r) r.
/// From inside it is 0. Source: the convex ray cast of [VanDenBergen2003].
inline bool enter(const Shape& s, const Vec3& origin, const Vec3& direction, double reach, double& way,
                  Vec3& normal) {
  way = 0;
  const double scale = s.kind == ShapeKind::half_space ? 1.0 : length_scale(s);
  for (int iteration = 0; iteration < 100; ++iteration) {
    const SignedPair r = measure_point(s, origin + way * direction);
    normal = r.normal;
    if (r.distance <= 1e-10 * (scale + way)) return true;
    const double approach = -dot(normal, direction);
    if (!(approach > 0)) return false;
    way += r.distance / approach;
    if (!(way <= reach)) return false;
  }
  return true;
}

/// The farthest any point of the box is from `point`, m.
inline double farthest(const Aabb& box, const Vec3& point) {
  Vec3 far;
  for (int k = 0; k < 3; ++k)
    far[k] = std::max(std::abs(box.min()[k] - point[k]), std::abs(box.max()[k] - point[k]));
  return norm(far);
}

/// By this share of the farthest point's distance an answer may stand before the box of its body: a ray ends
/// 1e-10 short of the surface, GJK's bounds meet to as much. So what is left out could not have been the
/// answer, in whatever order bodies are asked.
inline constexpr double box_slack = 1e-9;

/// True when the ray meets the box within `reach`; a ray along a side may miss it or not.
inline bool ray_meets(const Aabb& box, const Vec3& origin, const Vec3& direction, double reach) {
  double first = 0, last = reach;
  for (int k = 0; k < 3; ++k) {
    if (direction[k] == 0) {
      if (origin[k] < box.min()[k] || origin[k] > box.max()[k]) return false;
      continue;
    }
    const double x = (box.min()[k] - origin[k]) / direction[k], y = (box.max()[k] - origin[k]) / direction[k];
    first = std::max(first, std::min(x, y));
    last = std::min(last, std::max(x, y));
  }
  return first <= last;
}

/// Meshes are asked elsewhere; the parts of a compound nowhere.
struct PassMeshes {
  void operator()(const auto& set, Index, Index b, const Shape& shape, const Pose&) const {
    if (shape.kind == ShapeKind::compound)
      refuse(set.who(b) + ": a compound is known to its backend alone, and no question sees its parts; leave its group out of the mask");
  }
};
/// What is asked of a body whose shape a backend keeps: nothing can be.
struct RefuseKept {
  void operator()(const auto& set, Index s, Index b, const Shape& shape, const Pose& pose) const {
    PassMeshes{}(set, s, b, shape, pose);
    refuse(set.who(b) + ": a " + name(shape.kind) +
           " is known to its backend alone; name it in the question (" +
           "delassus/collision/mesh_queries.hpp), or leave the group out of the mask");
  }
};

/// f(set, s, b, shape, pose) for body b of set s when it has a shape and its group meets the mask. When a backend keeps the
/// shape, `kept` is called with the same. A body that is not finite has none.
template <class Set, class F, class Kept>
void ask(const Set& set, Index s, Index b, std::uint32_t groups, const Kept& kept, const F& f) {
  if (!set.has_collider(b) || (set.group(b) & groups) == 0) return;
  const Pose pose = set.pose(b);
  if (!is_finite(pose.position) || !is_finite(pose.rotation)) return;
  const Shape shape = set.shape(b);
  shape.is_kept() ? kept(set, s, b, shape, pose) : f(set, s, b, shape, pose);
}

/// What has `visit` as `EveryBody` does.
struct AskedBodies {};

}  // namespace inner

/// All bodies, one by one: what is asked where no `BodyTree` is named.
struct EveryBody : inner::AskedBodies {
  /// f(set, s, b, shape, pose) for the half-spaces, and for the bodies whose tight box passes `meets`.
  template <class World, class Kept, class Meets, class F>
  void visit(const World& world, std::uint32_t groups, const Kept& kept, const Meets& meets,
             const F& f) const {
    world.each([&](const auto& set, auto s) {
      for (Index body = 0; body < set.blocks(); ++body)
        inner::ask(set, Index(s), body, groups, kept,
                   [&](const auto& of, Index, Index b, const Shape& shape, const Pose& pose) {
                     if (shape.kind == ShapeKind::half_space || meets(tight_box(shape, pose)))
                       f(of, Index(s), b, shape, pose);
                   });
    });
  }
};

namespace inner {

template <class Set>
SurfacePoint surface_point(const Set& set, Index s, Index b, const Pose& pose, const Vec3& point,
                           const Vec3& normal, double distance) {
  SurfacePoint found{.is_found = true, .point = point, .normal = normal, .distance = distance};
  found.anchor = anchor(set, set.handle(b), pose.to_local(point));
  found.anchor.set = s;
  return found;
}

/// Of two answers that are equally near, the body that comes first in the world.
inline bool comes_before(Index s, Index b, const Anchor& other) {
  return s != other.set ? s < other.set : b < other.block;
}

}  // namespace inner

/// `ray_cast(world, …)`, asked of these: a `BodyTree`.
template <class World, std::derived_from<inner::AskedBodies> Bodies, class Kept = inner::RefuseKept>
SurfacePoint ray_cast(const World& world, const Bodies& bodies, const Vec3& origin, const Vec3& direction,
                      double reach = inner::forever, std::uint32_t groups = ~0u, const Kept& kept = {}) {
  const Vec3 along = inner::direction_of(direction);
  DELASSUS_EXPECT(is_finite(origin) && is_finite(along) && squared_norm(along) > 0.5,
                  "ray_cast: origin and direction must be finite and the direction not zero");
  inner::expect_at_least_zero("ray_cast: reach", reach, "m");
  SurfacePoint first;
  double nearest = reach;
  const auto meets = [&](const Aabb& box) {
    const Vec3 slack = Vec3::Constant(inner::box_slack * inner::farthest(box, origin));
    return inner::ray_meets(Aabb(box.min() - slack, box.max() + slack), origin, along, nearest);
  };
  bodies.visit(world, groups, kept, meets,
               [&](const auto& set, Index s, Index b, const Shape& shape, const Pose& pose) {
                 double way = 0;
                 Vec3 normal;
                 const Vec3 local = transposed_times(pose.rotation, along);
                 if (!inner::enter(shape, pose.to_local(origin), local, nearest, way, normal)) return;
                 if (first && (way > nearest || (way == nearest && !inner::comes_before(s, b, first.anchor))))
                   return;
                 nearest = way;
                 first = inner::surface_point(set, s, b, pose, origin + way * along, pose.rotation * normal, way);
               });
  return first;
}

/// `closest_point(world, …)`, asked of these.
template <class World, std::derived_from<inner::AskedBodies> Bodies, class Kept = inner::RefuseKept>
SurfacePoint closest_point(const World& world, const Bodies& bodies, const Vec3& point,
                           double reach = inner::forever, std::uint32_t groups = ~0u, const Kept& kept = {}) {
  DELASSUS_EXPECT(is_finite(point), "closest_point: the point is not finite");
  inner::expect_at_least_zero("closest_point: reach", reach, "m");
  SurfacePoint best;
  double limit = reach;
  const auto meets = [&](const Aabb& box) {
    return box.distance(point) <= std::max(limit, 0.0) + inner::box_slack * inner::farthest(box, point);
  };
  bodies.visit(
      world, groups, kept, meets,
      [&](const auto& set, Index s, Index b, const Shape& shape, const Pose& pose) {
        const SignedPair r = inner::measure_point(shape, pose.to_local(point));
        if (!(r.distance <= limit) || (best && r.distance == limit && !inner::comes_before(s, b, best.anchor)))
          return;
        limit = r.distance;
        best = inner::surface_point(set, s, b, pose, pose.to_world(r.point_a), pose.rotation * r.normal, r.distance);
      });
  return best;
}

/// `overlaps(world, …)`, asked of these.
template <class World, std::derived_from<inner::AskedBodies> Bodies, class Kept = inner::RefuseKept>
void overlaps(const World& world, const Bodies& bodies, const Shape& shape, const Pose& pose,
              std::vector<SurfacePoint>& found, double margin = 0, std::uint32_t groups = ~0u,
              const Kept& kept = {}) {
  check(shape, "overlaps");
  DELASSUS_EXPECT(shape.has_volume(),
                  std::string("overlaps: a ") + name(shape.kind) + " has no volume to overlap with");
  DELASSUS_EXPECT(is_finite(pose.position) && is_finite(pose.rotation), "overlaps: the pose is not finite");
  found.clear();
  const Vec3 more = Vec3::Constant(margin);
  const Aabb tight = tight_box(shape, pose), box(tight.min() - more, tight.max() + more);
  bodies.visit(
      world, groups, kept, [&](const Aabb& other) { return other.intersects(box); },
      [&](const auto& set, Index s, Index b, const Shape& other, const Pose& at) {
        const SignedPair r = inner::measure(other, shape, at.to_local(pose), margin);
        if (r.status != PairStatus::near || r.distance > margin) return;
        found.push_back(
            inner::surface_point(set, s, b, at, at.to_world(r.point_a), at.rotation * r.normal, r.distance));
      });
  const auto order = [](const SurfacePoint& p, const SurfacePoint& q) {
    return inner::comes_before(p.anchor.set, p.anchor.block, q.anchor);
  };
  if (!inner::is_sorted(found.data(), found.data() + found.size(), order)) inner::sort(found, order);
}

/// The first body that the ray from `origin` along `direction` (any length) meets within `reach` m. A body
/// that holds the origin is met there, at the distance 0. `groups` masks the bodies that are asked, by their
/// own group.
template <class World, class Kept = inner::RefuseKept>
SurfacePoint ray_cast(const World& world, const Vec3& origin, const Vec3& direction,
                      double reach = inner::forever, std::uint32_t groups = ~0u, const Kept& kept = {}) {
  return ray_cast(world, EveryBody{}, origin, direction, reach, groups, kept);
}

/// The surface point nearest to `point`, of all bodies within `reach` m. Inside a body the distance is
/// negative, and the body in which the point lies deepest is the nearest.
template <class World, class Kept = inner::RefuseKept>
SurfacePoint closest_point(const World& world, const Vec3& point, double reach = inner::forever,
                           std::uint32_t groups = ~0u, const Kept& kept = {}) {
  return closest_point(world, EveryBody{}, point, reach, groups, kept);
}

/// Every body that overlaps `shape` at `pose`, or comes within `margin` m of it: the point of each that lies
/// deepest in the shape, and how far. In the order of the bodies; `found` is cleared first.
template <class World, class Kept = inner::RefuseKept>
void overlaps(const World& world, const Shape& shape, const Pose& pose, std::vector<SurfacePoint>& found,
              double margin = 0, std::uint32_t groups = ~0u, const Kept& kept = {}) {
  overlaps(world, EveryBody{}, shape, pose, found, margin, groups, kept);
}

/// The shortest way between the surfaces of two posed shapes; of two half-spaces there is none.
inline Separation separation(const Shape& a, const Pose& at_a, const Shape& b, const Pose& at_b) {
  const auto is_body = [](const Shape& s) { return s.kind != ShapeKind::none; };
  DELASSUS_EXPECT(is_body(a) && is_body(b), "separation: a body without a shape has no distance");
  DELASSUS_EXPECT(a.has_volume() || b.has_volume(), "separation: two half-spaces have no distance");
  const SignedPair r = inner::measure(a, b, at_a.to_local(at_b), inner::forever);
  return {r.distance, at_a.rotation * r.normal, at_a.to_world(r.point_a), at_a.to_world(r.point_b)};
}

/// The same of two bodies, by their handles: `separation(set, box, set, ball)`.
template <class SetA, class SetB>
Separation separation(const SetA& set_a, typename SetA::Handle a, const SetB& set_b,
                      typename SetB::Handle b) {
  DELASSUS_EXPECT(set_a.contains(a) && set_b.contains(b),
                  "separation: a body was removed; its handle is stale");
  return separation(set_a.shape(a.index), set_a.pose(a.index), set_b.shape(b.index), set_b.pose(b.index));
}

}  // namespace delassus
