/// The bending of a sheet of triangles as a constant quadratic form.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/fem/inner/tie.hpp>
#include <delassus/geometry/inner/surface_topology.hpp>
#include <delassus/geometry/sheet_mesh.hpp>
#include <delassus/geometry/triangle.hpp>
#include <delassus/math/linear.hpp>

#include <array>
#include <utility>

namespace delassus::inner {

/// D = E t³/(12 (1 − ν²)), N·m: the moment per width and curvature of a plate of thickness t.
inline double plate_stiffness(double young, double poisson, double thickness) {
  return young * thickness * thickness * thickness / (12 * (1 - poisson * poisson));
}

/// A triangle at rest with what lies across its edges, laid into its plane: nodes 0, 1, 2 are its own, 3 + k
/// is across the edge from k to k + 1.
struct RestPatch {
  std::array<Index, 6> node;
  std::array<Vec3, 6> place;  ///< m; without a neighbour what it was before
  std::array<Vec3, 3> outward;
  std::array<std::array<double, 6>, 3> jump;  ///< j_k = Σ_a jump[k][a] x_a, 1/m
  std::array<int, 3> edge;                    ///< those that have a neighbour
  int edges = 0;
  double area;

  RestPatch(const SheetMesh& mesh, const SurfaceTopology& topology, Index t) : area(delassus::area(mesh, t)) {
    const auto& own = mesh.triangles[t];
    Triangle T;
    for (int k = 0; k < 3; ++k) {
      node[k] = node[3 + k] = own[k];
      T.point[k] = place[k] = place[3 + k] = mesh.points[own[k]];
    }
    T.normal = triangle_normal(place[0], place[1], place[2]);
    for (int k = 0; k < 3; ++k) {
      outward[k] = T.outward(k);
      jump[k].fill(0);
      const Index other = topology.neighbour(t, k);
      if (other < 0) continue;
      edge[edges++] = k;
      for (const Index v : mesh.triangles[other])
        if (v != own[k] && v != own[(k + 1) % 3]) node[3 + k] = v;
      // h = height of the corner across over the edge, w its share of the way from k to k + 1
      const Vec3 from = place[k], along = place[(k + 1) % 3] - from, to = mesh.points[node[3 + k]] - from;
      const double length2 = along.squaredNorm(),
                   height = 2 * delassus::area(mesh, other) / std::sqrt(length2), w = along.dot(to) / length2;
      place[3 + k] = from + w * along + height * outward[k];
      add_slope(k, 3 + k, height, w);
      const Vec3 apex = place[(k + 2) % 3] - from;
      add_slope(k, (k + 2) % 3, 2 * area / std::sqrt(length2), along.dot(apex) / length2);
    }
  }

 private:
  /// −∂x/∂ν out of the triangle of edge k and an apex: (x_apex − (1 − w) x_k − w x_{k+1})/height.
  void add_slope(int k, int apex, double height, double w) {
    jump[k][apex] += 1 / height;
    jump[k][k] -= (1 - w) / height;
    jump[k][(k + 1) % 3] -= w / height;
  }
};

/// a_i = Σ_b amplitude[i][b] x_b of `bending_ties`. Where the six nodes lie so near to one conic that a jump
/// counts for more than five times what it does in a lattice, l/2A, each edge is taken alone.
inline std::array<std::array<double, 6>, 3> amplitudes(const RestPatch& p) {
  Mat3 L = Mat3::Identity();
  for (int k = 0; k < p.edges; ++k)
    for (int i = 0; i < p.edges; ++i) {
      double sum = 0;
      for (int b = 0; b < 6; ++b) {
        const double X = p.outward[p.edge[i]].dot(p.place[b] - p.place[0]);
        sum += 0.5 * p.jump[p.edge[k]][b] * X * X;
      }
      L(k, i) = sum;
    }
  Mat3 B = inverse(L);
  double lattice[3];
  bool is_sound = is_finite(B);
  for (int k = 0; k < p.edges; ++k) {
    const int from = p.edge[k];
    lattice[k] = (p.place[(from + 1) % 3] - p.place[from]).norm() / (2 * p.area);
    for (int i = 0; i < p.edges; ++i) is_sound = is_sound && std::abs(B(i, k)) < 5 * lattice[k];
  }
  if (!is_sound) {
    B.setZero();
    for (int k = 0; k < p.edges; ++k) B(k, k) = lattice[k];
  }
  std::array<std::array<double, 6>, 3> amplitude{};
  for (int i = 0; i < p.edges; ++i)
    for (int k = 0; k < p.edges; ++k)
      for (int b = 0; b < 6; ++b) amplitude[i][b] += B(i, k) * p.jump[p.edge[k]][b];
  return amplitude;
}

/// The stiffness of the sheet against bending. Where triangles T and T′ meet in edge k, the slope of the
/// surface jumps by
///
///   j_k = −(∂x/∂ν_T + ∂x/∂ν_T′) ∈ ℝ³,   |j_k| = 2 sin(θ/2), θ the angle between them,
///
/// along the normal there. The second derivative of a triangle with neighbours, and its energy, are
///
///   κ = Σ_k a_k ν_k ν_kᵀ,  Σ_i Λ_ki a_i = j_k,   Ψ = ½ D A ((1 − ν) κ:κ + ν tr²κ),
///
/// Λ_ki the jump that the surface ½ (ν_i · X)² has: κ is exact for a constant curvature on every mesh, as the
/// parabola through the six nodes. All of it is linear in x: K is constant, and positive semidefinite for |ν|
/// ≤ 1. An affine map of a flat sheet has j = 0, so that stretch is left to the membrane, and a rigid motion
/// meets no force. Of deformations without stretch |∂²x| is the curvature and Ψ is Kirchhoff's. Rest is flat:
/// a mesh that is curved at rest is as sewn of flat cloth. A border carries no moment; what bends across it
/// has half a cell less. Sources: docs/references.md, [BergouEtAl2006] for the
/// constant form, there of single edges; [OnateZarate2000] for a triangle's curvature by its neighbours;
/// [Liang2025] for the parabola.
inline Array<Tie> bending_ties(const SheetMesh& mesh, double D, double poisson) {
  Array<Tie> ties;
  if (!(D > 0)) return ties;
  const SurfaceTopology topology(mesh.triangles, Index(mesh.points.size()));
  for (Index t = 0; t < Index(mesh.triangles.size()); ++t) {
    const RestPatch patch(mesh, topology, t);
    const auto amplitude = amplitudes(patch);
    for (int i = 0; i < patch.edges; ++i)
      for (int k = 0; k < patch.edges; ++k) {
        const double cosine = patch.outward[patch.edge[i]].dot(patch.outward[patch.edge[k]]);
        const double q = D * patch.area * ((1 - poisson) * cosine * cosine + poisson);
        for (int a = 0; a < 6; ++a)
          for (int b = 0; b < 6; ++b)  // those of b < a come with i and k exchanged
            if (patch.node[a] < patch.node[b])
              ties.push_back({patch.node[a], patch.node[b], -q * amplitude[i][a] * amplitude[k][b]});
      }
  }
  return merged(std::move(ties));
}

}  // namespace delassus::inner
