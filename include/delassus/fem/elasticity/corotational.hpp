/// Hooke's law in the axes of the rotated element: large turns, small strains.
#pragma once

#include <delassus/fem/elasticity/isotropic.hpp>
#include <delassus/fem/elasticity/material.hpp>
#include <delassus/math/lanes.hpp>

namespace delassus {

/// `Corotational` at one F a lane. Beside 2μ |dF|² and λ tr²(RᵀdF), ∂P/∂F has the turn of R. With a′ = R a,
///
///   block(a, b) = 2μ a·b 1 + λ a′ b′ᵀ + [a′]ₓ Z [b′]ₓᵀ,   Z = Σ_k ½ (twist_k − 2μ) u_k u_kᵀ.
///
/// Here u_k are the principal axes where the element is, and twists are cut at zero.
struct CorotationalLanes {
  /// @var R
  /// The rotation next to F.
  /// @var stress
  /// P, Pa.
  LaneMatrix R, stress, turn;  ///< Z, Pa
  /// Lamé's λ, Pa.
  Lanes lambda, two_mu;  ///< 2μ, Pa

  /// Multiplies P, Z, λ and 2μ by the volume they act in, m³.
  void integrate(const Lanes& volume) {
    for (LaneMatrix* A : {&stress, &turn})
      for (LaneVector& column : A->column) column = times(volume, column);
    lambda *= volume, two_mu *= volume;
  }

  /// Of a gradient g: g, λ R g, R g, and [R g]ₓ Z by columns.
  struct Pulled {
    /// @var gradient
    /// g, 1/m.
    /// @var stiff
    /// λ R g.
    LaneVector gradient, stiff, turned;  ///< R g, 1/m
    LaneMatrix lever;  ///< [R g]ₓ Z
  };
  Pulled pull(const LaneVector& g) const {
    Pulled p;
    p.gradient = g;
    for (int i = 0; i < 3; ++i) p.turned[i] = R(i, 0) * g[0] + R(i, 1) * g[1] + R(i, 2) * g[2];
    p.stiff = times(lambda, p.turned);
    for (int k = 0; k < 3; ++k) p.lever.column[k] = cross(p.turned, turn.column[k]);
    return p;
  }
  /// The stiffness between two nodes, 3 × 3 a lane, by the formula above.
  LaneMatrix block(const Pulled& a, const Pulled& b) const {
    const Lanes along = two_mu * dot(a.gradient, b.gradient);
    LaneMatrix K;
    for (int k = 0; k < 3; ++k) {
      const int l = (k + 1) % 3, m = (k + 2) % 3;
      for (int i = 0; i < 3; ++i)  // row k of [b′]ₓ is e_m b′_l − e_l b′_m
        K(i, k) = a.stiff[i] * b.turned[k] + (a.lever(i, m) * b.turned[l] - a.lever(i, l) * b.turned[m]);
      K(k, k) += along;
    }
    return K;
  }
};

/// Ψ = μ Σ(σ_i − 1)² + λ/2 (Σ(σ_i − 1))², that is μ |F − R|² + λ/2 tr²(RᵀF − 1), R the rotation next to F.
/// The last σ is signed, so that an element that is flat or inside out is pushed back by the same law.
struct Corotational {
  double young = 1e5;  ///< Pa
  double poisson = 0.3;  ///< ν in (−1, ½)

  /// Of the stretches σ.
  static PrincipalState principal(const Lame& lame, const Vec3& sigma) {
    const double trace = (sigma[0] - 1) + (sigma[1] - 1) + (sigma[2] - 1), pressure = lame.lambda * trace;
    PrincipalState s;
    s.energy = 0.5 * pressure * trace;
    for (int k = 0; k < 3; ++k) {
      const double strain = sigma[k] - 1;
      s.energy += lame.mu * strain * strain;
      s.stress[k] = 2 * lame.mu * strain + pressure;
      for (int i = 0; i < 3; ++i) s.hessian(i, k) = lame.lambda + (i == k ? 2 * lame.mu : 0);
      s.flip[k] = 2 * lame.mu;
      // 2μ + 2 (λ tr − 2μ)/(σ_i + σ_j): the turn of R, which softens what is pressed. Of two stretches whose
      // sum vanishes R is not defined, and the mode is as stiff as one says.
      const double sum = sigma[(k + 1) % 3] + sigma[(k + 2) % 3];
      s.twist[k] = 2 * lame.mu + 2 * (pressure - 2 * lame.mu) / std::max(sum, 1e-3);
    }
    return s;
  }
  IsotropicPoint at(const Mat3& F) const {
    const SingularValues f = singular_values(F);
    return {principal(Lame(young, poisson), f.sigma), f};
  }
  /// The same at one F a lane.
  CorotationalLanes at(const LaneMatrix& F) const {
    const Lame lame(young, poisson);
    const LaneSingularValues f = singular_values(F);
    const Lanes pressure = lame.lambda * (f.sigma[0] - 1 + (f.sigma[1] - 1) + (f.sigma[2] - 1));
    LaneMatrix Up, Uc;
    for (int k = 0; k < 3; ++k) {
      Up.column[k] = times(2 * lame.mu * (f.sigma[k] - 1) + pressure, f.U.column[k]);
      const Lanes sum = larger_lanes(f.sigma[(k + 1) % 3] + f.sigma[(k + 2) % 3], all_lanes(1e-3));
      Uc.column[k] = times(larger_lanes((pressure - 2 * lame.mu) / sum, all_lanes(-lame.mu)), f.U.column[k]);
    }
    return {times_transposed(f.U, f.V), times_transposed(Up, f.V), times_transposed(Uc, f.U),
            all_lanes(lame.lambda), all_lanes(2 * lame.mu)};
  }
};
static_assert(ElasticMaterial<Corotational>);

}  // namespace delassus
