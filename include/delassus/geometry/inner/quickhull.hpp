/// Quickhull: the triangles of a point cloud's convex hull, the farthest outside point first.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/owning_array.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/math/linear.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <utility>

namespace delassus::inner {

/// Counter-clockwise from outside; the plane is normal · x = offset. `outside` are the points it still has to
/// cover.
struct HullTriangle {
  std::array<Index, 3> v{};
  Vec3 normal = zero<Vec3>();
  double offset = 0, area = 0;
  Array<Index> outside{};
  Index farthest = -1;
  double farthest_distance = 0;
};

HullTriangle hull_triangle(const auto& points, Index a, Index b, Index c) {
  HullTriangle t{.v = {a, b, c}};
  t.normal = cross(points[b] - points[a], points[c] - points[a]);
  t.area = 0.5 * norm(t.normal);
  if (t.area > 0) t.normal /= 2 * t.area;
  t.offset = dot(t.normal, points[a] + points[b] + points[c]) / 3;
  return t;
}

/// Gives point `p` to the triangle from `first` on that sees it from farthest away, or to none when it lies inside all.
void hand_out(const auto& points, Index p, double tolerance, OwningArray<HullTriangle>& triangles, std::size_t first) {
  HullTriangle* best = nullptr;
  double best_distance = tolerance;
  for (std::size_t i = first; i < triangles.size(); ++i) {
    const double distance = dot(triangles[i].normal, points[p]) - triangles[i].offset;
    if (distance > best_distance) best_distance = distance, best = &triangles[i];
  }
  if (!best) return;
  best->outside.push_back(p);
  if (best_distance > best->farthest_distance) best->farthest = p, best->farthest_distance = best_distance;
}

/// Four points that span the cloud well, in positive orientation. False when the cloud is thinner than
/// `thin`.
bool first_tetrahedron(const auto& points, double thin, std::array<Index, 4>& corner) {
  const auto farthest = [&](const auto& measure) {
    Index best = 0;
    for (Index i = 1; i < Index(points.size()); ++i)
      if (measure(points[i]) > measure(points[best])) best = i;
    return best;
  };
  const Index a = farthest([](const Vec3& p) { return -p[0]; });
  const Index b = farthest([&](const Vec3& p) { return squared_norm(p - points[a]); });
  const Vec3 along = normalized(points[b] - points[a]);
  const Index c = farthest([&](const Vec3& p) { return squared_norm(cross(p - points[a], along)); });
  if (norm(cross(points[c] - points[a], along)) <= thin) return false;
  const Vec3 across = normalized(cross(along, points[c] - points[a]));
  const Index d = farthest([&](const Vec3& p) { return std::abs(dot(p - points[a], across)); });
  const double height = dot(points[d] - points[a], across);
  corner = height < 0 ? std::array<Index, 4>{a, b, c, d} : std::array<Index, 4>{a, c, b, d};
  return std::abs(height) > thin;
}

/// Replaces the triangles that see `p` by a fan from `p` to their horizon.
void add_hull_point(const auto& points, Index p, double tolerance, OwningArray<HullTriangle>& triangles) {
  Array<std::pair<Index, Index>> edges;
  Array<Index> orphans;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    HullTriangle& t = triangles[i];
    if (dot(t.normal, points[p]) - t.offset <= tolerance) {
      if (kept != i) triangles[kept] = static_cast<HullTriangle&&>(t);
      ++kept;
      continue;
    }
    for (int k = 0; k < 3; ++k) edges.emplace_back(t.v[k], t.v[(k + 1) % 3]);
    orphans.append(t.outside.begin(), t.outside.end());
  }
  triangles.resize(kept);
  inner::sort(edges);
  inner::sort(orphans);
  for (const auto& [u, v] : edges)
    if (!inner::is_listed(edges, std::pair(v, u)))
      triangles.push_back(hull_triangle(points, u, v, p));
  for (const Index q : orphans)
    if (q != p) hand_out(points, q, tolerance, triangles, kept);
}

/// The hull of `points` as triangles. False when the cloud is thinner than 1e-6 of its `extent`.
/// A point counts as outside a plane from 1e-12 of the extent on. Source of the method:
/// [BarberDobkinHuhdanpaa1996].
bool quickhull(const auto& points, double extent, OwningArray<HullTriangle>& triangles) {
  std::array<Index, 4> c{};
  if (!first_tetrahedron(points, 1e-6 * extent, c)) return false;
  const double tolerance = 1e-12 * extent;
  triangles.clear();
  triangles.push_back(hull_triangle(points, c[0], c[1], c[2]));
  triangles.push_back(hull_triangle(points, c[0], c[3], c[1]));
  triangles.push_back(hull_triangle(points, c[1], c[3], c[2]));
  triangles.push_back(hull_triangle(points, c[2], c[3], c[0]));
  for (Index p = 0; p < Index(points.size()); ++p)
    if (p != c[0] && p != c[1] && p != c[2] && p != c[3]) hand_out(points, p, tolerance, triangles, 0);
  for (;;) {
    const HullTriangle* far = &triangles[0];
    for (const HullTriangle& t : triangles)
      if (t.farthest_distance > far->farthest_distance) far = &t;
    if (far->farthest < 0) return true;
    add_hull_point(points, far->farthest, tolerance, triangles);
  }
}

}  // namespace delassus::inner
