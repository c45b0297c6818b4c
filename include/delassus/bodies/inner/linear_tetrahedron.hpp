/// The element of four nodes: one deformation gradient.
#pragma once

#include <delassus/bodies/elasticity/material.hpp>
#include <delassus/geometry/tetrahedral_mesh.hpp>
#include <delassus/math/lanes.hpp>

#include <algorithm>
#include <array>

namespace delassus::inner {

/// A tetrahedron with linear shape functions N_a: gradients ∇N_a at rest (1/m), volume at rest (m³).
///
///   F = Σ_a x_a ∇N_aᵀ,   f_a = −V P ∇N_a,   K_ab = V ∇N_a · ∂P/∂F · ∇N_b.
struct LinearTetrahedron {
  using Mesh = TetrahedralMesh;
  static constexpr int nodes = 4;
  using Corners = std::array<Vec3, nodes>;

  std::array<Vec3, nodes> gradient;
  double volume;

  LinearTetrahedron() = default;
  LinearTetrahedron(const TetrahedralMesh& mesh, Index e, const Lame&) : volume(delassus::volume(mesh, e)) {
    const auto& t = mesh.tetrahedra[e];
    const Vec3& o = mesh.points[t[0]];
    const Mat3 edges =
        columns(Vec3(mesh.points[t[1]] - o), Vec3(mesh.points[t[2]] - o), Vec3(mesh.points[t[3]] - o));
    const Mat3 rows = inverse(edges);
    for (int a = 1; a < 4; ++a) gradient[a] = Vec3(rows(a - 1, 0), rows(a - 1, 1), rows(a - 1, 2));
    gradient[0] = -(gradient[1] + gradient[2] + gradient[3]);
  }

  /// How much of corner k a point is; `local` holds those of 1, 2, 3.
  static double weight(const Vec3& local, int k) {
    return k == 0 ? 1 - local[0] - local[1] - local[2] : local[k - 1];
  }
  /// The volume whose mass node k carries, m³.
  static double share(const TetrahedralMesh& mesh, Index e, int) { return delassus::volume(mesh, e) / 4; }
  /// The weights of a point, and how far inside it is as a share of the element.
  static double locate(const Corners& x, const Vec3& point, Vec3& local) {
    const Vec3 o = x[0];
    const Mat3 edges = columns(Vec3(x[1] - o), Vec3(x[2] - o), Vec3(x[3] - o));
    const Vec3 w = inverse(edges) * (point - o);
    local = w;
    return std::min({1 - w[0] - w[1] - w[2], w[0], w[1], w[2]});
  }

  Mat3 deformation(const Corners& x) const {
    Mat3 F = Mat3::Zero();
    for (int a = 1; a < 4; ++a) {
      const Vec3 edge = x[a] - x[0], &b = gradient[a];
      for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 3; ++i) F(i, k) += edge[i] * b[k];
    }
    return F;
  }

  /// J.
  double energy(const auto& material, const Corners& x) const {
    return volume * material.at(deformation(x)).energy();
  }

  /// K by pairs of corners.
  template <class Point>
  struct Stiffness {
    const Point& point;
    double volume;
    Corners b;
    Mat3 block(int i, int j) const { return volume * point.block(b[i], b[j]); }
  };
  /// The element where its corners are at x: forces (N) on them.
  template <class Point>
  struct State {
    const LinearTetrahedron& element;
    Point point;
    Corners force;
    Stiffness<Point> stiffness() const {
      Stiffness<Point> K{point, element.volume, {}};
      for (int a = 0; a < 4; ++a) K.b[a] = point.pull(element.gradient[a]);
      return K;
    }
  };
  template <ElasticMaterial M>
  auto at(const M& material, const Corners& x) const {
    State<decltype(material.at(Mat3()))> state{*this, material.at(deformation(x)), {}};
    const Mat3 pull = -volume * Mat3(state.point.stress());
    Vec3 rest = Vec3::Zero();
    for (int a = 1; a < 4; ++a) {
      state.force[a] = pull * gradient[a];
      rest += state.force[a];
    }
    state.force[0] = -rest;
    return state;
  }

  /// The same of as many elements as there are lanes; `places`: coordinate k of corner a of element l at
  /// (3 a + k) lane_count + l.
  template <class Points>
  struct LaneState {
    Points point;
    Lanes volume;
    LaneVector b[4], force[4];  ///< b: the gradients, pulled
    LaneMatrix block(int i, int j) const {
      LaneMatrix K = point.block(b[i], b[j]);
      for (LaneVector& column : K.column) column = times(volume, column);
      return K;
    }
  };
  template <class M>
    requires requires(const M& material, const LaneMatrix& F) { material.at(F); }
  static auto lanes_at(const M& material, const LinearTetrahedron* elements, const double* places) {
    double numbers[13 * lane_count];
    for (int l = 0; l < lane_count; ++l) {
      for (int a = 0; a < 4; ++a)
        for (int k = 0; k < 3; ++k) numbers[(3 * a + k) * lane_count + l] = elements[l].gradient[a][k];
      numbers[12 * lane_count + l] = elements[l].volume;
    }
    const auto load = [](const double* from, int a) {
      return LaneVector{{load_lanes(from + 3 * a * lane_count), load_lanes(from + (3 * a + 1) * lane_count),
                         load_lanes(from + (3 * a + 2) * lane_count)}};
    };
    LaneMatrix F{};
    const LaneVector origin = load(places, 0);
    for (int a = 1; a < 4; ++a) {
      const LaneVector x = load(places, a), g = load(numbers, a);
      for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 3; ++i) F(i, k) += (x[i] - origin[i]) * g[k];
    }
    LaneState<decltype(material.at(F))> state{material.at(F), load_lanes(numbers + 12 * lane_count), {}, {}};
    const LaneMatrix P = state.point.first_piola();
    for (int k = 0; k < 3; ++k) state.force[0][k] = all_lanes(0);
    for (int a = 0; a < 4; ++a) {
      const LaneVector g = load(numbers, a);
      state.b[a] = state.point.pull(g);
      if (a == 0) continue;
      for (int i = 0; i < 3; ++i) {
        state.force[a][i] = -state.volume * (P(i, 0) * g[0] + P(i, 1) * g[1] + P(i, 2) * g[2]);
        state.force[0][i] -= state.force[a][i];
      }
    }
    return state;
  }
};

}  // namespace delassus::inner
