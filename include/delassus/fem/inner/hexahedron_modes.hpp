/// What of a hexahedron at rest does not change: mean gradients, shapes that no affine map makes, and their
/// stiffness.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/fem/elasticity/material.hpp>
#include <delassus/geometry/hexahedral_mesh.hpp>
#include <delassus/math/pivoted_lu.hpp>

#include <array>

namespace delassus::inner {

/// The four shapes of a hexahedron that no affine map makes: ηζ, ζξ, ξη, ξηζ at the corners.
inline double hourglass(int k, int corner) {
  const auto& s = hexahedron_corner[corner];
  return k == 3 ? s[0] * s[1] * s[2] : s[(k + 1) % 3] * s[(k + 2) % 3];
}

/// g_a, γ_ka, S_kl and V of `IncompatibleHexahedron`, from its corners X at rest (m) and Hooke's law.
class HexahedronModes {
 public:
  using Corners = EightPoints;
  static constexpr int nodes = 8, modes = 12;  ///< three a shape

  HexahedronModes() = default;
  HexahedronModes(const Corners& X, const Lame& lame) {
    const Samples samples = sample(X);
    make_gamma(X);
    make_modes(samples, lame);
  }

  std::array<Vec3, nodes> gradient;
  std::array<std::array<double, nodes>, 4> gamma;
  std::array<std::array<double, modes>, modes> S;  ///< N/m
  double volume = 0;

 private:
  /// The Jacobians of Gauss's points.
  struct Samples {
    std::array<Mat3, 8> inverse;  ///< ∂ξ/∂X
    std::array<double, 8> volume;
    Mat3 middle;  ///< det J ∂ξ/∂X at ξ = 0
  };

  Samples sample(const Corners& X) {
    Samples at;
    volume = 0;
    for (Vec3& g : gradient) g.setZero();
    for (int g = 0; g < 8; ++g) {
      const Vec3 xi = gauss_point(g);
      const Mat3 J = jacobian(X, xi);
      at.inverse[g] = inverse(J);
      at.volume[g] = determinant(J);
      volume += at.volume[g];
      for (int a = 0; a < nodes; ++a)
        gradient[a] += at.volume[g] * (at.inverse[g].transpose() * trilinear_slope(a, xi));
    }
    for (Vec3& g : gradient) g /= volume;
    const Mat3 J = jacobian(X, Vec3::Zero());
    at.middle = determinant(J) * inverse(J);
    return at;
  }

  /// γ_k · (1, X, Y, Z) = 0 and γ_k · h_l = δ_kl, h the shapes: G⁻¹ of the vectors h_k − Σ_i (h_k · X_i) g_i,
  /// G their products with h.
  void make_gamma(const Corners& X) {
    Mat<4, 8> rows;
    Mat<4, 4> G = Mat<4, 4>::Zero();
    for (int k = 0; k < 4; ++k) {
      Vec3 moment = Vec3::Zero();
      for (int a = 0; a < nodes; ++a) moment += hourglass(k, a) * X[a];
      for (int a = 0; a < nodes; ++a) rows(k, a) = hourglass(k, a) - moment.dot(gradient[a]);
    }
    for (int k = 0; k < 4; ++k)
      for (int l = 0; l < 4; ++l)
        for (int a = 0; a < nodes; ++a) G(k, l) += rows(k, a) * hourglass(l, a);
    PivotedLu<4, double> lu;
    lu.factor(G);
    lu.template solve<8>(rows);
    for (int k = 0; k < 4; ++k)
      for (int a = 0; a < nodes; ++a) gamma[k][a] = rows(k, a);
  }

  /// S: of Hooke's law on the gradients b of the four shapes less their mean and of the three incompatible
  /// modes,
  ///
  ///   K_ij = ∫ μ ((b_i·b_j) 1 + b_j b_iᵀ) + λ Σ_m t_im t_jmᵀ,   t_im = ∫ φ_m b_i,
  ///
  /// φ an orthonormal base of the functions linear in ξ, the last nine rows eliminated.
  void make_modes(const Samples& at, const Lame& lame) {
    constexpr int shapes = 7, n = 3 * shapes;
    Vec3 b[shapes][8];
    make_gradients(at, b);
    double phi[4][8];
    make_linear_functions(at, phi);
    double K[n][n];
    for (int i = 0; i < shapes; ++i)
      for (int j = 0; j < shapes; ++j) {
        Mat3 block = Mat3::Zero();
        for (int g = 0; g < 8; ++g) {
          const double mu = lame.mu * at.volume[g], along = mu * b[i][g].dot(b[j][g]);
          for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) block(r, c) += mu * b[j][g][r] * b[i][g][c] + (r == c ? along : 0);
        }
        for (int m = 0; m < 4; ++m) {
          Vec3 ti = Vec3::Zero(), tj = Vec3::Zero();
          for (int g = 0; g < 8; ++g) {
            ti += at.volume[g] * phi[m][g] * b[i][g];
            tj += at.volume[g] * phi[m][g] * b[j][g];
          }
          for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) block(r, c) += lame.lambda * ti[r] * tj[c];
        }
        for (int r = 0; r < 3; ++r)
          for (int c = 0; c < 3; ++c) K[3 * i + r][3 * j + c] = block(r, c);
      }
    for (int k = n; k-- > modes;)
      for (int r = 0; r < k; ++r)
        for (int c = 0; c < k; ++c) K[r][c] -= K[r][k] * K[k][c] / K[k][k];
    for (int r = 0; r < modes; ++r)
      for (int c = 0; c < modes; ++c) S[r][c] = 0.5 * (K[r][c] + K[c][r]);
  }

  /// At Gauss's points. An incompatible mode has the gradient −2ξ_i ∂ξ_i/∂X of the middle, scaled by
  /// det J(0)/det J so that its mean vanishes.
  void make_gradients(const Samples& at, Vec3 (&b)[7][8]) const {
    for (int g = 0; g < 8; ++g) {
      const Vec3 xi = gauss_point(g);
      for (int k = 0; k < 4; ++k) {
        b[k][g].setZero();
        for (int a = 0; a < nodes; ++a)
          b[k][g] +=
              hourglass(k, a) * (Vec3(at.inverse[g].transpose() * trilinear_slope(a, xi)) - gradient[a]);
      }
      for (int i = 0; i < 3; ++i)
        b[4 + i][g] = (-2 * xi[i] / at.volume[g]) * Vec3(at.middle(i, 0), at.middle(i, 1), at.middle(i, 2));
    }
  }

  /// 1, ξ, η, ζ made orthonormal over the element, at Gauss's points.
  static void make_linear_functions(const Samples& at, double (&phi)[4][8]) {
    for (int m = 0; m < 4; ++m) {
      for (int g = 0; g < 8; ++g) phi[m][g] = m == 0 ? 1 : gauss_point(g)[m - 1];
      for (int l = 0; l < m; ++l) {
        double part = 0;
        for (int g = 0; g < 8; ++g) part += at.volume[g] * phi[l][g] * phi[m][g];
        for (int g = 0; g < 8; ++g) phi[m][g] -= part * phi[l][g];
      }
      double square = 0;
      for (int g = 0; g < 8; ++g) square += at.volume[g] * phi[m][g] * phi[m][g];
      for (int g = 0; g < 8; ++g) phi[m][g] /= std::sqrt(square);
    }
  }
};

}  // namespace delassus::inner
