/// What the triangles of a mesh's surface enclose.
#pragma once

#include <delassus/math/linear.hpp>

/// By the divergence theorem: Σ a·x/3 of outward areas is the volume, and Σ a nothing; a torn or mirrored
/// mesh has inner faces in its surface.
struct Enclosed {
  double volume = 0;
  delassus::Vec3 area = delassus::Vec3::Zero();
};
template <class Mesh>
Enclosed enclosed_by_surface(const Mesh& mesh) {
  Enclosed sum;
  for (const auto& [a, b, c] : surface(mesh)) {
    const delassus::Vec3 area = (mesh.points[b] - mesh.points[a]).cross(mesh.points[c] - mesh.points[a]) / 2;
    sum.volume += area.dot(mesh.points[a]) / 3;
    sum.area += area;
  }
  return sum;
}
