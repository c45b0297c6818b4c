/// The proximal point iteration on the impulses of an island, by Newton's method in the velocities of its
/// bodies.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/solvers/inner/halve_step.hpp>
#include <delassus/solvers/island.hpp>
#include <delassus/solvers/solve_options.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <algorithm>

namespace delassus::inner {

/// Outside λ̂ ← λ(u) while ε shrinks, inside Newton's method on F of `Body`, a `BodySpace` that holds the
/// island, each step halved until the rows see less of F. The options have the tolerance and how many
/// factorizations are allowed; the smallest measured error is kept in `Body`. See `ProximalNewton`.
template <class T, class Body>
class ProximalPoint {
 public:
  ProximalPoint(const SolveOptions& options, Island<T>& problem, Body& body)
      : options_(options), problem_(problem), body_(body), rows_(problem.row_count()) {}

  /// Around the λ that was gathered.
  Measure begin() {
    measure = best_ = body_.measure(problem_);
    least_ = centre_ = body_.last_error();
    if (epsilon == 0) epsilon = measure.residual > 1e-2 ? 1e-5 : 1e-7;  // a warm start needs no care
    return measure;
  }

  /// Until λ(u) meets the tolerance by the bodies' own velocities: true. False: stalled, or out of time.
  bool run() {
    while (has_time()) {
      const int before = factorizations;
      const bool is_well = descend();
      note();
      if (is_done(measure)) return true;
      if (!is_well || !(body_.last_error() < 1.5 * centre_)) {
        epsilon = std::min(20 * epsilon, 1.0);
        return false;
      }
      body_.recentre();
      shrink(factorizations - before);
      centre_ = body_.last_error();
    }
    return false;
  }

  /// The rows take λ(u); the measure by W itself tells whether it is one.
  bool is_met() {
    body_.hand_over(problem_, body_.lambda);
    measure = problem_.measure();
    return is_done(measure);
  }
  /// The rows take the λ of the smallest measured error.
  void restore_best() {
    body_.hand_over(problem_, body_.best);
  }

  /// Begins anew from the λ that the rows have; false when nothing can be begun from there.
  bool restart() {
    if (!body_.restart(problem_)) return false;
    measure = body_.measure(problem_);
    note();
    centre_ = body_.last_error();
    return true;
  }

  bool has_time() {
    if (std::max(factorizations, rounds_ - 1) >= options_.max_iterations) return false;
    if (factorizations >= std::max(1, options_.min_iterations))
      is_late_ = is_late_ || !problem_.has_time_for(work);
    return !is_late_;
  }
  bool is_late() const { return is_late_; }
  Island<T>& problem() const { return problem_; }
  int rows() const { return rows_; }
  bool is_done(const Measure& m) const {
    return options_.is_done(m, rows_);
  }

  int factorizations = 0, sweeps = 0;  ///< sweeps: what the observer is told beside them
  Measure measure{};                   ///< of the last λ
  double epsilon = 0;
  double work = 0;  ///< of a factorization, in sweeps: what a deadline must leave time for

 private:
  /// Newton's method around one λ̂, until F has fallen by 1e4 or λ(u) is good enough; false when it stalls.
  bool descend() {
    ++rounds_;
    double size = body_.evaluate(problem_, epsilon, 0);
    body_.close_what_touches(problem_, epsilon, body_.last_error());
    const double first = size;
    for (int step = 0; step < 8 && has_time(); ++step) {
      if (!(size > 0)) break;
      if (!body_.find_direction(problem_)) return false;
      ++factorizations;
      const double before = size;
      body_.advance(halve_step(size, 14, [&](double t) { return body_.evaluate(problem_, epsilon, t); }));
      measure = body_.measure(problem_);
      if (problem_.tells_forces()) body_.hand_over(problem_, body_.lambda);
      problem_.notify(sweeps + factorizations, measure);
      if (is_done(measure) || size < 1e-4 * first) break;
      if (!(size <= 0.99 * before)) return false;
    }
    measure = body_.measure(problem_);
    return std::isfinite(size);
  }

  /// ε for the next λ̂, after so many factorizations for the last. Where one was enough and yet λ has hardly
  /// come nearer, impulses go through what is light to what is heavy, and by 1/(1 + ε r) of their way, r the
  /// ratio of the masses: the error goes by ε/(1/r + ε) a time, and ε is made for 2e-4 of it.
  void shrink(int spent) {
    is_slow_ = is_slow_ || (spent == 1 && body_.last_error() > 0.5 * centre_);
    if (is_slow_)
      epsilon = std::clamp(2e-4 * centre_ / std::max(body_.last_error(), 1e-300) * epsilon, 1e-12, epsilon);
    else
      epsilon = std::max(0.01 * epsilon, 1e-10);
  }

  void note() {
    if (!(body_.last_error() < least_)) return;
    least_ = body_.last_error();
    best_ = measure;
    body_.keep();
  }

  const SolveOptions& options_;
  Island<T>& problem_;
  Body& body_;
  int rows_;
  Measure best_{};
  double least_ = 0, centre_ = 0;  ///< the errors of the best λ and of λ̂
  int rounds_ = 0;  ///< λ̂ so far: where F is nothing at once there is no factorization to count
  bool is_slow_ = false, is_late_ = false;
};

}  // namespace delassus::inner
