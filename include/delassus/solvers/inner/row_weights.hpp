/// What the rows of a law weigh: one number, or two where some are in m/s and others in rad/s.
#pragma once

#include <delassus/math/linear.hpp>
#include <delassus/rows/row_kind.hpp>

namespace delassus::inner {

/// The mean W_kk of the rows in each unit, so that Σ w_k λ_k² is an energy, J, in any unit of length. `turns` as in
/// `turning_rows`.
template <int R, unsigned turns>
struct RowWeights {
  static constexpr bool is_mixed = are_mixed(R, turns);
  static constexpr bool is_turn(int k) { return turns >> k & 1; }

  double motion = 1, turn = 1;  ///< `motion` of all rows where they have one unit

  [[gnu::always_inline]] static RowWeights of(const auto* own) {
    RowWeights out;
    if constexpr (is_mixed) {
      double sum[2] = {};
      int count[2] = {};
      for (int k = 0; k < R; ++k) sum[is_turn(k)] += double(own[k * (R + 1)]), ++count[is_turn(k)];
      out = {sum[0] / count[0], sum[1] / count[1]};
    } else {
      double sum = double(own[0]);
      for (int k = 1; k < R; ++k) sum += double(own[k * (R + 1)]);
      out.motion = out.turn = sum * (1.0 / R);
    }
    return out;
  }
  double operator[](int k) const { return is_mixed && is_turn(k) ? turn : motion; }
};

/// Σ a_k b_k w_k.
template <int R, unsigned turns>
[[gnu::always_inline]] inline double weighed(const RowWeights<R, turns>& w, const Vec<R, double>& a, const Vec<R, double>& b) {
  if constexpr (!RowWeights<R, turns>::is_mixed) return w.motion * dot(a, b);
  double sum = 0;
  for (int k = 0; k < R; ++k) sum += w[k] * a[k] * b[k];
  return sum;
}

/// Σ x_k², rows that turn times `scale`.
template <unsigned turns, int R>
[[gnu::always_inline]] inline double square_of(const Vec<R, double>& x, double scale) {
  if constexpr (turns == 0) return squared_norm(x);
  double sum = 0;
  for (int k = 0; k < R; ++k) {
    const double y = (turns >> k & 1 ? scale : 1.0) * x[k];
    sum += y * y;
  }
  return sum;
}

}  // namespace delassus::inner
