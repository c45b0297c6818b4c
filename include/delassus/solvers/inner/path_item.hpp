/// A constraint whose two sides are smoothed by one number τ.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/rows/row_kind.hpp>

#include <algorithm>

namespace delassus::inner {

/// Every constraint has an unknown x in units of velocity, which holds both its sides. With P = diag(1, μ, μ)
/// in a contact, the island's length in rows in rad/s, 1 elsewhere, and w = tr(P W_ii P)/rows,
///
///   λ = P a/w,   a = p(x),   z = p(−x),   a − z = x,   a ∘ z = τ e,
///
/// where p is ½ (ξ + √(ξ² + 4τ)) on the eigenvalues ξ = x_n ∓ |x_t| that x has in the algebra of the cone, on
/// x itself for a row φ ≥ 0, and a = x, z = 0 for an equality. For τ → 0, p is the projection on the cone.
/// Solved is, for D = ∂p/∂x and B = 1 − e_n (∂s/∂z)ᵀ,
///
///   r(x, τ) = z − s e_n − P (d + W λ) = 0,   s = √(|z_t|² + τ) − √τ, De Saxcé's term,
///   −∂r/∂x = B (1 − D) + P W P D/w.
///
/// (1 − D)⁻¹ is 1 + E, where E = D (1 − D)⁻¹ has the eigenvalues a/z: nothing is lost as one side vanishes.
template <class Real>
struct PathRows {
  Array<Real> shape, scale;              ///< by row: P, and P/w
  Array<Real> x, ahead;                  ///< by row: here, and where the last evaluation was
  Array<Real> newton, direction;         ///< by row, of x: J⁻¹ r, and the step that is made of it
  Array<Real> tangent, rate;             ///< by row, of x: dx/ds of the path, J⁻¹ ∂r/∂log τ
  Array<Real> a, z, residual;            ///< by row
  Array<Real> side, error;               ///< by row: a right-hand side, and what solving it leaves
  Array<Real> E, inverse;                ///< rows × rows a constraint; and E⁻¹, whose eigenvalues are z/a
  Array<Real> B, folded;                 ///< and (B + P C P E/w)⁻¹, C the compliance beside H A⁻¹ Hᵀ

  void resize(std::size_t rows, std::size_t squares) {
    for (auto* list : {&shape, &scale, &x, &ahead, &newton, &direction, &tangent, &rate, &a, &z, &residual, &side, &error}) list->assign(rows, 0);
    for (auto* list : {&E, &inverse, &B, &folded}) list->assign(squares, 0);
  }
};

/// a/z, an eigenvalue of E, or `largest`: in the matrix alone a larger one beside a small one would be the
/// small one's rounding.
inline double ratio(double a, double z, double largest) {
  return a >= largest * z ? largest : std::max(a / z, 1 / largest);
}

/// a, z and E of one x = `ahead`, all of one constraint with R rows; E's eigenvalues are at most `largest`.
inline void smooth(bool is_cone, int R, const RowKind* kinds, const double* ahead, double tau, double largest, double* a, double* z,
                   double* E, double* inverse) {
  const auto p = [tau](double xi) {  // without a difference of nearly equal numbers
    const double root = std::sqrt(xi * xi + 4 * tau);
    return xi >= 0 ? 0.5 * (xi + root) : 2 * tau / (root - xi);
  };
  if (is_cone) {
    const double length = std::hypot(ahead[1], ahead[2]);
    const double t[2] = {length > 0 ? ahead[1] / length : 1, length > 0 ? ahead[2] / length : 0};
    const double low = ahead[0] - length, high = ahead[0] + length;
    const double a_low = p(low), a_high = p(high), z_low = p(-low), z_high = p(-high);
    const auto place = [&](double at_low, double at_high, double* out) {
      out[0] = 0.5 * (at_low + at_high);
      for (int k = 0; k < 2; ++k) out[1 + k] = 0.5 * (at_high - at_low) * t[k];
    };
    place(a_low, a_high, a);
    place(z_low, z_high, z);
    // D across t is (a_high − a_low)/2|x_t|, 1 − D there (z_low − z_high)/2|x_t|.
    const bool is_long = 1e8 * length > std::abs(ahead[0]) + std::sqrt(tau);
    const auto fill = [&](double at_low, double at_high, double across, double* out) {
      const double mean = 0.5 * (at_low + at_high), half = 0.5 * (at_high - at_low);
      if (!is_long) across = mean;
      out[0] = mean;
      for (int k = 0; k < 2; ++k) {
        out[3 * (1 + k)] = out[1 + k] = half * t[k];
        for (int l = 0; l < 2; ++l) out[1 + k + 3 * (1 + l)] = (k == l ? across : 0) + (mean - across) * t[k] * t[l];
      }
    };
    const double low_ratio = ratio(a_low, z_low, largest), high_ratio = ratio(a_high, z_high, largest);
    const double across_ratio = is_long ? ratio(a_high - a_low, z_low - z_high, largest) : 1;
    fill(low_ratio, high_ratio, across_ratio, E);
    fill(1 / low_ratio, 1 / high_ratio, 1 / across_ratio, inverse);
  } else {
    std::fill(E, E + R * R, 0.0);
    std::fill(inverse, inverse + R * R, 0.0);
    for (int k = 0; k < R; ++k) {
      const bool is_equality = kinds[k] == RowKind::equality;
      a[k] = is_equality ? ahead[k] : p(ahead[k]);
      z[k] = is_equality ? 0 : p(-ahead[k]);
      E[k * (R + 1)] = is_equality ? largest : ratio(a[k], z[k], largest);
      inverse[k * (R + 1)] = 1 / E[k * (R + 1)];
    }
  }
}

}  // namespace delassus::inner
