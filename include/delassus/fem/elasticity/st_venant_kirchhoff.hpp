/// Hooke's law for Green's strain: large turns, and a warning for large compressions.
#pragma once

#include <delassus/fem/elasticity/isotropic.hpp>
#include <delassus/fem/elasticity/material.hpp>

namespace delassus {

/// Ψ = μ E:E + λ/2 tr²E,  E = (FᵀF − 1)/2. Pressed below 1/√3 of its length a bar of it gives way, |P| =
/// E/(3√3) there, and it does not come back from inside out: for tests and for tension.
struct StVenantKirchhoff {
  double young = 1e5;  ///< Pa
  double poisson = 0.3;  ///< ν in (−1, ½)

  /// Of the stretches x.
  static PrincipalState principal(const Lame& lame, const Vec3& x) {
    Vec3 strain, second;  // E and S = 2μE + λ tr E
    for (int k = 0; k < 3; ++k) strain[k] = 0.5 * (x[k] - 1) * (x[k] + 1);
    const double trace = strain[0] + strain[1] + strain[2];
    PrincipalState s;
    s.energy = lame.mu * strain.dot(strain) + 0.5 * lame.lambda * trace * trace;
    for (int k = 0; k < 3; ++k) second[k] = 2 * lame.mu * strain[k] + lame.lambda * trace;
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      s.stress[k] = x[k] * second[k];
      for (int l = 0; l < 3; ++l)
        s.hessian(k, l) = lame.lambda * x[k] * x[l] + (k == l ? second[k] + 2 * lame.mu * x[k] * x[k] : 0);
      const double mean = 0.5 * (second[i] + second[j]);
      s.flip[k] = mean + 0.5 * lame.mu * (x[i] + x[j]) * (x[i] + x[j]);
      s.twist[k] = mean + 0.5 * lame.mu * (x[i] - x[j]) * (x[i] - x[j]);
    }
    return s;
  }
  IsotropicPoint at(const Mat3& F) const {
    const SingularValues f = singular_values(F);
    return {principal(Lame(young, poisson), f.sigma), f};
  }
};
static_assert(ElasticMaterial<StVenantKirchhoff>);

}  // namespace delassus
