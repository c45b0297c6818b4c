/// The element of a sheet: a triangle with one deformation gradient, and what bends between triangles.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/fem/elasticity/material.hpp>
#include <delassus/fem/inner/bending.hpp>
#include <delassus/fem/inner/gradient_element.hpp>
#include <delassus/geometry/sheet_mesh.hpp>

#include <algorithm>

namespace delassus::inner {

/// A triangle with linear shape functions N_a over its own plane at rest, in axes of that plane: F has no
/// third column.
struct SheetTriangle : GradientElement<3, 1> {
  using Mesh = SheetMesh;

  SheetTriangle() = default;
  SheetTriangle(const SheetMesh& mesh, Index e, const Lame&) {
    const auto& t = mesh.triangles[e];
    const Vec3 a = mesh.points[t[1]] - mesh.points[t[0]], b = mesh.points[t[2]] - mesh.points[t[0]];
    const double length = a.norm(), along = a.dot(b) / length, height = a.cross(b).norm() / length;
    auto& [gradient, volume] = points[0];
    gradient[1] = Vec3(1 / length, -along / (length * height), 0);
    gradient[2] = Vec3(0, 1 / height, 0);
    gradient[0] = -(gradient[1] + gradient[2]);
    volume = delassus::volume(mesh, e);
  }

  /// What couples the nodes besides.
  static Array<Tie> ties(const SheetMesh& mesh, const auto& material) {
    return bending_ties(mesh,
                        material.bending * plate_stiffness(material.young, material.poisson, mesh.thickness),
                        material.poisson);
  }

  /// How much of corner k a point is; `local` holds those of 1, 2. What is left for corner 0 of a point on
  /// the edge across from it is rounding.
  static double weight(const Vec3& local, int k) {
    if (k > 0) return local[k - 1];
    const double rest = 1 - local[0] - local[1];
    return std::abs(rest) < 1e-15 ? 0 : rest;
  }
  /// The volume whose mass a node carries, m³.
  static double share(const SheetMesh& mesh, Index e, int) { return delassus::volume(mesh, e) / 3; }
  /// The shares of the point below x, and how far inside it is as a share of the element; negative by as much
  /// as x is out of the plane.
  static double locate(const Corners& x, const Vec3& point, Vec3& local) {
    const Vec3 a = x[1] - x[0], b = x[2] - x[0], p = point - x[0], n = a.cross(b);
    const double size2 = n.squaredNorm();
    if (!(size2 > 0)) return -1;
    local = Vec3(n.dot(p.cross(b)), n.dot(a.cross(p)), 0) / size2;
    const double apart = std::abs(n.dot(p)) / std::pow(size2, 0.75);  // over √(2 area)
    return std::min({1 - local[0] - local[1], local[0], local[1], -apart});
  }
};

}  // namespace delassus::inner
