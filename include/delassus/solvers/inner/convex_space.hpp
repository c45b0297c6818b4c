/// One island as a convex function of the velocities of its bodies.
#pragma once

#include <delassus/rows/local.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/solvers/inner/newton_item.hpp>
#include <delassus/solvers/inner/whole_system.hpp>
#include <delassus/solvers/measure.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace delassus::inner {

template <int R>
struct ConvexItem : NewtonItem<R> {
  Vec<R> before;       ///< λ that a polish began with
  Vec<R> total, step;  ///< impulses of which y and δ are the velocities: y = G `total`, δ = G `step`
  double slip;         ///< |u_t| that the problem is given
};

/// With the slips s_i = |u_t| given, Coulomb's law is the normality law of its cone for u + μ s e_n, and the
/// velocities of the bodies are the minimum of a convex function; its proximal point around λ̂ is that of
///
///   Φ(y) = ½ yᵀ A y + Σ ½ |λ_i(u_i)|²_{R + ε w},   ∇Φ = A F,   F(y) = y − G (λ(u) − λ̂),   u = d + W λ̂ + H y.
template <class Rows>
class ConvexSpace {
 public:
  using System = WholeSystem<ConvexItem, Rows>;
  using T = typename Rows::Scalar;

  template <class Problem>
  bool gather(Problem& problem) {
    if (!system_.gather(problem)) return false;
    for (auto* array : {&y_, &change_, &residual_}) array->assign(system_.blocks(), Velocity::Zero());
    each([&](auto p, auto& c, auto&) {
      c.total.setZero();
      c.step.setZero();
      c.slip = slip_of<Problem, p>(c.velocity);
    });
    return true;
  }

  /// One proximal point, as sharp as rounding lets it be.
  template <class Problem>
  int descend(const Problem& problem, double epsilon) {
    double size = evaluate(problem, epsilon, 0);
    const double rounding = reach(epsilon);
    for (int k = 0; k < 100; ++k) {
      if (!(size > 4 * rounding) || !std::isfinite(size) || !find_direction()) return k;
      const double fraction = search_line(problem, epsilon);
      advance(fraction);
      const double next = evaluate(problem, epsilon, 0);
      if (next > 0.5 * size && size < 1e4 * rounding) return k;
      size = next;
    }
    return 100;
  }
  /// The same for the laws as they are: no convex function leads the way, the steps are halved until F
  /// falls.
  template <class Problem>
  int polish(const Problem& problem, double epsilon) {
    is_exact_ = true;
    double size = evaluate(problem, epsilon, 0);
    const double rounding = reach(epsilon);
    int k = 0;
    for (; k < 30 && size > 4 * rounding && std::isfinite(size); ++k) {
      if (!find_direction()) break;
      double t = 1, least = size, best = 0, next = size;
      for (int halving = 0; halving < 12; ++halving, t *= 0.5) {
        next = evaluate(problem, epsilon, t);
        if (next < least) least = next, best = t;
        if (next <= (1 - 1e-3 * t) * size) break;
      }
      advance(best);
      next = evaluate(problem, epsilon, 0);
      if (next > 0.99 * size) break;
      size = next;
    }
    is_exact_ = false;
    return k;
  }
  /// Where points of contact are redundant and their gaps do not fit, λ drifts along a line that leaves the
  /// bodies alone, the same way at each proximal point, until a contact opens: goes `factor` times that way
  /// at once.
  template <class Problem>
  void extrapolate(Problem& problem, double factor) {
    each([&](auto p, auto& c, auto&) {
      Vec<Rows::template rows_of<p>, T> next = (c.lambda + factor * (c.lambda - c.centre)).template cast<T>();
      problem.book().template clamp<p>(c.item, next);
      problem.template assign<p>(c.item, next);
    });
    restart(problem);
  }
  /// Begins anew from the λ that the rows have, with its slips unless those stay.
  template <class Problem>
  void restart(const Problem& problem, bool keeps_slips = false) {
    each([&](auto p, auto& c, auto&) {
      const auto local = problem.template local<p>(c.item);
      c.centre = c.lambda = local.lambda.template cast<double>();
      c.velocity = local.d.template cast<double>();
      c.total.setZero();
      if (!keeps_slips) c.slip = slip_of<Problem, p>(c.velocity);
    });
    for (auto* array : {&y_, &change_})
      for (auto& x : *array) x.setZero();
  }
  /// What rounding leaves of |F|: of u, which ε magnifies, and of λ.
  double reach(double epsilon) {
    double velocity = 0, impulse = 0;
    each([&](auto, auto& c, auto&) {
      velocity += c.velocity.squaredNorm() / c.weight;
      impulse += c.centre.squaredNorm() * c.weight;
    });
    return std::numeric_limits<double>::epsilon() * (std::sqrt(velocity) / epsilon + std::sqrt(impulse));
  }

  /// λ̂ ← λ(u), s ← |u_t| unless the slips stay.
  template <class Problem>
  void recentre(bool keeps_slips = false) {
    each([&](auto p, auto& c, auto&) {
      c.velocity += -c.error + c.move + c.compliance.cwiseProduct(c.lambda - c.centre);
      c.centre = c.lambda;
      c.total.setZero();
      if (!keeps_slips) c.slip = slip_of<Problem, p>(c.velocity);
    });
    for (auto& y : y_) y.setZero();
  }
  /// λ ← 0; the slips stay.
  template <class Problem>
  void forget(Problem& problem) {
    each([&](auto p, auto& c, auto&) {
      problem.template assign<p>(c.item, 0 * problem.rows().template pool<p>().lambda[c.item]);
    });
    each([&](auto p, auto& c, auto&) {
      c.centre.setZero();
      c.velocity = problem.template local<p>(c.item).d.template cast<double>();
    });
  }
  /// What the proximal point leaves of the convex problem, √Σ |ε w (λ − λ̂)|²/w against √Σ |u|²/w.
  double distance(double epsilon) {
    double left = 0, whole = 0;
    each([&](auto, auto& c, auto&) {
      left += c.weight * (c.lambda - c.centre).squaredNorm();
      whole += c.velocity.squaredNorm() / c.weight;
    });
    return epsilon * std::sqrt(left / whole);
  }

  /// How far the slips of the rows' λ are from those given, √Σ (|u_t| − s)²/w against √Σ |u|²/w.
  template <class Problem>
  double slip_change(const Problem& problem) {
    double change = 0, whole = 0;
    each([&](auto p, auto& c, auto&) {
      const Vec<Rows::template rows_of<p>> u = problem.template local<p>(c.item).d.template cast<double>();
      const double slip = slip_of<Problem, p>(u);
      change += (slip - c.slip) * (slip - c.slip) / c.weight;
      whole += u.squaredNorm() / c.weight;
    });
    return std::sqrt(change / whole);
  }

  template <class Problem>
  Measure measure(Problem& problem) {
    each([&](auto p, auto& c, auto&) { problem.template assign<p>(c.item, c.lambda.template cast<T>()); });
    return problem.measure();
  }
  template <class Problem>
  void keep(Problem& problem) {
    each([&](auto p, auto& c, auto&) {
      c.best = problem.rows().template pool<p>().lambda[c.item].template cast<double>();
    });
  }
  template <class Problem, class Which>
  void hand_over(Problem& problem, const Which& which) {
    each([&](auto p, auto& c, auto&) { problem.template assign<p>(c.item, which(c).template cast<T>()); });
  }
  template <class Problem>
  void mark(Problem& problem) {
    each([&](auto p, auto& c, auto&) {
      c.before = problem.rows().template pool<p>().lambda[c.item].template cast<double>();
    });
  }

 private:
  using Velocity = typename System::Velocities::value_type;

  template <class F>
  void each(F&& f) {
    system_.each(f);
  }

  template <class Problem, int p, int R>
  static double slip_of(const Vec<R>& u) {
    constexpr auto kinds = Problem::BookType::template kinds<p>();
    double square = 0;
    for (int k = 0; k < R; ++k)
      if (kinds[k] == RowKind::friction) square += u[k] * u[k];
    return std::sqrt(square);
  }

  /// λ(u), S and F at y + t δ; returns √Σ |H F|²/w.
  template <class Problem>
  double evaluate(const Problem& problem, double epsilon, double t) {
    for (std::size_t b = 0; b < residual_.size(); ++b) residual_[b] = y_[b] + t * change_[b];
    each([&](auto p, auto& c, auto& sides) {
      constexpr int R = Rows::template rows_of<p>;
      c.trial = c.velocity;
      for (Index s = c.first; s < c.last; ++s)
        c.trial.noalias() += sides[s].H * (y_[sides[s].block] + t * change_[sides[s].block]);
      Local<R> local{Mat<R, R>::Zero(), c.trial, c.centre};
      local.W.diagonal() = c.compliance.array() + epsilon * c.weight;
      c.slope = is_exact_ ? problem.book().template tangent<p>(c.item, local)
                          : problem.book().template convex_tangent<p>(c.item, local, c.slip);
      c.lambda = local.lambda;
    });
    each([&](auto, auto& c, auto& sides) {
      const auto push = (c.lambda - c.centre).eval();
      for (Index s = c.first; s < c.last; ++s) residual_[sides[s].block].noalias() -= sides[s].G * push;
    });
    double square = 0;
    each([&](auto, auto& c, auto& sides) {
      c.error.setZero();
      for (Index s = c.first; s < c.last; ++s) c.error.noalias() += sides[s].H * residual_[sides[s].block];
      c.move = c.trial - c.velocity;
      square += c.error.squaredNorm() / c.weight;
    });
    return std::sqrt(square);
  }

  /// J δ = −F, and the impulses of δ: G step = δ with step = −(total − λ + λ̂) − S H δ.
  bool find_direction() {
    if (!system_.factor()) return false;
    for (std::size_t b = 0; b < change_.size(); ++b) change_[b] = -residual_[b];
    system_.solve(change_);
    each([&](auto, auto& c, auto& sides) {
      auto move = c.move;
      move.setZero();
      for (Index s = c.first; s < c.last; ++s) move.noalias() += sides[s].H * change_[sides[s].block];
      c.step = c.lambda - c.centre - c.total - c.slope * move;
    });
    return true;
  }

  /// dΦ/dt along δ where F was evaluated last: Σ step·H F.
  double slope() {
    double sum = 0;
    each([&](auto, auto& c, auto&) { sum += c.step.dot(c.error); });
    return sum;
  }

  /// The t in (0, 1] where Φ is least along δ, to a tenth of its slope.
  template <class Problem>
  double search_line(const Problem& problem, double epsilon) {
    const double start = slope();
    double low = 0, high = 1, at_low = start, t = 1;
    evaluate(problem, epsilon, 1);
    double now = slope(), at_high = now;
    if (!(now > 0.1 * std::abs(start))) return 1;
    for (int k = 0; k < 40; ++k) {
      t = low + (high - low) * std::clamp(at_low / (at_low - at_high), 0.05, 0.95);
      if (k % 3 == 2) t = 0.5 * (low + high);
      evaluate(problem, epsilon, t);
      now = slope();
      if (std::abs(now) <= 0.1 * std::abs(start)) break;
      (now > 0 ? high : low) = t;
      (now > 0 ? at_high : at_low) = now;
    }
    return t;
  }

  void advance(double t) {
    for (std::size_t b = 0; b < y_.size(); ++b) y_[b] += t * change_[b], change_[b].setZero();
    each([&](auto, auto& c, auto&) { c.total += t * c.step; });
  }

  bool is_exact_ = false;
  System system_;
  typename System::Velocities y_, change_, residual_;
};

}  // namespace delassus::inner
