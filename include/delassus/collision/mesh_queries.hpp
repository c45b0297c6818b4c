/// The questions of queries.hpp where some bodies are meshes: name the backend that keeps them after the
/// world. Compounds are refused here too.
#pragma once

#include <delassus/collision/queries.hpp>
#include <delassus/collision/with_meshes.hpp>
#include <delassus/core/cmath.hpp>

#include <algorithm>
#include <vector>

namespace delassus {
namespace inner {

/// f(set, s, b, surface, pose) for every body of a mesh or a height field whose group meets the mask.
template <class World, class Backend, class F>
void each_surface(const World& world, const WithMeshes<Backend>& meshes, std::uint32_t groups, const F& f) {
  const auto ask_kept = [&](const auto& set, Index s, Index b, const Shape& shape, const Pose& pose) {
    if (shape.kind == ShapeKind::mesh)
      meshes.with_surface(shape, [&](const auto& surface) { f(set, s, b, surface, pose); });
  };
  world.each([&](const auto& set, auto s) {
    for (Index b = 0; b < set.blocks(); ++b)
      ask(set, Index(s), b, groups, ask_kept, [](const auto&...) {});
  });
}

/// Its other side, alone: of its neighbours nothing is known there.
inline Triangle turned_over(const Triangle& t) {
  return {.point = {t.point[0], t.point[2], t.point[1]}, .normal = -t.normal};
}

/// The way along the unit direction d to where the ray enters a triangle from outside, m; infinite when it
/// does not. Source: [MollerTrumbore1997].
inline double way_to(const Triangle& t, const Vec3& origin, const Vec3& d) {
  const Vec3 e1 = t.point[1] - t.point[0], e2 = t.point[2] - t.point[0], p = cross(d, e2);
  const double determinant = dot(e1, p);
  if (!(determinant > 0)) return forever;
  const Vec3 s = origin - t.point[0], q = cross(s, e1);
  const double u = dot(s, p), v = dot(d, q), way = dot(e2, q) / determinant;
  return u >= 0 && v >= 0 && u + v <= determinant && way >= 0 ? way : forever;
}

}  // namespace inner

/// As `ray_cast(world, …)`; a mesh is met where the ray enters it from outside.
template <class World, class Backend>
SurfacePoint ray_cast(const World& world, const WithMeshes<Backend>& meshes, const Vec3& origin,
                      const Vec3& direction, double reach = inner::forever, std::uint32_t groups = ~0u) {
  SurfacePoint first = ray_cast(world, origin, direction, reach, groups, inner::PassMeshes{});
  const Vec3 along = inner::direction_of(direction);
  double nearest = first ? first.distance : reach;
  inner::each_surface(world, meshes, groups,
                      [&](const auto& set, Index s, Index b, const auto& surface, const Pose& pose) {
                        const Vec3 from = pose.to_local(origin), d = transposed_times(pose.rotation, along);
                        const auto meets = [&](const inner::Bounds& box) {
                          return inner::ray_meets(Aabb(box.low, box.high), from, d, nearest);
                        };
                        surface.visit(meets, [&](Index t) {
                          const Triangle triangle = surface.triangle(t);
                          const double way = inner::way_to(triangle, from, d);
                          if (!(way <= nearest) || !(way < inner::forever) || (first && way == nearest))
                            return;
                          nearest = way;
                          first = inner::surface_point(set, s, b, pose, origin + way * along,
                                                       pose.rotation * triangle.normal, way);
                        });
                      });
  return first;
}

/// As `closest_point(world, …)`. Of a mesh the distance is to the nearest triangle and never negative.
template <class World, class Backend>
SurfacePoint closest_point(const World& world, const WithMeshes<Backend>& meshes, const Vec3& point,
                           double reach = inner::forever, std::uint32_t groups = ~0u) {
  SurfacePoint best = closest_point(world, point, reach, groups, inner::PassMeshes{});
  double limit = best ? best.distance : reach;
  inner::each_surface(
      world, meshes, groups, [&](const auto& set, Index s, Index b, const auto& surface, const Pose& pose) {
        const Vec3 local = pose.to_local(point);
        const auto meets = [&](const inner::Bounds& box) { return norm(box.beyond(local)) <= limit; };
        surface.visit(meets, [&](Index t) {
          const Triangle triangle = surface.triangle(t);
          const Vec3 on = inner::nearest_on(triangle, local), apart = local - on;
          const double distance = norm(apart);
          if (!(distance <= limit) || (best && distance == limit)) return;
          limit = distance;
          const Vec3 normal = distance > 0 ? Vec3(apart / distance) : triangle.normal;
          best = inner::surface_point(set, s, b, pose, pose.to_world(on), pose.rotation * normal, distance);
        });
      });
  return best;
}

/// As `overlaps(world, …)`; of a mesh that the shape cuts with its middle behind the triangles, the distance is the way out
/// across the nearest. A shape wholly behind them is not found.
template <class World, class Backend>
void overlaps(const World& world, const WithMeshes<Backend>& meshes, const Shape& shape, const Pose& pose,
              std::vector<SurfacePoint>& found, double margin = 0, std::uint32_t groups = ~0u) {
  overlaps(world, shape, pose, found, margin, groups, inner::PassMeshes{});
  Patch patch;
  inner::each_surface(
      world, meshes, groups, [&](const auto& set, Index s, Index b, const auto& surface, const Pose& at) {
        const Pose relative = at.to_local(pose);
        const inner::Bounds near = inner::bounds_around(shape, relative, margin);
        const auto is_near = [&](const inner::Bounds& box) { return box.meets(near); };
        SurfacePoint deepest;
        surface.visit(is_near, [&](Index t) {
          Vec3 n;
          const PatchTrust trust = triangle_patch(surface.triangle(t), shape, relative, margin, length_scale(shape), patch, n);
          if (trust != PatchTrust::sure) return;
          const PatchPoint& p = patch.point[inner::deepest(patch)];
          if (p.gap <= margin && (!deepest || p.gap < deepest.distance))
            deepest = inner::surface_point(set, s, b, at, at.to_world(p.a), at.rotation * n, p.gap);
        });
        // Who has its middle behind the triangles meets their other sides, and leaves across the nearest plane.
        if (!deepest)
          surface.visit(is_near, [&](Index t) {
            Vec3 n;
            const Triangle front = surface.triangle(t);
            if (triangle_patch(inner::turned_over(front), shape, relative, margin, length_scale(shape), patch, n) != PatchTrust::sure) return;
            const double gap = front.height(relative.to_world(support(shape, Vec3(-transposed_times(relative.rotation, front.normal)))));
            const Vec3& on = patch.point[inner::deepest(patch)].a;
            if (!deepest || gap > deepest.distance) deepest = inner::surface_point(set, s, b, at, at.to_world(on), at.rotation * front.normal, gap);
          });
        if (deepest) found.push_back(deepest);
      });
}

}  // namespace delassus
