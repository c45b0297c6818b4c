/// Contact with linearised friction: a pyramid of four sides in place of the cone.
#pragma once

#include <delassus/constraints/contact/cone.hpp>
#include <delassus/constraints/refinements.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/rows/local.hpp>
#include <delassus/rows/row_kind.hpp>

#include <algorithm>
#include <array>
#include <limits>

namespace delassus {

/// u = W λ + b:  0 ≤ u_n ⟂ λ_n ≥ 0. Along each tangent axis by itself |λ_i| ≤ μ λ_n, and λ_i = −μ λ_n sign u_i
/// where it slips. This is what engines do whose friction rows are boxes: It is here to compare with them, since
/// `Coulomb` costs no more. Along an axis it is Coulomb's law. Along a diagonal it holds with √2 μ, and what slides
/// there stops after 1/√2 of the way. The axes are those of `contact_frame`, x and y on a level floor.
///
/// A visit is exact. Of the nine cases, open aside, it takes the first whose linear equations meet the law, or the
/// one that misses it least. (The cases are stick or one of two ways of slip on either axis.)
struct Pyramid {
  static constexpr int rows = 3;
  static constexpr std::array<RowKind, 3> kinds{RowKind::lower, RowKind::friction, RowKind::friction};
  static constexpr auto refines = refine::check | refine::set_friction | refine::clamp | refine::natural_map;

  double friction = 0.5;  ///< μ ≥ 0 of each axis, where neither the pair nor the materials say otherwise

  /// Not called friction: who finds that takes the law for a round cone.
  struct Parameters {
    double slope;  ///< μ of either axis
  };

  void check() const { inner::expect_not_negative("Pyramid: friction", friction); }

  Parameters parameters() const { return {friction}; }
  static void set_friction(Parameters& p, double friction) { p.slope = friction; }

  template <class T>
  Vec<3, T> solve_local(const Parameters& p, const Mat<3, 3, T>& W, const Vec<3, T>& b) const {
    auto best = zero<Vec<3, T>>();
    if (b[0] >= -inner::negligible_approach<T>) return best;
    constexpr int ways[9][2] = {{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}};
    const T enough = T(64) * std::numeric_limits<T>::epsilon() * b.norm();
    T least = std::numeric_limits<T>::infinity();
    for (const auto& way : ways) {
      const Vec<3, T> lambda = answer(W, b, way, T(p.slope));
      const T off = miss(W, b, way, T(p.slope), lambda);
      if (!(off < least)) continue;  // not a number where the equations have no solution
      least = off;
      best = lambda;
      if (off <= enough) break;
    }
    clamp(p, best);
    return best;
  }

  /// F_n = min(s λ_n, u_n),  F_i = s λ_i − clip(s λ_i − u_i, ±μ s λ_n).
  template <class T>
  Vec<3, T> natural_map(const Parameters& p, const Vec<3, T>& lambda, const Vec<3, T>& u, T scale) const {
    const Vec<3, T> x = scale * lambda;
    const T limit = T(p.slope) * std::max(x[0], T(0));
    return {std::min(x[0], u[0]), x[1] - std::clamp(x[1] - u[1], -limit, limit),
            x[2] - std::clamp(x[2] - u[2], -limit, limit)};
  }
  template <class T>
  void clamp(const Parameters& p, Vec<3, T>& lambda) const {
    lambda[0] = std::max(lambda[0], T(0));
    const T limit = T(p.slope) * lambda[0];
    for (int i = 1; i < 3; ++i) lambda[i] = std::clamp(lambda[i], -limit, limit);
  }

 private:
  /// λ with u_n = 0 and, on each axis, u_i = 0 (way 0) or λ_i = way μ λ_n.
  template <class T>
  static Vec<3, T> answer(const Mat<3, 3, T>& W, const Vec<3, T>& b, const int (&way)[2], T mu) {
    Mat<3, 3, T> A = W;
    Vec<3, T> right = b;
    for (int i = 1; i < 3; ++i) {
      if (way[i - 1] == 0) continue;
      A(i, 0) = -T(way[i - 1]) * mu;
      A(i, i) = T(1);
      A(i, 3 - i) = T(0);
      right[i] = T(0);
    }
    return -(inverse(A) * right);
  }
  /// How far the rest of the law is from being met, as a velocity: λ_n ≥ 0, |λ_i| ≤ μ λ_n in stick, u_i
  /// against λ_i in slip.
  template <class T>
  static T miss(const Mat<3, 3, T>& W, const Vec<3, T>& b, const int (&way)[2], T mu,
                const Vec<3, T>& lambda) {
    const Vec<3, T> u = W * lambda + b;
    const T weight = trace(W) / T(3);
    T off = -weight * lambda[0];
    for (int i = 1; i < 3; ++i)
      off = std::max(
          off, way[i - 1] == 0 ? weight * (std::abs(lambda[i]) - mu * lambda[0]) : T(way[i - 1]) * u[i]);
    return is_finite(lambda) ? off : std::numeric_limits<T>::quiet_NaN();
  }
};

}  // namespace delassus
