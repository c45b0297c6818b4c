/// One straight piece of a rod: what it resists, and how its ends feel it.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/math/rotation.hpp>

#include <algorithm>
#include <array>

namespace delassus::inner {

/// A beam between two nodes that carry frames p₁ and p₂, x along the beam at rest. Its own frame D is half
/// way between them, and turns with it: whatever the turn of the whole, only
///
///   d = Dᵀ(x₂ − x₁),  ℓ = |d|,  g = 2ℓ/(ℓ + d_x),
///   Γ = (ℓ − L, √g d_y, √g d_z)   (m: stretch, shear of y and z),   ψ = log(p₁⁻¹ p₂)   (rad: twist, bend),
///   Ψ = ½ Γ·k Γ + ½ ψ·c ψ
///
/// count. Stretch is that of the line between the ends, wherever the frames look: k of shear is that of
/// bending too, and a segment much longer than its bends, as of a thread that hangs, would grow by it without
/// end. With √g shear is 2ℓ sin(α/2), α from D to the line, which grows up to a half turn. c = (G J, E I_y, E
/// I_z)/L, k = (E A/L, 1/(L/(κ G A) + L³/(12 E I)) for each side): for small Γ and ψ this is Timoshenko's
/// beam, exact at the nodes whatever the length. Source: docs/references.md, [SimoVuQuoc1986] for the
/// strains, [MacNeal1978] for the share of bending in k.
struct Beam {
  double length = 0;
  Vec3 k = Vec3::Zero(), c = Vec3::Zero();  ///< N/m and N·m/rad
  Quat from_first = Quat::Identity();       ///< p₁ = q₁ from_first, q₁ the frame of the first node
  Quat from_second = Quat::Identity();

  void memory(auto& archive) { archive(length, k, c, from_first, from_second); }

  struct Strain {
    Vec3 gamma, psi;
    Vec3 d;  ///< Dᵀ(x₂ − x₁), m
    Mat3 D;
  };
  Strain strain(const Vec3& x1, const Quat& q1, const Vec3& x2, const Quat& q2) const {
    const Quat p1 = q1 * from_first;
    Strain s;
    s.psi = logarithm<double>(unit(p1.conjugate() * (q2 * from_second)));
    s.D = rotation_matrix<double>(p1 * exponential<double>(0.5 * s.psi));
    s.d = s.D.transpose() * Vec3(x2 - x1);
    const double l = s.d.norm(), g = lean_factor(s.d, l);
    s.gamma = {l - length, g * s.d[1], g * s.d[2]};
    return s;
  }
  double energy(const Strain& s) const {
    return 0.5 * (s.gamma.dot(k.cwiseProduct(s.gamma)) + s.psi.dot(c.cwiseProduct(s.psi)));
  }

  /// Forces (N) and moments (N·m) on the ends, −∂Ψ/∂(x₁, turn₁, x₂, turn₂), and K in blocks of 3 × 3, all in
  /// the world's axes. K = Gᵀ diag(k, c) G with G = ∂(Γ, ψ): positive semidefinite, and no turn or shift of
  /// the whole strains. Where the beam is pulled by N > 0, N/ℓ (1 − t tᵀ) of a taut string is added, without
  /// which a tight thread would swing as an explicit spring.
  struct State {
    std::array<Vec3, 4> force;
    std::array<std::array<Mat3, 4>, 4> K;  ///< of (x₁, turn₁, x₂, turn₂); the upper triangle
  };
  State at(const Strain& s, bool with_stiffness) const {
    // With θ = |ψ|: δψ = S Dᵀ(ω₂ − ω₁), and D turns by the mean of the ends less ½ tan(θ/4)/θ ψ × their
    // difference.
    const double theta = s.psi.norm(), theta2 = theta * theta;
    const bool is_small = theta < 1e-3;
    const double stretch = is_small ? 1 + theta2 / 24 : 0.5 * theta / std::sin(0.5 * theta);
    const double along = is_small ? -1.0 / 24 : (1 - stretch) / theta2;
    const double lean = is_small ? 0.25 + theta2 / 192 : std::tan(0.25 * theta) / theta;
    const Mat3 S = stretch * Mat3(Mat3::Identity()) + along * outer(s.psi, s.psi), cross = skew<double>(s.d);
    const Mat3 mean = 0.5 * cross, difference = (0.5 * lean) * Mat3(cross * skew<double>(s.psi));
    const Mat3 B1 = mean + difference, B2 = mean - difference;
    const Mat3 J = strain_by_d(s.d);
    const Vec3 n = J.transpose() * Vec3(k.cwiseProduct(s.gamma)), m = S * Vec3(c.cwiseProduct(s.psi));

    State state;
    state.force = {s.D * n, s.D * Vec3(m - B1.transpose() * n), s.D * Vec3(-n),
                   s.D * Vec3(-(B2.transpose() * n) - m)};
    if (!with_stiffness) return state;
    Mat3 P = J.transpose() * Mat3(Mat3(k.asDiagonal()) * J);
    const Mat3 kB1 = P * B1, kB2 = P * B2, SS = S * Mat3(Mat3(c.asDiagonal()) * S);
    const double size = s.d.norm(), pull = n.dot(s.d) / std::max(size * size, 1e-300);
    if (pull > 0) P += pull * (Mat3(Mat3::Identity()) - outer(s.d, s.d) / (size * size));
    const auto in_world = [&](const Mat3& X) { return Mat3(s.D * Mat3(X * s.D.transpose())); };
    auto& K = state.K;
    K[0][0] = K[2][2] = in_world(P);
    K[0][2] = Mat3(-1.0 * K[0][0]);
    K[2][3] = in_world(kB2);
    K[0][3] = Mat3(-1.0 * K[2][3]);
    K[0][1] = in_world(-1.0 * kB1);
    K[1][2] = Mat3(-1.0 * K[0][1].transpose());
    K[1][1] = in_world(B1.transpose() * kB1 + SS);
    K[1][3] = in_world(B1.transpose() * kB2 - SS);
    K[3][3] = in_world(B2.transpose() * kB2 + SS);
    return state;
  }

 private:
  /// √g.
  static double lean_factor(const Vec3& d, double l) {
    return std::sqrt(2 * l / std::max(l + d[0], 1e-12 * l + 1e-300));
  }
  /// ∂Γ/∂d, with t = d/ℓ and ∂√g/∂d = (d_x t − ℓ e₁)/(√g (ℓ + d_x)²).
  static Mat3 strain_by_d(const Vec3& d) {
    const double l = std::max(d.norm(), 1e-300), sum = std::max(l + d[0], 1e-12 * l), g = lean_factor(d, l);
    const Vec3 t = d / l, dg = (d[0] * t - Vec3(l, 0, 0)) / (g * sum * sum);
    Mat3 J;
    for (int j = 0; j < 3; ++j) {
      J(0, j) = t[j];
      for (int i = 1; i < 3; ++i) J(i, j) = d[i] * dg[j] + (i == j ? g : 0);
    }
    return J;
  }
  static Mat3 outer(const Vec3& a, const Vec3& b) { return columns<double>(b[0] * a, b[1] * a, b[2] * a); }
};

}  // namespace delassus::inner
