/// Elements that are nothing but deformation gradients at a few points.
#pragma once

#include <delassus/fem/elasticity/material.hpp>

#include <array>
#include <cstddef>
#include <utility>

namespace delassus::inner {

/// F = Σ_a x_a g_aᵀ for gradients g_a that sum to nothing.
template <std::size_t nodes>
Mat3 deformation(const std::array<Vec3, nodes>& x, const std::array<Vec3, nodes>& gradient) {
  Mat3 F = Mat3::Zero();
  for (std::size_t a = 1; a < nodes; ++a) {
    const Vec3 edge = x[a] - x[0], &b = gradient[a];
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < 3; ++i) F(i, k) += edge[i] * b[k];
  }
  return F;
}

/// An element of shape functions N_a and the points X_q of a rule with weights V_q (m³):
///
///   F_q = Σ_a x_a ∇N_a(X_q)ᵀ,   f_a = −Σ_q V_q P_q ∇N_a,   K_ab = Σ_q V_q ∇N_a · ∂P_q/∂F · ∇N_b.
///
/// Who derives from it fills in the points; the gradients of each sum to nothing.
template <int nodes_, int points_>
struct GradientElement {
  static constexpr int nodes = nodes_, point_count = points_;
  using Corners = std::array<Vec3, nodes>;

  struct RulePoint {
    Corners gradient;  ///< ∇N_a at rest, 1/m
    double volume;     ///< V_q

    Mat3 deformation(const Corners& x) const { return inner::deformation(x, gradient); }
  };
  std::array<RulePoint, point_count> points;

  /// J.
  double energy(const auto& material, const Corners& x) const {
    double sum = 0;
    for (const RulePoint& p : points) sum += p.volume * material.at(p.deformation(x)).energy();
    return sum;
  }

  /// K by pairs of corners.
  template <class Point>
  struct Stiffness {
    const GradientElement& element;
    const std::array<Point, point_count>& at;
    std::array<Corners, point_count> pulled;
    Mat3 block(int i, int j) const {
      Mat3 K = element.points[0].volume * at[0].block(pulled[0][i], pulled[0][j]);
      for (int q = 1; q < point_count; ++q)
        K += element.points[q].volume * at[q].block(pulled[q][i], pulled[q][j]);
      return K;
    }
  };
  /// The element where its corners are at x: forces (N) on them.
  template <class Point>
  struct State {
    const GradientElement& element;
    std::array<Point, point_count> at;
    Corners force;
    Stiffness<Point> stiffness() const {
      Stiffness<Point> K{element, at, {}};
      for (int q = 0; q < point_count; ++q)
        for (int a = 0; a < nodes; ++a) K.pulled[q][a] = at[q].pull(element.points[q].gradient[a]);
      return K;
    }
  };
  template <ElasticMaterial M>
  auto at(const M& material, const Corners& x) const {
    using Point = decltype(material.at(Mat3()));
    auto state = [&]<std::size_t... q>(std::index_sequence<q...>) {
      return State<Point>{*this, {material.at(points[q].deformation(x))...}, {}};
    }
    (std::make_index_sequence<point_count>{});
    for (Vec3& f : state.force) f.setZero();
    for (int q = 0; q < point_count; ++q) {
      const Mat3 pull = -points[q].volume * Mat3(state.at[q].stress());
      Vec3 rest = Vec3::Zero();
      for (int a = 1; a < nodes; ++a) {
        const Vec3 f = pull * points[q].gradient[a];
        state.force[a] += f;
        rest += f;
      }
      state.force[0] -= rest;
    }
    return state;
  }
};

}  // namespace delassus::inner
