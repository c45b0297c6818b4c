/// One island as a convex function of the velocities of its bodies.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/solvers/inner/body_space.hpp>
#include <delassus/solvers/inner/halve_step.hpp>
#include <delassus/solvers/inner/whole_system.hpp>
#include <delassus/solvers/measure.hpp>

#include <algorithm>
#include <limits>

namespace delassus::inner {

/// The laws with the slip of their friction rows given, by constraint, or as they are.
template <class T>
struct LawsOfSlips {
  Array<double> slip;     ///< |u_t| that the problem is given
  bool is_exact = false;  ///< S and λ(u) are those of the law as it is, with the slip that u has

  void tangent(const NewtonConstraint<T>& c, const double* w, const double* d, double* lambda, double* slope) const {
    const PoolView<T>& pool = *c.span->pool;
    if (is_exact) pool.tangent(pool, c.item, w, d, lambda, slope);
    else pool.convex_tangent(pool, c.item, w, d, slip[std::size_t(c.number)], lambda, slope);
  }
};

/// With the slips s_i = |u_t| given, Coulomb's law is the normality law of its cone for u + μ s e_n, and the
/// velocities of the bodies are the minimum of a convex function; its proximal point around λ̂ is that of
///
///   Φ(y) = ½ yᵀ A y + Σ ½ |λ_i(u_i)|²_{R + ε w},   ∇Φ = A F,   F(y) = y − G (λ(u) − λ̂),   u = d + W λ̂ + H y.
template <class T, int width>
class ConvexSpace : public BodySpace<T, WholeSystem<T, width>, LawsOfSlips<T>> {
  using Base = BodySpace<T, WholeSystem<T, width>, LawsOfSlips<T>>;
  using Constraint = typename Base::Constraint;
  using Base::constraints_, Base::laws, Base::error, Base::move, Base::over_weights, Base::slope;

 public:
  using Base::best, Base::centre, Base::lambda, Base::velocity, Base::weight;
  using Base::evaluate, Base::hand_over;

  bool gather(Island<T>& island) {
    if (!Base::gather(island)) return false;
    laws.slip.resize(constraints_.size());
    laws.is_exact = false;
    for (auto* rows : {&before, &total_, &step_}) rows->assign(lambda.size(), 0.0);
    begin(false);
    return true;
  }

  /// One proximal point, as sharp as rounding lets it be.
  int descend(Island<T>& island, double epsilon) {
    double size = evaluate(island, epsilon, 0);
    const double rounding = reach(epsilon);
    for (int k = 0; k < 100; ++k) {
      if (!(size > 4 * rounding) || !std::isfinite(size) || !find_direction(island)) return k;
      advance(search_line(island, epsilon));
      const double next = evaluate(island, epsilon, 0);
      if (next > 0.5 * size && size < 1e4 * rounding) return k;
      size = next;
    }
    return 100;
  }
  /// The same for the laws as they are: no convex function leads the way, the steps are halved until F
  /// falls.
  int polish(Island<T>& island, double epsilon) {
    laws.is_exact = true;
    double size = evaluate(island, epsilon, 0);
    const double rounding = reach(epsilon);
    int k = 0;
    for (; k < 30 && size > 4 * rounding && std::isfinite(size); ++k) {
      if (!find_direction(island)) break;
      const double start = size;
      advance(halve_step(size, 12, [&](double t) { return evaluate(island, epsilon, t); }));
      if (size > 0.99 * start) break;
    }
    laws.is_exact = false;
    return k;
  }
  /// Where points of contact are redundant and their gaps do not fit, λ drifts along a line that leaves the
  /// bodies alone, the same way at each proximal point, until a contact opens: goes `factor` times that way
  /// at once.
  void extrapolate(Island<T>& island, double factor) {
    T next[most_rows];
    for (const Constraint& c : constraints_) {
      for (int k = 0; k < c.rows; ++k) next[k] = T(lambda[c.at + k] + factor * (lambda[c.at + k] - centre[c.at + k]));
      island.clamp(*c.span, c.item, next);
      island.assign(*c.span, c.item, next);
    }
    restart(island);
  }
  /// Begins anew from the λ that the rows have, with its slips unless those stay.
  void restart(Island<T>& island, bool keeps_slips = false) {
    Base::restart(island);
    begin(keeps_slips);
  }
  /// λ̂ ← λ(u), s ← |u_t| unless the slips stay.
  void recentre(bool keeps_slips = false) {
    Base::recentre();
    begin(keeps_slips);
  }
  /// λ ← 0; the slips stay.
  void forget(Island<T>& island) {
    island.clear();
    restart(island, true);
  }
  /// What the proximal point leaves of the convex problem, √Σ |ε w (λ − λ̂)|²/w against √Σ |u|²/w.
  double distance(double epsilon) const {
    double left = 0, whole = 0;
    for (const Constraint& c : constraints_) {
      for (Index k = c.at; k < c.at + c.rows; ++k) left += weight[k] * (lambda[k] - centre[k]) * (lambda[k] - centre[k]);
      whole += over_weights(c, &velocity[c.at]);
    }
    return epsilon * std::sqrt(left / whole);
  }

  /// How far the slips of the rows' λ are from those given, √Σ (|u_t| − s)²/w against √Σ |u|²/w.
  double slip_change(Island<T>& island) const {
    double moved = 0, whole = 0;
    T numbers[most_rows];
    double u[most_rows];
    for (const Constraint& c : constraints_) {
      island.velocity(*c.span, c.item, numbers);
      for (int k = 0; k < c.rows; ++k) u[k] = double(numbers[k]);
      const double apart = slip_of(c, u) - laws.slip[std::size_t(c.number)];
      moved += apart * apart / weight[c.at];
      whole += over_weights(c, u);
    }
    return std::sqrt(moved / whole);
  }

  /// Of λ(u), by W itself.
  Measure measure(Island<T>& island) {
    hand_over(island, lambda);
    return island.measure();
  }
  void mark(const Island<T>& island) {
    for (const Constraint& c : constraints_)
      for (int k = 0; k < c.rows; ++k) before[c.at + k] = double(island.impulse(*c.span, c.item)[k]);
  }

  Array<double> before;  ///< by row: λ that a polish began with

 private:
  void begin(bool keeps_slips) {
    total_.assign(total_.size(), 0.0);
    if (keeps_slips) return;
    for (const Constraint& c : constraints_) laws.slip[std::size_t(c.number)] = slip_of(c, &velocity[c.at]);
  }

  /// What rounding leaves of |F|: of u, which ε magnifies, and of λ.
  double reach(double epsilon) const {
    double speeds = 0, impulses = 0;
    for (const Constraint& c : constraints_) {
      speeds += over_weights(c, &velocity[c.at]);
      for (Index k = c.at; k < c.at + c.rows; ++k) impulses += centre[k] * centre[k] * weight[k];
    }
    return std::numeric_limits<double>::epsilon() * (std::sqrt(speeds) / epsilon + std::sqrt(impulses));
  }

  static double slip_of(const Constraint& c, const double* u) {
    const RowKind* kinds = Island<T>::kinds(*c.span);
    double square = 0;
    for (int k = 0; k < c.rows; ++k)
      if (kinds[k] == RowKind::friction) square += u[k] * u[k];
    return std::sqrt(square);
  }

  /// J δ = −F, and the impulses of δ: G step = δ with step = −(total − λ + λ̂) − S H δ.
  bool find_direction(Island<T>& island) {
    if (!Base::find_direction(island)) return false;
    double Sm[most_rows];
    for (const Constraint& c : constraints_) {
      std::fill(Sm, Sm + c.rows, 0.0);
      add_product(c.rows, c.rows, 1, &slope[c.slope], &move[c.at], Sm);
      for (int k = 0; k < c.rows; ++k) step_[c.at + k] = lambda[c.at + k] - centre[c.at + k] - total_[c.at + k] - Sm[k];
    }
    return true;
  }

  /// dΦ/dt along δ at y + t δ: Σ step·H F.
  double slope_along(Island<T>& island, double epsilon, double t) {
    evaluate(island, epsilon, t);
    double sum = 0;
    for (std::size_t k = 0; k < step_.size(); ++k) sum += step_[k] * error[k];
    return sum;
  }

  /// The t in (0, 1] where Φ is least along δ, to a tenth of its slope.
  double search_line(Island<T>& island, double epsilon) {
    const double start = slope_along(island, epsilon, 0);
    double low = 0, high = 1, at_low = start, t = 1;
    double now = slope_along(island, epsilon, 1), at_high = now;
    if (!(now > 0.1 * std::abs(start))) return 1;
    for (int k = 0; k < 40; ++k) {
      t = low + (high - low) * std::clamp(at_low / (at_low - at_high), 0.05, 0.95);
      if (k % 3 == 2) t = 0.5 * (low + high);
      now = slope_along(island, epsilon, t);
      if (std::abs(now) <= 0.1 * std::abs(start)) break;
      (now > 0 ? high : low) = t;
      (now > 0 ? at_high : at_low) = now;
    }
    return t;
  }

  void advance(double t) {
    Base::advance(t);
    for (std::size_t k = 0; k < total_.size(); ++k) total_[k] += t * step_[k];
  }

  Array<double> total_, step_;  ///< by row, impulses of which y and δ are the velocities: y = G `total`, δ = G `step`
};

}  // namespace delassus::inner
