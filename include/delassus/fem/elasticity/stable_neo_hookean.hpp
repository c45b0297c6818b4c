/// A rubber-like material that can be turned inside out and comes back.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/fem/elasticity/isotropic.hpp>
#include <delassus/fem/elasticity/material.hpp>

namespace delassus {

/// Ψ = μ/2 (I − 3) + λ/2 (J − α)² − μ/2 ln(I + 1), less its value at rest. Here I = Σσ_i², J = det F and
/// α = 1 + 3μ/(4λ). With Lamé's λ_L and μ_L, μ is 4/3 μ_L and λ is λ_L + 5/6 μ_L, so that small strains follow
/// Hooke's law. No logarithm of J: finite for every F. Source: [Smith2018].
struct StableNeoHookean {
  double young = 1e5;  ///< Pa
  double poisson = 0.3;  ///< ν in (−1, ½)

  IsotropicPoint at(const Mat3& F) const {
    const Lame lame(young, poisson);
    const double mu = 4 * lame.mu / 3, lambda = lame.lambda + 5 * lame.mu / 6, alpha = 1 + 0.75 * mu / lambda;
    const SingularValues f = singular_values(F);
    const Vec3& x = f.sigma;
    const double I = x.dot(x), J = x[0] * x[1] * x[2];
    const double stiffness = mu * I / (I + 1), pressure = lambda * (J - alpha);
    const Vec3 area(x[1] * x[2], x[2] * x[0], x[0] * x[1]);  // ∂J/∂σ
    PrincipalState s;
    s.energy = 0.5 * (mu * (I - 3 - std::log((I + 1) / 4)) +
                      lambda * ((J - alpha) * (J - alpha) - (1 - alpha) * (1 - alpha)));
    const double curvature = 2 * mu / ((I + 1) * (I + 1));
    for (int k = 0; k < 3; ++k) {
      s.stress[k] = stiffness * x[k] + pressure * area[k];
      for (int i = 0; i < 3; ++i)
        s.hessian(i, k) = curvature * x[i] * x[k] + lambda * area[i] * area[k] +
                          (i == k ? stiffness : pressure * x[3 - i - k]);
      s.flip[k] = stiffness - pressure * x[k];
      s.twist[k] = stiffness + pressure * x[k];
    }
    return {s, f};
  }
};
static_assert(ElasticMaterial<StableNeoHookean>);

}  // namespace delassus
