/// A proof that the rows of an island contradict each other.
#pragma once

#include <delassus/rows/row_kind.hpp>
#include <delassus/solvers/island_problem.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace delassus::inner {

/// Impulses z that move nothing and yet would do work against what the rows ask: z free on an equality and in
/// a motor without a cap, ≥ 0 on a lower row, ≤ 0 on an upper one, 0 where friction or a bound holds, and
///
///   W z = 0,   dᵀz < 0.
///
/// Velocities u = d + W λ that meet the rows have zᵀu ≥ 0, but zᵀu = dᵀz < 0 whatever λ is: there are none.
/// In numbers W z is not zero, and what is proved is that λ would have to be large: with y_i = √w_i λ_i,
///
///   |y| ≥ −dᵀz/√(Σ |(W z)_i|²/w_i),
///
/// which must be `margin` times √(Σ |d_i|²/w_i), with W z known to no more than the rounding of d, since z is
/// scaled to be as large as d. A mass ratio r needs y of r times that, so that the margin is beyond any ratio
/// that sweeps get through. Joints that contradict each other through a body that contacts hold are found
/// without the contacts, which would let W z fall slowly. In single precision there is no such margin:
/// nothing is proved there. Source: [Gale1960], the theorem of the alternative.
template <class Problem>
class Contradiction {
  using T = typename Problem::T;
  static constexpr double rounding = std::numeric_limits<double>::epsilon();
  static constexpr double margin = 1.5e10;
  struct Sums {
    double work = 0, moved = 0, free = 0, size = 0;
  };

 public:
  explicit Contradiction(Problem& problem) : problem_(problem) {}

  /// From the direction in which λ has gone since `before` was saved; λ is something else afterwards.
  bool is_proved(const auto& before) {
    if constexpr (sizeof(T) < sizeof(double)) return false;
    problem_.change([&](auto p, Index i, auto& z) {
      z -= std::get<p>(before.pools)[i];
      clear_bounded<p>(i, z);
    });
    if (moves_nothing()) return true;
    bool has_less = false;
    has_two_sided_alone_ = true;
    problem_.change([&](auto p, Index i, auto& z) {
      const auto whole = z;
      clear_bounded<p>(i, z);
      has_less = has_less || z != whole;
    });
    return has_less && moves_nothing();
  }

 private:
  /// Sweeps take W z to zero; whether z still does work then.
  bool moves_nothing() {
    if (!scale_to_free()) return false;
    double last = std::numeric_limits<double>::infinity(), promise = 0;
    for (int round = 0; round < 40; ++round) {
      const Sums s = measure();
      const double free = std::sqrt(s.free), size = std::sqrt(s.size);
      const double moved = std::sqrt(s.moved) + 8 * rounding * free;
      if (s.work > 1e-6 * free * size && s.work >= margin * moved * free) return true;
      if (!(s.work > 1e-6 * free * size) || !(moved < 0.7 * last) || problem_.is_out_of_time()) return false;
      // Where rows agree dᵀz goes to zero with W z, else it stays: then their ratio grows by 1/0.7 a round.
      if (round % 3 == 0) {
        if (s.work < 1.2 * promise * moved) return false;
        promise = s.work / moved;
      }
      last = moved;
      for (int k = 0; k < 8 && !problem_.is_out_of_time(); ++k) sweep();
    }
    return false;
  }

  template <int p>
  static constexpr auto kinds = Problem::BookType::template kinds<p>();

  template <int p, class Z>
  void clear_bounded(Index i, Z& z) const {
    for (std::size_t k = 0; k < kinds<p>.size(); ++k) z[Index(k)] = allowed<p>(i, k, z[Index(k)]);
  }
  template <int p>
  T allowed(Index i, std::size_t row, T z) const {
    switch (kinds<p>[row]) {
      case RowKind::equality:
        return z;
      case RowKind::lower:
        return has_two_sided_alone_ ? T(0) : std::max(z, T(0));
      case RowKind::upper:
        return has_two_sided_alone_ ? T(0) : std::min(z, T(0));
      case RowKind::friction:
        break;
    }
    return has_no_cap<p>(i) ? z : T(0);
  }
  /// A row alone whose law leaves any impulse as it is.
  template <int p>
  bool has_no_cap(Index i) const {
    if constexpr (kinds<p>.size() == 1 && kinds<p>[0] == RowKind::friction &&
                  Problem::BookType::template clamps<p>()) {
      Vec<1, T> huge(std::sqrt(std::numeric_limits<T>::max()));
      problem_.book().template clamp<p>(i, huge);
      return huge[0] == std::sqrt(std::numeric_limits<T>::max());
    } else {
      return false;
    }
  }

  /// z ← z |d|/|z|, both in energy: (d + W z) − d loses what is smaller than the rounding of d. False for
  /// z = 0.
  bool scale_to_free() {
    const Sums s = measure();
    const double factor = std::sqrt(s.free / s.size);
    if (!(factor > 0) || !std::isfinite(factor)) return false;
    problem_.change([&](auto, Index, auto& z) { z *= T(factor); });
    return true;
  }

  /// (W z)_i.
  template <int p>
  auto moved_by(Index i, const auto& c) const {
    auto u = c.d;
    u -= problem_.rows().template pool<p>().d[i];
    return u;
  }

  Sums measure() const {
    Sums s;
    problem_.each([&](auto p, Index i) {
      const auto c = problem_.template local<p>(i);
      const auto u = moved_by<p>(i, c);
      const auto& d = problem_.rows().template pool<p>().d[i];
      const double w = double(trace(c.W)) / double(d.size());
      if (!(w > 0)) return;
      s.work -= double(d.dot(c.lambda));
      s.moved += double(u.squaredNorm()) / w;
      s.free += double(d.squaredNorm()) / w;
      s.size += w * double(c.lambda.squaredNorm());
    });
    return s;
  }

  /// Gauss-Seidel on min ½ zᵀ W z, row by row.
  void sweep() {
    problem_.each([&](auto p, Index i) {
      const auto c = problem_.template local<p>(i);
      auto u = moved_by<p>(i, c);
      auto z = c.lambda;
      for (std::size_t row = 0; row < kinds<p>.size(); ++row) {
        const Index k = Index(row);
        if (!(c.W(k, k) > T(0))) continue;
        const T next = allowed<p>(i, row, z[k] - u[k] / c.W(k, k)), change = next - z[k];
        z[k] = next;
        for (Index j = 0; j < Index(kinds<p>.size()); ++j) u[j] += c.W(j, k) * change;
      }
      problem_.template assign<p>(i, z);
    });
  }

  Problem& problem_;
  bool has_two_sided_alone_ = false;  ///< z = 0 on lower and upper rows
};

/// Whether λ runs away because the rows contradict each other: asked where sweeps have stalled, a few after λ
/// was `before`. Costs little where λ does not, forty sweeps where the rows agree, and at most some three
/// hundred.
template <class Problem, class ConvergenceMonitor, class Impulses>
bool contradicts(Problem& problem, ConvergenceMonitor& monitor, Impulses& before) {
  if (!problem.is_cut_off(0) && Contradiction<Problem>(problem).is_proved(before)) return true;
  monitor.back_to_best();
  return false;
}

}  // namespace delassus::inner
