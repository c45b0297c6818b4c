/// The element of four nodes: one deformation gradient.
#pragma once

#include <delassus/fem/elasticity/material.hpp>
#include <delassus/fem/inner/gradient_element.hpp>
#include <delassus/geometry/tetrahedral_mesh.hpp>
#include <delassus/math/lanes.hpp>

#include <algorithm>
#include <array>
#include <cstring>

namespace delassus::inner {

/// A tetrahedron with linear shape functions: their gradients are the same everywhere, so that one point is
/// the whole rule.
struct LinearTetrahedron : GradientElement<4, 1> {
  using Mesh = TetrahedralMesh;

  LinearTetrahedron() = default;
  LinearTetrahedron(const TetrahedralMesh& mesh, Index e, const Lame&) {
    const auto& t = mesh.tetrahedra[e];
    const Vec3& o = mesh.points[t[0]];
    const Mat3 edges =
        columns(Vec3(mesh.points[t[1]] - o), Vec3(mesh.points[t[2]] - o), Vec3(mesh.points[t[3]] - o));
    const Mat3 rows = inverse(edges);
    auto& [gradient, volume] = points[0];
    for (int a = 1; a < 4; ++a) gradient[a] = Vec3(rows(a - 1, 0), rows(a - 1, 1), rows(a - 1, 2));
    gradient[0] = -(gradient[1] + gradient[2] + gradient[3]);
    volume = delassus::volume(mesh, e);
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

  /// What the lanes are made of: gradients and volumes of as many elements as there are lanes.
  static constexpr int lane_numbers = 13;
  /// Number k of the corners named in `corner` at to[k lane_count].
  void enter_lane(const std::array<int, nodes>& corner, double* to) const {
    for (int a = 0; a < 4; ++a)
      for (int k = 0; k < 3; ++k) to[(3 * a + k) * lane_count] = points[0].gradient[corner[a]][k];
    to[12 * lane_count] = points[0].volume;
  }
  /// The elements of all lanes, where their corners are: forces (N) and K.
  template <class Points>
  struct LaneState {
    Points point;
    LaneVector gradient[4], force[4];

    struct Stiffness {
      const Points& point;
      typename Points::Pulled b[4];
      LaneMatrix block(int i, int j) const { return point.block(b[i], b[j]); }
    };
    Stiffness stiffness() const {
      return {point,
              {point.pull(gradient[0]), point.pull(gradient[1]), point.pull(gradient[2]),
               point.pull(gradient[3])}};
    }
  };
  /// `numbers`: what `enter_lane` wrote; `places`: coordinate k of corner a at (3 a + k) lane_count.
  template <class M>
  requires requires(const M& material, const LaneMatrix& F) { material.at(F); }
  static auto lanes_at(const M& material, const double* numbers, const double* places) {
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
    LaneState<decltype(material.at(F))> state{material.at(F), {}, {}};
    state.point.integrate(load_lanes(numbers + 12 * lane_count));
    const LaneMatrix& P = state.point.stress;
    state.gradient[0] = load(numbers, 0);
    for (int k = 0; k < 3; ++k) state.force[0][k] = all_lanes(0);
    for (int a = 1; a < 4; ++a) {
      const LaneVector& g = state.gradient[a] = load(numbers, a);
      for (int i = 0; i < 3; ++i) {
        state.force[a][i] = -(P(i, 0) * g[0] + P(i, 1) * g[1] + P(i, 2) * g[2]);
        state.force[0][i] -= state.force[a][i];
      }
    }
    return state;
  }
};

}  // namespace delassus::inner
