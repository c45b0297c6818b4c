/// The local solve of two stops of one axis.
#pragma once

#include <delassus/constraints/refinements.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/rows/local.hpp>
#include <delassus/rows/row_kind.hpp>

#include <algorithm>
#include <array>

namespace delassus::inner {

/// λ_0 ≥ 0 pushes off the lower one, λ_1 ≤ 0 off the upper one. At most one acts, so that the two are solved
/// exactly.
struct Stops {
  static constexpr int rows = 2;
  static constexpr std::array<RowKind, 2> kinds{RowKind::lower, RowKind::upper};
  static constexpr auto refines = refine::clamp | refine::natural_map | refine::tangent;

  template <class T>
  Vec<2, T> solve_local(const auto&, const Mat<2, 2, T>& W, const Vec<2, T>& b) const {
    auto lambda = zero<Vec<2, T>>();
    if (b[0] < T(0) && W(0, 0) > T(0))
      lambda[0] = -b[0] / W(0, 0);
    else if (b[1] > T(0) && W(1, 1) > T(0))
      lambda[1] = -b[1] / W(1, 1);
    return lambda;
  }
  /// The rows of a diagonal W are apart: each stops where it would let its bound be passed.
  template <class T>
  Mat<2, 2, T> tangent(const auto& item, Local<2, T>& c) const {
    const Vec<2, T> free = c.lambda - c.d.cwiseQuotient(c.W.diagonal());
    c.lambda = free;
    clamp(item, c.lambda);
    Mat<2, 2, T> slope = Mat<2, 2, T>::Zero();
    for (int k = 0; k < 2; ++k)
      if (c.lambda[k] == free[k]) slope(k, k) = 1 / c.W(k, k);
    return slope;
  }
  template <class T>
  Vec<2, T> natural_map(const auto& item, const Vec<2, T>& lambda, const Vec<2, T>& u, T scale) const {
    Vec<2, T> projected = scale * lambda - u;
    clamp(item, projected);
    return scale * lambda - projected;
  }
  template <class T>
  void clamp(const auto&, Vec<2, T>& lambda) const {
    lambda[0] = std::max(T(0), lambda[0]);
    lambda[1] = std::min(T(0), lambda[1]);
  }
};

}  // namespace delassus::inner
