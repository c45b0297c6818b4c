/// One island as a convex function of the velocities of its bodies.
#pragma once

#include <delassus/rows/row_kind.hpp>
#include <delassus/solvers/inner/body_space.hpp>
#include <delassus/solvers/inner/halve_step.hpp>
#include <delassus/solvers/inner/whole_system.hpp>
#include <delassus/solvers/measure.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace delassus::inner {

template <int R>
struct ConvexItem : NewtonItem<R> {
  Vec<R> before;       ///< λ that a polish began with
  Vec<R> total, step;  ///< impulses of which y and δ are the velocities: y = G `total`, δ = G `step`
  double slip;         ///< |u_t| that the problem is given
  bool is_exact;       ///< S and λ(u) are those of the law as it is, with the slip that u has

  template <int p, class Problem>
  Mat<R, R> slope_at(const Problem& problem, Local<R>& local) const {
    if (is_exact) return problem.book().template tangent<p>(this->item, local);
    return problem.book().template convex_tangent<p>(this->item, local, slip);
  }
};

/// With the slips s_i = |u_t| given, Coulomb's law is the normality law of its cone for u + μ s e_n, and the
/// velocities of the bodies are the minimum of a convex function; its proximal point around λ̂ is that of
///
///   Φ(y) = ½ yᵀ A y + Σ ½ |λ_i(u_i)|²_{R + ε w},   ∇Φ = A F,   F(y) = y − G (λ(u) − λ̂),   u = d + W λ̂ + H y.
template <class Rows>
class ConvexSpace : public BodySpace<Rows, WholeSystem<ConvexItem, Rows>> {
  using Base = BodySpace<Rows, WholeSystem<ConvexItem, Rows>>;
  using T = typename Rows::Scalar;

 public:
  using Base::evaluate, Base::hand_over;

  template <class Problem>
  bool gather(Problem& problem) {
    if (!Base::gather(problem)) return false;
    each(problem, [&](auto p, auto& c, auto&) {
      c.slip = slip_of<Problem, p>(c.velocity);
      c.is_exact = false;
    });
    begin(problem, false);
    return true;
  }

  /// One proximal point, as sharp as rounding lets it be.
  int descend(auto& problem, double epsilon) {
    double size = evaluate(problem, epsilon, 0);
    const double rounding = reach(problem, epsilon);
    for (int k = 0; k < 100; ++k) {
      if (!(size > 4 * rounding) || !std::isfinite(size) || !find_direction(problem)) return k;
      advance(problem, search_line(problem, epsilon));
      const double next = evaluate(problem, epsilon, 0);
      if (next > 0.5 * size && size < 1e4 * rounding) return k;
      size = next;
    }
    return 100;
  }
  /// The same for the laws as they are: no convex function leads the way, the steps are halved until F
  /// falls.
  int polish(auto& problem, double epsilon) {
    each(problem, [](auto, auto& c, auto&) { c.is_exact = true; });
    double size = evaluate(problem, epsilon, 0);
    const double rounding = reach(problem, epsilon);
    int k = 0;
    for (; k < 30 && size > 4 * rounding && std::isfinite(size); ++k) {
      if (!find_direction(problem)) break;
      const double before = size;
      advance(problem, halve_step(size, 12, [&](double t) { return evaluate(problem, epsilon, t); }));
      if (size > 0.99 * before) break;
    }
    each(problem, [](auto, auto& c, auto&) { c.is_exact = false; });
    return k;
  }
  /// Where points of contact are redundant and their gaps do not fit, λ drifts along a line that leaves the
  /// bodies alone, the same way at each proximal point, until a contact opens: goes `factor` times that way
  /// at once.
  void extrapolate(auto& problem, double factor) {
    each(problem, [&](auto p, auto& c, auto&) {
      Vec<Rows::template rows_of<p>, T> next = (c.lambda + factor * (c.lambda - c.centre)).template cast<T>();
      problem.book().template clamp<p>(c.item, next);
      problem.template assign<p>(c.item, next);
    });
    restart(problem);
  }
  /// Begins anew from the λ that the rows have, with its slips unless those stay.
  void restart(auto& problem, bool keeps_slips = false) {
    Base::restart(problem);
    begin(problem, keeps_slips);
  }
  /// λ̂ ← λ(u), s ← |u_t| unless the slips stay.
  void recentre(auto& problem, bool keeps_slips = false) {
    Base::recentre(problem);
    begin(problem, keeps_slips);
  }
  /// λ ← 0; the slips stay.
  void forget(auto& problem) {
    hand_over(problem, [](const auto& c) { return (0 * c.lambda).eval(); });
    restart(problem, true);
  }
  /// What the proximal point leaves of the convex problem, √Σ |ε w (λ − λ̂)|²/w against √Σ |u|²/w.
  double distance(auto& problem, double epsilon) {
    double left = 0, whole = 0;
    each(problem, [&](auto, auto& c, auto&) {
      left += c.weight * (c.lambda - c.centre).squaredNorm();
      whole += c.velocity.squaredNorm() / c.weight;
    });
    return epsilon * std::sqrt(left / whole);
  }

  /// How far the slips of the rows' λ are from those given, √Σ (|u_t| − s)²/w against √Σ |u|²/w.
  template <class Problem>
  double slip_change(Problem& problem) {
    double change = 0, whole = 0;
    each(problem, [&](auto p, auto& c, auto&) {
      const Vec<Rows::template rows_of<p>> u = problem.template local<p>(c.item).d.template cast<double>();
      const double slip = slip_of<Problem, p>(u);
      change += (slip - c.slip) * (slip - c.slip) / c.weight;
      whole += u.squaredNorm() / c.weight;
    });
    return std::sqrt(change / whole);
  }

  /// Of λ(u), by W itself.
  Measure measure(auto& problem) {
    hand_over(problem, [](const auto& c) { return c.lambda; });
    return problem.measure();
  }
  void mark(auto& problem) {
    each(problem, [&](auto p, auto& c, auto&) {
      c.before = problem.rows().template pool<p>().lambda[c.item].template cast<double>();
    });
  }

 private:
  using Base::each, Base::advance;

  template <class Problem>
  void begin(Problem& problem, bool keeps_slips) {
    each(problem, [&](auto p, auto& c, auto&) {
      c.total.setZero();
      if (!keeps_slips) c.slip = slip_of<Problem, p>(c.velocity);
    });
  }

  /// What rounding leaves of |F|: of u, which ε magnifies, and of λ.
  double reach(auto& problem, double epsilon) {
    double velocity = 0, impulse = 0;
    each(problem, [&](auto, auto& c, auto&) {
      velocity += c.velocity.squaredNorm() / c.weight;
      impulse += c.centre.squaredNorm() * c.weight;
    });
    return std::numeric_limits<double>::epsilon() * (std::sqrt(velocity) / epsilon + std::sqrt(impulse));
  }

  template <class Problem, int p, int R>
  static double slip_of(const Vec<R>& u) {
    constexpr auto kinds = Problem::BookType::template kinds<p>();
    double square = 0;
    for (int k = 0; k < R; ++k)
      if (kinds[k] == RowKind::friction) square += u[k] * u[k];
    return std::sqrt(square);
  }

  /// J δ = −F, and the impulses of δ: G step = δ with step = −(total − λ + λ̂) − S H δ.
  bool find_direction(auto& problem) {
    if (!Base::find_direction(problem)) return false;
    each(problem,
         [](auto, auto& c, auto&) { c.step = c.lambda - c.centre - c.total - c.slope * c.move; });
    return true;
  }

  /// dΦ/dt along δ at y + t δ: Σ step·H F.
  double slope(auto& problem, double epsilon, double t) {
    evaluate(problem, epsilon, t);
    double sum = 0;
    each(problem, [&](auto, auto& c, auto&) { sum += c.step.dot(c.error); });
    return sum;
  }

  /// The t in (0, 1] where Φ is least along δ, to a tenth of its slope.
  double search_line(auto& problem, double epsilon) {
    const double start = slope(problem, epsilon, 0);
    double low = 0, high = 1, at_low = start, t = 1;
    double now = slope(problem, epsilon, 1), at_high = now;
    if (!(now > 0.1 * std::abs(start))) return 1;
    for (int k = 0; k < 40; ++k) {
      t = low + (high - low) * std::clamp(at_low / (at_low - at_high), 0.05, 0.95);
      if (k % 3 == 2) t = 0.5 * (low + high);
      now = slope(problem, epsilon, t);
      if (std::abs(now) <= 0.1 * std::abs(start)) break;
      (now > 0 ? high : low) = t;
      (now > 0 ? at_high : at_low) = now;
    }
    return t;
  }

  void advance(auto& problem, double t) {
    Base::advance(problem, t);
    each(problem, [&](auto, auto& c, auto&) { c.total += t * c.step; });
  }
};

}  // namespace delassus::inner
