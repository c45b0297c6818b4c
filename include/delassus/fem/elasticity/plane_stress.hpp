/// The law of a thin sheet: a material whose faces are free.
#pragma once

#include <delassus/fem/elasticity/isotropic.hpp>
#include <delassus/fem/elasticity/material.hpp>

#include <algorithm>
#include <string>

namespace delassus {

/// No stress across the sheet, so that it thins as it is pulled. Of a law of Hooke's kind, with two constants
/// and quadratic in its strain, that is again the same law. It takes the two stretches in the sheet, and
///
///   λ ← E ν/(1 − ν²) = 2λμ/(λ + 2μ).
///
/// This has a limit for ν = ½. A law names its derivatives by `principal(lame, σ)`: `Corotational`,
/// `StVenantKirchhoff`.
template <ElasticMaterial M>
struct PlaneStress {
  double young = M{}.young;  ///< Pa
  double poisson = M{}.poisson;  ///< ν in (−1, ½]
  double bending = 1;  ///< of the stiffness that a solid sheet has, E t³/(12(1 − ν²)); what is woven has less

  static constexpr bool may_keep_volume = true;  ///< ν = ½
  void check(const std::string& who) const {
    inner::expect_not_negative(who + ": the share of bending", bending);
  }

  /// F = ∂x/∂X has a last column of zeros; X lies in the plane of the sheet.
  /// The tangent is the positive part of that of the two stretches. Across the sheet, along its normal n, it is
  /// what tension holds:  p_i/σ_i n nᵀ ⊗ V_i V_iᵀ, where p_i > 0. A sheet that is pressed is free to fold.
  IsotropicPoint at(const Mat3& F) const {
    const SingularValues f = stretches(F);
    PrincipalState s;
    constexpr bool is_of_two = requires(const Lame& lame, const Vec3& sigma) { M::principal(lame, sigma); };
    static_assert(is_of_two,
                  "delassus: a sheet needs a law of two constants that turns with it; write Corotational or "
                  "StVenantKirchhoff");
    if constexpr (is_of_two) s = M::principal(Lame::of_sheet(young, poisson), f.sigma);
    s.stress[2] = 0;
    for (int i = 0; i < 2; ++i) {
      s.hessian(2, i) = s.hessian(i, 2) = 0;
      s.flip[1 - i] = s.twist[1 - i] = s.stress[i] / std::max(f.sigma[i], 1e-3);
    }
    s.hessian(2, 2) = 0;
    return {s, f};
  }

  /// F = U diag(σ) Vᵀ, σ₂ = 1 along the sheet's normal: one turn of Jacobi's of the two columns there are. A
  /// triangle without area has a normal as good as any.
  static SingularValues stretches(const Mat3& F) {
    Mat3 B = F, V = Mat3::Identity();
    const Vec3 x = F.col(0), y = F.col(1);
    if (const double along = x.dot(y); along != 0) {
      const inner::JacobiTurn turn(x.dot(x), y.dot(y), along);
      turn.turn(B, 0, 1);
      turn.turn(V, 0, 1);
    }
    const Vec3 b[2] = {B.col(0), B.col(1)};
    const int first = b[0].squaredNorm() >= b[1].squaredNorm() ? 0 : 1;
    const double longest = b[first].norm();
    Vec3 u[2];
    u[first] = longest > 0 ? Vec3(b[first] / longest) : unit_axis(0);
    const Vec3 rest = b[1 - first] - u[first].dot(b[1 - first]) * u[first];
    const double length = rest.norm();
    u[1 - first] = length > 1e-14 * longest ? Vec3(rest / length) : inner::any_normal(u[first]);
    return {columns(u[0], u[1], Vec3(u[0].cross(u[1]))), V, {u[0].dot(b[0]), u[1].dot(b[1]), 1}};
  }
};

}  // namespace delassus
