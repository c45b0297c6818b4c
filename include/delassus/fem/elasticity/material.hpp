/// What an elastic material is, and the numbers all of them are given by.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/math/linear.hpp>

#include <concepts>
#include <string>

namespace delassus {

/// Lamé's numbers, Pa: λ = E ν/((1 + ν)(1 − 2ν)), μ = E/(2(1 + ν)).
struct Lame {
  /// λ, Pa.
  double lambda, mu;  ///< μ, the modulus of shear, Pa
  /// Of Young's modulus (Pa) and Poisson's ratio; λ is infinite for ν = ½.
  Lame(double young, double poisson)
      : lambda(young * poisson / ((1 + poisson) * (1 - 2 * poisson))), mu(young / (2 * (1 + poisson))) {}
  /// Those of strains in a sheet whose faces are free: λ = E ν/(1 − ν²).
  static Lame of_sheet(double young, double poisson) {
    Lame lame(young, poisson);
    lame.lambda = young * poisson / ((1 + poisson) * (1 - poisson));
    return lame;
  }
};

/// A hyperelastic material. `at(F)` is what it says at one deformation gradient F = ∂x/∂X. That is the energy per
/// volume at rest (J/m³), the first Piola–Kirchhoff stress P = ∂Ψ/∂F (Pa), and ∂P/∂F with its negative
/// eigenvalues cut to zero. The last is contracted with two gradients a, b (1/m) of shape functions:
///
///   block(pull(a), pull(b))_ik = Σ_jl a_j (∂P_ij/∂F_kl) b_l.
template <class M>
concept ElasticMaterial = requires(const M material, const Mat3 F, const Vec3 a) {
  { material.young } -> std::convertible_to<double>;    // Young's modulus, Pa
  { material.poisson } -> std::convertible_to<double>;  // Poisson's ratio
  { material.at(F).energy() } -> std::same_as<double>;
  { material.at(F).stress() } -> std::convertible_to<Mat3>;
  { material.at(F).block(material.at(F).pull(a), material.at(F).pull(a)) } -> std::same_as<Mat3>;
};

/// Refuses numbers that no stable material has.
template <ElasticMaterial M>
void check_material(const M& material, const std::string& who) {
  inner::expect_positive(who + ": Young's modulus", material.young, "Pa");
  constexpr bool may_keep_volume = requires { requires M::may_keep_volume; };
  DELASSUS_EXPECT(
      material.poisson > -1 && (material.poisson < 0.5 || (may_keep_volume && material.poisson == 0.5)),
      who + ": Poisson's ratio " + inner::text(material.poisson) + " must lie in (-1, 0.5" +
          (may_keep_volume ? "]" : ")"));
  if constexpr (requires { material.check(who); }) material.check(who);  // what is its own
}

}  // namespace delassus
