/// Contact without friction: one row.
#pragma once

#include <delassus/constraints/refinements.hpp>
#include <delassus/rows/local.hpp>
#include <delassus/rows/row_kind.hpp>

#include <algorithm>
#include <array>

namespace delassus {

/// 0 ≤ u_n ⟂ λ_n ≥ 0.
struct Frictionless {
  static constexpr int rows = 1;
  static constexpr std::array<RowKind, 1> kinds{RowKind::lower};
  static constexpr auto refines = refine::clamp | refine::natural_map | refine::tangent;

  struct Parameters {};

  Parameters parameters() const { return {}; }

  template <class T>
  Vec<1, T> solve_local(const Parameters&, const Mat<1, 1, T>& W, const Vec<1, T>& b) const {
    return Vec<1, T>(std::max(T(0), -b[0] / W(0, 0)));
  }
  template <class T>
  Mat<1, 1, T> tangent(const Parameters&, Local<1, T>& c) const {
    c.lambda[0] = std::max(T(0), c.lambda[0] - c.d[0] / c.W(0, 0));
    return Mat<1, 1, T>(c.lambda[0] > T(0) ? T(1) / c.W(0, 0) : T(0));
  }
  /// s λ − max(0, s λ − u).
  template <class T>
  Vec<1, T> natural_map(const Parameters&, const Vec<1, T>& lambda, const Vec<1, T>& u, T scale) const {
    return Vec<1, T>(std::min(scale * lambda[0], u[0]));
  }
  template <class T>
  void clamp(const Parameters&, Vec<1, T>& lambda) const {
    lambda[0] = std::max(T(0), lambda[0]);
  }
};

}  // namespace delassus
