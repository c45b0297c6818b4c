/// Coplanar triangles of a hull become one polygon, and the points that no edge needs are dropped.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/geometry/inner/quickhull.hpp>

namespace delassus::inner {

struct HullFaces {
  Array<Vec3> vertices{}, normals{};
  Array<Index> start{0}, loop{};
};

/// Grows a region from the largest triangle left, over neighbours whose corners lie within `tolerance` of its
/// plane. Returns the region of each triangle.
Array<Index> coplanar_regions(const auto& points, const OwningArray<HullTriangle>& triangles, double tolerance,
                              Index& count) {
  struct Edge {
    Index u, v, triangle;
    bool operator<(const Edge& o) const { return std::pair(u, v) < std::pair(o.u, o.v); }
  };
  Array<Edge> edges;
  for (Index t = 0; t < Index(triangles.size()); ++t)
    for (int k = 0; k < 3; ++k) edges.push_back({triangles[t].v[k], triangles[t].v[(k + 1) % 3], t});
  inner::sort(edges);

  Array<Index> seeds(triangles.size()), region(triangles.size(), -1), front;
  for (std::size_t i = 0; i < seeds.size(); ++i) seeds[i] = Index(i);
  inner::sort(seeds, [&](Index s, Index t) {
    return triangles[s].area != triangles[t].area ? triangles[s].area > triangles[t].area : s < t;
  });
  count = 0;
  for (const Index seed : seeds) {
    if (region[seed] >= 0) continue;
    const HullTriangle& plane = triangles[seed];
    region[seed] = count;
    front.assign(1, seed);
    while (!front.empty()) {
      const HullTriangle& t = triangles[front.back()];
      front.pop_back();
      for (int k = 0; k < 3; ++k) {
        const auto twin = inner::lower_bound(edges.data(), edges.data() + edges.size(), Edge{t.v[(k + 1) % 3], t.v[k], 0});
        if (twin == edges.end() || twin->u != t.v[(k + 1) % 3] || twin->v != t.v[k]) continue;
        if (region[twin->triangle] >= 0) continue;
        bool is_coplanar = true;
        for (const Index v : triangles[twin->triangle].v)
          is_coplanar = is_coplanar && std::abs(dot(plane.normal, points[v]) - plane.offset) <= tolerance;
        if (!is_coplanar) continue;
        region[twin->triangle] = count;
        front.push_back(twin->triangle);
      }
    }
    ++count;
  }
  return region;
}

/// Appends one face: its corners sorted by their angle around their mean, seen against the normal.
void append_face(const auto& points, Array<Index>& corners, const Vec3& normal, std::span<const Index> new_index,
                 HullFaces& faces) {
  Vec3 centre = zero<Vec3>();
  for (const Index v : corners) centre += points[v] / double(corners.size());
  const Vec3 x = normalized(points[corners[0]] - centre), y = cross(normal, x);
  const auto angle = [&](Index v) {
    return std::atan2(dot(y, points[v] - centre), dot(x, points[v] - centre));
  };
  inner::sort(corners, [&](Index u, Index v) { return angle(u) < angle(v); });
  Vec3 newell = zero<Vec3>();
  for (std::size_t i = 0; i < corners.size(); ++i)
    newell += cross(points[corners[i]] - centre, points[corners[(i + 1) % corners.size()]] - centre);
  for (const Index v : corners) faces.loop.push_back(new_index[v]);
  faces.start.push_back(Index(faces.loop.size()));
  faces.normals.push_back(normalized(newell));
}

/// Polygons from triangles. A vertex stays when at least three faces meet in it.
HullFaces merge_coplanar(const auto& points, const OwningArray<HullTriangle>& triangles, double tolerance) {
  Index count = 0;
  const Array<Index> region = coplanar_regions(points, triangles, tolerance, count);
  OwningArray<Array<Index>> corners(count);
  Array<Vec3> normals(count, zero<Vec3>());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    corners[region[t]].append(triangles[t].v.begin(), triangles[t].v.end());
    normals[region[t]] += triangles[t].area * triangles[t].normal;
  }
  Array<Index> meets(points.size(), 0), new_index(points.size(), -1);
  for (Array<Index>& face : corners) {
    inner::sort(face);
    inner::drop_repeats(face);
    for (const Index v : face) ++meets[v];
  }
  HullFaces faces;
  for (Index v = 0; v < Index(points.size()); ++v) {
    if (meets[v] < 3) continue;
    new_index[v] = Index(faces.vertices.size());
    faces.vertices.push_back(points[v]);
  }
  for (Index f = 0; f < count; ++f) {
    erase_if(corners[f], [&](Index v) { return meets[v] < 3; });
    if (corners[f].size() >= 3) append_face(points, corners[f], normalized(normals[f]), new_index, faces);
  }
  return faces;
}

}  // namespace delassus::inner
