/// The element of ten nodes: four deformation gradients.
#pragma once

#include <delassus/fem/inner/find_place.hpp>
#include <delassus/fem/inner/gradient_element.hpp>
#include <delassus/geometry/quadratic_tetrahedral_mesh.hpp>

#include <algorithm>

namespace delassus::inner {

/// A tetrahedron with quadratic shape functions and the rule of four points, which has the whole of K where
/// edges are straight. Where they are bent it misses a little of ∫∇N_a dV, by which a constant stress pulls:
///
///   V_q ← V_q V/Σ_q V_q,   ∇N_a(X_q) ← ∇N_a(X_q) + (∫∇N_a dV − Σ_q V_q ∇N_a(X_q))/V
///
/// puts that back, and leaves F what it is of affine maps. The mass of a node is as the diagonal of ∫N_a N_b
/// dV, scaled to the whole: 1/36 a corner, 4/27 an edge, none negative. Source: docs/references.md,
/// [HintonRockZienkiewicz1976] for the mass.
struct QuadraticTetrahedron : GradientElement<10, 4> {
  using Mesh = QuadraticTetrahedralMesh;

  QuadraticTetrahedron() = default;
  QuadraticTetrahedron(const Mesh& mesh, Index e, const Lame&) {
    const TenPoints x = inner::corners(mesh, e);
    Corners missing;  // ∫∇N_a dV, less what the rule has of it
    for (Vec3& g : missing) g.setZero();
    double volume = 0, of_rule = 0;
    each_exact_point([&](const Vec3& xi, double weight) {
      Corners gradient;
      const double V = weight * gradients_at(x, xi, gradient);
      for (int a = 0; a < nodes; ++a) missing[a] += V * gradient[a];
      volume += V;
    });
    for (int q = 0; q < point_count; ++q) {
      points[q].volume = gradients_at(x, tetrahedron_point(q), points[q].gradient) / 24;
      of_rule += points[q].volume;
    }
    for (auto& [gradient, V] : points) {
      V *= volume / of_rule;
      for (int a = 0; a < nodes; ++a) missing[a] -= V * gradient[a];
    }
    for (auto& [gradient, V] : points) {
      gradient[0].setZero();
      for (int a = 1; a < nodes; ++a) {
        gradient[a] += missing[a] / volume;
        gradient[0] -= gradient[a];
      }
    }
  }

  /// N_k; `local` holds the shares of corners 1, 2, 3.
  static double weight(const Vec3& local, int k) { return quadratic(k, local); }
  /// The volume whose mass node k carries, m³.
  static double share(const Mesh& mesh, Index e, int k) {
    return volume(mesh, e) * (k < 4 ? 1. / 36 : 4. / 27);
  }
  /// The place of a point, and how far inside it is as a share of the element.
  static double locate(const Corners& x, const Vec3& point, Vec3& local) {
    const auto slope = [](const TenPoints& at, const Vec3& xi) { return jacobian(at, xi); };
    Vec3 xi(0.25, 0.25, 0.25);
    if (!find_place(x, point, quadratic, slope, xi)) return -1;
    local = xi;
    return std::min({corner_weight(0, xi), xi[0], xi[1], xi[2]});
  }

 private:
  /// ∇N_a at ξ into `to`; returns det J.
  static double gradients_at(const TenPoints& x, const Vec3& xi, Corners& to) {
    const Mat3 J = jacobian(x, xi), from_world = inverse(J);
    for (int a = 0; a < nodes; ++a) to[a] = from_world.transpose() * quadratic_slope(a, xi);
    return determinant(J);
  }
};

}  // namespace delassus::inner
