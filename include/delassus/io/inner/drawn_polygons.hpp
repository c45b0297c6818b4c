/// Recorded bodies as polygons, for formats that have no round solids.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/index.hpp>
#include <delassus/io/recording.hpp>

#include <numbers>
#include <vector>

namespace delassus::inner {

/// Points in the frame of the body, m, and faces, counter-clockwise from outside.
struct Polygons {
  std::vector<Vec3> points;
  std::vector<std::vector<Index>> faces;

  Index add(const Vec3& p) {
    points.push_back(p);
    return Index(points.size()) - 1;
  }
};

/// Rings of `sides` points about z from below up, (radius, height) each; a ring of radius 0 is one point. Rings that meet at an edge are
/// given once: normals are those of the faces.
inline Polygons turned_solid(const std::vector<std::array<double, 2>>& rings, int sides = 24) {
  Polygons out;
  std::vector<std::vector<Index>> at;
  for (const auto& [r, z] : rings) {
    at.emplace_back();
    for (int k = 0; k < (r > 0 ? sides : 1); ++k) {
      const double a = 2 * std::numbers::pi * k / sides;
      at.back().push_back(out.add({r * std::cos(a), r * std::sin(a), z}));
    }
  }
  const auto of = [&](std::size_t ring, int k) { return at[ring].size() == 1 ? at[ring][0] : at[ring][std::size_t(k % sides)]; };
  for (std::size_t i = 0; i + 1 < at.size(); ++i)
    for (int k = 0; k < sides; ++k) {
      std::vector<Index> face{of(i, k), of(i, k + 1), of(i + 1, k + 1), of(i + 1, k)};
      if (at[i].size() == 1) face.erase(face.begin());
      else if (at[i + 1].size() == 1) face.pop_back();
      if (face.size() > 2) out.faces.push_back(std::move(face));
    }
  if (at.front().size() > 1) out.faces.emplace_back(at.front().rbegin(), at.front().rend());
  if (at.back().size() > 1) out.faces.push_back(at.back());
  return out;
}

/// Half a circle from pole to pole, its halves `height` apart.
inline std::vector<std::array<double, 2>> arc(double radius, double height, int rings = 12) {
  std::vector<std::array<double, 2>> out;
  for (int i = 0; i <= rings; ++i) {
    const double a = std::numbers::pi * i / rings;
    const double r = i == 0 || i == rings ? 0 : radius * std::sin(a), z = -radius * std::cos(a);
    if (height > 0 && 2 * i == rings) out.push_back({r, z - height / 2});
    out.push_back({r, z + (2 * i < rings ? -height / 2 : height / 2)});
  }
  return out;
}

inline Polygons box_polygons(double x, double y, double z) {
  Polygons out;
  for (int k = 0; k < 8; ++k) out.add({k & 1 ? x : -x, k & 2 ? y : -y, k & 4 ? z : -z});
  out.faces = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  return out;
}

/// A square of the plane, `reach` to each side of the foot of `middle`.
inline Polygons plane_polygons(const Vec3& normal, double offset, const Vec3& middle, double reach) {
  Polygons out;
  const Vec3 across = std::abs(normal[2]) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0);
  const Vec3 raw = cross(across, normal);
  const Vec3 u = raw / norm(raw), v = cross(normal, u);
  const Vec3 foot = middle + (offset - dot(normal, middle)) * normal;
  for (const auto& [a, b] : {std::array{-1., -1.}, std::array{1., -1.}, std::array{1., 1.}, std::array{-1., 1.}}) out.add(foot + reach * (a * u + b * v));
  out.faces = {{0, 1, 2, 3}};
  return out;
}

/// A half-space shows its plane, `reach` to each side of the foot of `middle`, which is in the frame of the body.
inline Polygons polygons_of(const RecordedBody& body, const Vec3& middle, double reach) {
  const auto& s = body.shape.size;
  switch (body.shape.kind) {
    case ShapeKind::sphere: return turned_solid(arc(s[0], 0));
    case ShapeKind::box: return box_polygons(s[0], s[1], s[2]);
    case ShapeKind::capsule: return turned_solid(arc(s[0], 2 * s[1]));
    case ShapeKind::cylinder: return turned_solid({{s[0], -s[1]}, {s[0], s[1]}});
    case ShapeKind::cone: return turned_solid({{s[0], -s[1] / 2}, {0, 1.5 * s[1]}});
    case ShapeKind::ellipsoid: {
      Polygons out = turned_solid(arc(1, 0));
      for (Vec3& p : out.points)
        for (int k = 0; k < 3; ++k) p[k] *= s[k];
      return out;
    }
    case ShapeKind::half_space: return plane_polygons(Vec3(s[0], s[1], s[2]), s[3], middle, reach);
    case ShapeKind::convex_hull: return {body.vertices, body.faces};
    default: return {};
  }
}

}  // namespace delassus::inner
