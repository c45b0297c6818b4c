/// Rows and cones with their corners rounded off, one constraint at a time.
#pragma once

#include <delassus/math/linear.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/solvers/inner/newton_item.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace delassus::inner {

/// Every constraint has an unknown x in units of velocity, which holds both its sides. With P = diag(1, μ, μ)
/// in a contact, 1 elsewhere, and w = tr(P W_ii P)/rows,
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
template <int R>
struct PathItem : NewtonItem<R> {
  static constexpr int rows = R;
  Vec<R> shape, scale;              ///< P, and P/w
  Vec<R> x, ahead;                  ///< here, and where the last evaluation was
  Vec<R> direction, tangent, rate;  ///< of x: the Newton step, dx/ds of the path, J⁻¹ ∂r/∂log τ
  Vec<R> a, z, residual;
  Vec<R> side;           ///< a right-hand side
  Mat<R, R> E, inverse;  ///< and E⁻¹, whose eigenvalues are z/a
  Mat<R, R> B, folded;   ///< and (B + P C P E/w)⁻¹, C the compliance beside H A⁻¹ Hᵀ
};

/// a/z, an eigenvalue of E, or `largest`: in the matrix alone a larger one beside a small one would be the
/// small one's rounding.
inline double ratio(double a, double z, double largest) {
  return a >= largest * z ? largest : std::max(a / z, 1 / largest);
}

/// a, z and E of one x; E's eigenvalues are at most `largest`.
template <bool is_cone, int R>
void smooth(PathItem<R>& c, const std::array<RowKind, std::size_t(R)>& kinds, double tau, double largest) {
  const auto p = [tau](double xi) {  // without a difference of nearly equal numbers
    const double root = std::sqrt(xi * xi + 4 * tau);
    return xi >= 0 ? 0.5 * (xi + root) : 2 * tau / (root - xi);
  };
  if constexpr (is_cone) {
    const double length = std::hypot(c.ahead[1], c.ahead[2]);
    const Vec<2> t = length > 0 ? Vec<2>(c.ahead[1] / length, c.ahead[2] / length) : Vec<2>(1, 0);
    const double low = c.ahead[0] - length, high = c.ahead[0] + length;
    const double a_low = p(low), a_high = p(high), z_low = p(-low), z_high = p(-high);
    const auto place = [&](double at_low, double at_high, Vec<R>& out) {
      out[0] = 0.5 * (at_low + at_high);
      for (int k = 0; k < 2; ++k) out[1 + k] = 0.5 * (at_high - at_low) * t[k];
    };
    place(a_low, a_high, c.a);
    place(z_low, z_high, c.z);
    // D across t is (a_high − a_low)/2|x_t|, 1 − D there (z_low − z_high)/2|x_t|.
    const bool is_long = 1e8 * length > std::abs(c.ahead[0]) + std::sqrt(tau);
    const auto fill = [&](double at_low, double at_high, double across, Mat<R, R>& out) {
      const double mean = 0.5 * (at_low + at_high), half = 0.5 * (at_high - at_low);
      if (!is_long) across = mean;
      out(0, 0) = mean;
      for (int k = 0; k < 2; ++k) {
        out(0, 1 + k) = out(1 + k, 0) = half * t[k];
        for (int l = 0; l < 2; ++l) out(1 + k, 1 + l) = (k == l ? across : 0) + (mean - across) * t[k] * t[l];
      }
    };
    const double low_ratio = ratio(a_low, z_low, largest), high_ratio = ratio(a_high, z_high, largest);
    const double across_ratio = is_long ? ratio(a_high - a_low, z_low - z_high, largest) : 1;
    fill(low_ratio, high_ratio, across_ratio, c.E);
    fill(1 / low_ratio, 1 / high_ratio, 1 / across_ratio, c.inverse);
  } else {
    c.E.setZero();
    c.inverse.setZero();
    for (int k = 0; k < R; ++k) {
      const bool is_equality = kinds[std::size_t(k)] == RowKind::equality;
      c.a[k] = is_equality ? c.ahead[k] : p(c.ahead[k]);
      c.z[k] = is_equality ? 0 : p(-c.ahead[k]);
      c.E(k, k) = is_equality ? largest : ratio(c.a[k], c.z[k], largest);
      c.inverse(k, k) = 1 / c.E(k, k);
    }
  }
}

}  // namespace delassus::inner
