/// The element of eight nodes that bends without locking: a mean deformation, and modes about it.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/fem/elasticity/material.hpp>
#include <delassus/fem/inner/find_place.hpp>
#include <delassus/fem/inner/gradient_element.hpp>
#include <delassus/fem/inner/hexahedron_modes.hpp>
#include <delassus/math/singular_values.hpp>

#include <algorithm>
#include <array>

namespace delassus::inner {

/// A hexahedron of trilinear shape functions N_a with three incompatible modes 1 − ξ_i², held by the mean
/// gradients g_a = ∫∇N_a/V. The nodes' places are an affine map and four vectors q_k, the parts of the shapes
/// above:
///
///   Ψ_e = V Ψ(F) + ½ Σ_kl (Rᵀq_k) · S_kl (Rᵀq_l),   F = Σ_a x_a g_aᵀ,  q_k = Σ_a γ_ka x_a,
///
/// R the rotation next to F (1 for a material without rotations). γ vanishes on affine maps, which the first
/// term has whole. S is that of Hooke's law at rest, the modes' own coordinates eliminated. With S the
/// element is for small strains that of Wilson and Taylor, but for the dilatation: its part that is not
/// linear in ξ, which a solid that keeps its volume cannot have, presses on nothing. So no ν < ½ makes it
/// lock. Sources: [TaylorBeresfordWilson1976] for the modes, [FlanaganBelytschko1981] for g and γ,
/// [BelytschkoBindeman1993] for S in the turning axes.
class IncompatibleHexahedron {
 public:
  using Mesh = HexahedralMesh;
  static constexpr int nodes = 8;
  using Corners = EightPoints;

  IncompatibleHexahedron() = default;
  IncompatibleHexahedron(const HexahedralMesh& mesh, Index e, const Lame& lame)
      : shape_(corners(mesh, e), lame) {}

  /// N_k; `local` is ξ.
  static double weight(const Vec3& local, int k) { return trilinear(k, local); }
  static double share(const HexahedralMesh& mesh, Index e, int k) { return corner_share(mesh, e, k); }
  /// ξ of a point by Newton's method, and how far inside it is as a share of the element.
  static double locate(const Corners& x, const Vec3& point, Vec3& local) {
    const auto slope = [](const EightPoints& at, const Vec3& xi) { return jacobian(at, xi); };
    Vec3 xi = Vec3::Zero();
    if (!find_place(x, point, trilinear, slope, xi)) return -1;
    local = xi;
    return std::min({1 - std::abs(xi[0]), 1 - std::abs(xi[1]), 1 - std::abs(xi[2])}) / 2;
  }

  Mat3 deformation(const Corners& x) const { return inner::deformation(x, shape_.gradient); }

  /// J.
  template <ElasticMaterial M>
  double energy(const M& material, const Corners& x) const {
    const Mat3 F = deformation(x);
    const Turning turning = turn<M>(F, x);
    double sum = 0;
    for (int k = 0; k < 4; ++k) sum += turning.q[k].dot(turning.s[k]);
    return shape_.volume * material.at(F).energy() + 0.5 * sum;
  }

  template <class Point>
  struct State;
  template <ElasticMaterial M>
  auto at(const M& material, const Corners& x) const {
    const Mat3 F = deformation(x);
    State<decltype(material.at(F))> state{*this, material.at(F), turn<M>(F, x), {}};
    add_forces(state.point.stress(), state.turning, state.force);
    return state;
  }

 private:
  static constexpr int modes = HexahedronModes::modes;

  /// What the modes are in the axes of R: q_k and s_k = Σ_l S_kl q_l (N). With the turn of R,
  ///
  ///   RᵀdR = [ω]×,   (tr Y − Y) ω = Σ_a g_a × Rᵀdx_a,   Y = RᵀF,
  ///
  /// `softened` is the inverse of tr Y − Y, its eigenvalues no greater than 1000 where F is nearly so flat
  /// that R is not defined.
  struct Turning {
    Mat3 R, softened;
    std::array<Vec3, 4> q, s;
  };

  template <ElasticMaterial M>
  Turning turn(const Mat3& F, const Corners& x) const {
    Turning t{Mat3::Identity(), Mat3::Zero(), {}, {}};
    if constexpr (!requires { requires M::has_constant_stiffness; }) {
      const SingularValues f = singular_values(F);
      t.R = f.U * f.V.transpose();
      Mat3 scaled = f.V;
      for (int k = 0; k < 3; ++k) {
        const double sum = f.sigma[(k + 1) % 3] + f.sigma[(k + 2) % 3];
        for (int i = 0; i < 3; ++i) scaled(i, k) /= std::max(sum, 1e-3);
      }
      t.softened = scaled * f.V.transpose();
    }
    for (int k = 0; k < 4; ++k) {
      Vec3 q = Vec3::Zero();
      for (int a = 1; a < nodes; ++a) q += shape_.gamma[k][a] * (x[a] - x[0]);
      t.q[k] = t.R.transpose() * q;
    }
    for (int k = 0; k < 4; ++k)
      for (int i = 0; i < 3; ++i) {
        double sum = 0;
        for (int l = 0; l < modes; ++l) sum += shape_.S[3 * k + i][l] * t.q[l / 3][l % 3];
        t.s[k][i] = sum;
      }
    return t;
  }

  /// f_a = −(V P + R [τ]×) g_a − R Σ_k γ_ka s_k,  (tr Y − Y) τ = Σ_k s_k × q_k: the moment that turning R
  /// meets.
  void add_forces(const Mat3& stress, const Turning& t, Corners& force) const {
    Vec3 moment = Vec3::Zero();
    for (int k = 0; k < 4; ++k) moment += t.s[k].cross(t.q[k]);
    const Mat3 pull = shape_.volume * stress + t.R * skew(Vec3(t.softened * moment));
    Vec3 rest = Vec3::Zero();
    for (int a = 1; a < nodes; ++a) {
      Vec3 s = Vec3::Zero();
      for (int k = 0; k < 4; ++k) s += shape_.gamma[k][a] * t.s[k];
      force[a] = -(pull * shape_.gradient[a] + t.R * s);
      rest += force[a];
    }
    force[0] = -rest;
  }

  /// K of the modes, 24 × 24: Dᵀ S D,  dq_k = Σ_a D_ka dx_a,  D_ka = (γ_ka 1 + [q_k]× (tr Y − Y)⁻¹ [g_a]×)
  /// Rᵀ. A body that turns as a whole does not meet it. What s d²q adds is left out: of the order of s.
  void make_mode_stiffness(const Turning& t, double (&K)[3 * nodes][3 * nodes]) const {
    double D[modes][3 * nodes], SD[modes][3 * nodes];
    for (int k = 0; k < 4; ++k) {
      const Mat3 lever = skew(t.q[k]) * t.softened;
      for (int a = 0; a < nodes; ++a) {
        Mat3 block = lever * skew(shape_.gradient[a]);
        for (int i = 0; i < 3; ++i) block(i, i) += shape_.gamma[k][a];
        const Mat3 turned = block * t.R.transpose();
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) D[3 * k + i][3 * a + j] = turned(i, j);
      }
    }
    for (int r = 0; r < modes; ++r) {
      for (double& y : SD[r]) y = 0;
      for (int l = 0; l < modes; ++l)
        for (int c = 0; c < 3 * nodes; ++c) SD[r][c] += shape_.S[r][l] * D[l][c];
    }
    for (int r = 0; r < 3 * nodes; ++r) {
      for (double& y : K[r]) y = 0;
      for (int l = 0; l < modes; ++l)
        for (int c = 0; c < 3 * nodes; ++c) K[r][c] += D[l][r] * SD[l][c];
    }
  }

  HexahedronModes shape_;

 public:
  /// K by pairs of corners.
  template <class Point>
  struct Stiffness {
    const Point& point;
    double volume;
    Corners b;
    double K[3 * nodes][3 * nodes];
    Mat3 block(int i, int j) const {
      Mat3 B = volume * point.block(b[i], b[j]);
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) B(r, c) += K[3 * i + r][3 * j + c];
      return B;
    }
  };
  /// The element where its corners are at x: forces (N) on them.
  template <class Point>
  struct State {
    const IncompatibleHexahedron& element;
    Point point;
    Turning turning;
    Corners force;
    Stiffness<Point> stiffness() const {
      Stiffness<Point> K{point, element.shape_.volume, {}, {}};
      for (int a = 0; a < nodes; ++a) K.b[a] = point.pull(element.shape_.gradient[a]);
      element.make_mode_stiffness(turning, K.K);
      return K;
    }
  };
};

}  // namespace delassus::inner
