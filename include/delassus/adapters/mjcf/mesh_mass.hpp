/// Mass and moments of a mesh per density, in the ways that MJCF knows.
#pragma once

#include <delassus/adapters/mjcf/principal.hpp>
#include <delassus/geometry/convex_hull.hpp>
#include <delassus/geometry/inertia.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace delassus::inner::mjcf {

/// Of its hull; of pyramids over the faces, all taken as positive; of what the faces enclose; of the faces as
/// thin sheets.
enum class MeshInertia { convex, legacy, exact, shell };

using Triangles = std::vector<std::array<Index, 3>>;

/// What the sum over tetrahedra from a point to the faces, or over the faces alone, comes to.
struct MeshSum {
  double size = 0;  ///< m³, or m²
  Vec3 moment = zero<Vec3>();
  Mat3 square = zero<Mat3>();  ///< ∫ x xᵀ from the apex
};

inline MeshSum sum_over_faces(std::span<const Vec3> vertices, const Triangles& triangles, const Vec3& apex,
                              MeshInertia way) {
  MeshSum sum;
  for (const auto& t : triangles) {
    const Vec3 a = vertices[std::size_t(t[0])] - apex, b = vertices[std::size_t(t[1])] - apex,
               c = vertices[std::size_t(t[2])] - apex;
    const Vec3 s = a + b + c;
    double size =
        way == MeshInertia::shell ? norm(cross(Vec3(b - a), Vec3(c - a))) / 2 : dot(a, cross(b, c)) / 6;
    if (way == MeshInertia::legacy) size = std::abs(size);
    sum.size += size;
    // MuJoCo's centre of a sheet is that of the pyramid over it as well.
    sum.moment += (size / 4) * s;
    const double part = size / (way == MeshInertia::shell ? 12 : 20);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        sum.square(i, j) += part * (a[i] * a[j] + b[i] * b[j] + c[i] * c[j] + s[i] * s[j]);
  }
  return sum;
}

/// The middle of the faces by their areas.
inline Vec3 middle_of_faces(std::span<const Vec3> vertices, const Triangles& triangles) {
  double all = 0;
  Vec3 middle = zero<Vec3>();
  for (const auto& t : triangles) {
    const Vec3 &a = vertices[std::size_t(t[0])], &b = vertices[std::size_t(t[1])],
               &c = vertices[std::size_t(t[2])];
    const double area = norm(cross(Vec3(b - a), Vec3(c - a))) / 2;
    all += area;
    middle += (area / 3) * (a + b + c);
  }
  return all > 0 ? Vec3(middle / all) : middle;
}

/// Per density 1 kg/m³, or 1 kg/m² of a shell. The centre is found from the middle of the faces, and the
/// moments from the centre: of a mesh that is not closed, or not convex with `legacy`, the point matters.
inline MassProperties mesh_solid(std::span<const Vec3> vertices, const Triangles& triangles,
                                 MeshInertia way) {
  if (way == MeshInertia::convex) return unit_solid(ConvexHull(vertices));
  const Vec3 middle = middle_of_faces(vertices, triangles);
  const MeshSum first = sum_over_faces(vertices, triangles, middle, way);
  if (!(first.size > 1e-15)) return {};
  const Vec3 centre = middle + first.moment / first.size;
  const MeshSum sum = sum_over_faces(vertices, triangles, centre, way);
  MassProperties p{.mass = sum.size, .centre = centre};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) p.inertia(i, j) = (i == j ? trace(sum.square) : 0) - sum.square(i, j);
  return p;
}

/// The faces of the hull as triangles over its own vertices.
inline Triangles hull_triangles(const ConvexHull& hull) {
  Triangles triangles;
  for (Index f = 0; f < hull.face_count(); ++f) {
    const auto face = hull.face(f);
    for (std::size_t k = 2; k < face.size(); ++k) triangles.push_back({face[0], face[k - 1], face[k]});
  }
  return triangles;
}

}  // namespace delassus::inner::mjcf
