/// Hooke's law in the axes of the rotated element: large turns, small strains.
#pragma once

#include <delassus/bodies/elasticity/isotropic.hpp>
#include <delassus/bodies/elasticity/material.hpp>

namespace delassus {

/// Ψ = μ Σ(σ_i − 1)² + λ/2 (Σ(σ_i − 1))², that is μ |F − R|² + λ/2 tr²(RᵀF − 1), R the rotation next to F.
/// The last σ is signed, so that an element that is flat or inside out is pushed back by the same law.
struct Corotational {
  double young = 1e5;  ///< Pa
  double poisson = 0.3;

  IsotropicPoint at(const Mat3& F) const {
    const Lame lame(young, poisson);
    const SingularValues f = singular_values(F);
    const double trace = (f.sigma[0] - 1) + (f.sigma[1] - 1) + (f.sigma[2] - 1),
                 pressure = lame.lambda * trace;
    PrincipalState s;
    s.energy = 0.5 * pressure * trace;
    for (int k = 0; k < 3; ++k) {
      const double strain = f.sigma[k] - 1;
      s.energy += lame.mu * strain * strain;
      s.stress[k] = 2 * lame.mu * strain + pressure;
      for (int i = 0; i < 3; ++i) s.hessian(i, k) = lame.lambda + (i == k ? 2 * lame.mu : 0);
      s.flip[k] = 2 * lame.mu;
      // 2μ + 2 (λ tr − 2μ)/(σ_i + σ_j): the turn of R, which softens what is pressed. Of two stretches whose
      // sum vanishes R is not defined, and the mode is as stiff as one says.
      const double sum = f.sigma[(k + 1) % 3] + f.sigma[(k + 2) % 3];
      s.twist[k] = 2 * lame.mu + 2 * (pressure - 2 * lame.mu) / std::max(sum, 1e-3);
    }
    return {s, f};
  }
  /// The same at one F a lane.
  IsotropicLanes at(const LaneMatrix& F) const {
    const Lame lame(young, poisson);
    const LaneSingularValues f = singular_values(F);
    const Lanes pressure = lame.lambda * (f.sigma[0] - 1 + (f.sigma[1] - 1) + (f.sigma[2] - 1));
    IsotropicLanes point{.U = f.U, .V = f.V};
    for (int k = 0; k < 3; ++k) {
      point.stress[k] = 2 * lame.mu * (f.sigma[k] - 1) + pressure;
      for (int i = 0; i < 3; ++i) point.hessian(i, k) = all_lanes(lame.lambda + (i == k ? 2 * lame.mu : 0));
      const Lanes sum = larger_lanes(f.sigma[(k + 1) % 3] + f.sigma[(k + 2) % 3], all_lanes(1e-3));
      const Lanes twist = larger_lanes(2 * lame.mu + 2 * (pressure - 2 * lame.mu) / sum, all_lanes(0));
      point.half_sum[k] = 0.5 * (2 * lame.mu + twist);
      point.half_difference[k] = 0.5 * (2 * lame.mu - twist);
    }
    return point;
  }
};
static_assert(ElasticMaterial<Corotational>);

}  // namespace delassus
