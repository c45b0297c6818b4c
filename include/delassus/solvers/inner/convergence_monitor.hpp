/// What the stages of one solve share: the count of sweeps, the best measured impulses, and when a stage has
/// stalled.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/solvers/solve_options.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <algorithm>
#include <limits>
#include <utility>

namespace delassus::inner {

/// Sweeps are counted and measured here; a stage asks after each of its sweeps whether to go on. A stage has
/// stalled when the best measured error did not halve within `patience` sweeps, or half as many as it took to
/// get there if that is more.
template <class Problem, class Impulses>
class ConvergenceMonitor {
 public:
  /// `sweeps` were made before, and count.
  ConvergenceMonitor(const SolveOptions& options, Problem& problem, Impulses& best, int sweeps = 0)
      : options_(options), problem_(problem), best_set_(best), rows_(problem.row_count()) {
    tolerance_ = options.tolerance * (options.scale_tolerance ? rows_ : 1);
    reach_ = near * tolerance_;
    report_.sweeps = sweeps;
  }

  /// False: there is nothing to sweep. The start itself is measured only where that can end the solve or
  /// somebody asks for every sweep: a measure costs about a sweep, and most warm starts are within the
  /// tolerance after their first.
  bool begin() {
    problem_.save(best_set_);
    if (options_.min_iterations > 0 && options_.max_iterations > 0 && !problem_.observes_sweeps())
      return true;
    report_.measure = best_ = problem_.measure();
    problem_.notify(0, report_.measure);
    if (is_not_finite()) return false;
    is_met_ = options_.min_iterations == 0 && is_done(best_);
    return !is_met_ && options_.max_iterations > 0;
  }

  void open(const char* stage, int patience) {
    report_.ended_by = stage;
    patience_ = patience;
    opened_ = progressed_ = report_.sweeps;
    mark_ = options_.error(best_);
  }

  /// After a sweep of the present stage that moved λ by `moved` in energy, λ being what it made: false when
  /// the stage, or the solve, is over.
  bool goes_on(double moved) {
    ++report_.sweeps;
    is_last_ = report_.sweeps >= options_.max_iterations ||
               (report_.sweeps >= options_.min_iterations && problem_.is_out_of_time());
    if (!is_last_ && !is_due(moved) && !problem_.is_measure_due()) return true;
    measured_ = report_.sweeps;
    report_.measure = problem_.measure();
    problem_.notify(report_.sweeps, report_.measure);
    if (std::isinf(best_.residual) && is_not_finite()) return false;
    is_met_ = report_.sweeps >= options_.min_iterations && is_done(report_.measure);
    if (is_met_) return false;
    per_root_of_movement_ = options_.error(report_.measure) / std::sqrt(moved);
    note_pace();
    keep_if_best();
    return !is_last_ && !stalls();
  }

  /// λ of a stage that makes factorizations and no sweeps, measured by W; kept if it is the best.
  void take(const Measure& measure, int factorizations) {
    report_.factorizations += factorizations;
    report_.measure = measure;
    is_met_ = report_.sweeps >= options_.min_iterations && is_done(measure);
    if (!is_met_) keep_if_best();
  }
  /// The stage goes on, or another name is in it for a while: its patience does not begin anew.
  void name(const char* stage) { report_.ended_by = stage; }

  /// The best error did not halve within 60 sweeps, or half as many as it took to get there: a stage that has
  /// another sign of going round in circles need not wait for the end of its patience.
  bool is_stagnating() const {
    return options_.is_measured() &&
           report_.sweeps - progressed_ > std::max(60, (progressed_ - opened_) / 2);
  }

  /// Whether the last sweep was measured, for the criterion.
  [[gnu::always_inline]] bool is_measured_now() const { return measured_ == report_.sweeps && options_.is_measured(); }
  /// That of the last measure, and what it is compared with.
  [[gnu::always_inline]] double error() const { return options_.error(report_.measure); }
  [[gnu::always_inline]] double tolerance() const { return tolerance_; }
  /// The stage may stand so many times as long.
  [[gnu::always_inline]] void give_patience(int times) { patience_ *= times; }

  /// The tolerance is met, or no sweep is left.
  bool is_over() const { return is_met_ || is_last_ || is_quarantined(); }
  bool is_quarantined() const { return report_.status == Status::quarantined; }

  int sweeps() const { return report_.sweeps; }
  /// After the first sweep.
  double first_error() const { return first_error_; }
  /// The smallest measure so far.
  const Measure& best() const { return best_; }
  /// Sweeps to the tolerance at the pace of the last half of them or more; infinite where the error stands.
  double likely_left() const {
    const double now = options_.error(report_.measure), fallen = std::log(from_.error / now);
    return fallen > 0 ? std::log(now / tolerance_) * (measured_ - from_.sweeps) / fallen : infinity;
  }
  /// What is left of the sweeps.
  int left() const { return options_.max_iterations - report_.sweeps; }

  /// λ as it was at the beginning stays known, in this room.
  void keep_start_in(Impulses& room) { start_ = &room; }
  const Impulses& start() const { return has_improved_ ? *start_ : best_set_; }

  /// λ ← the best measured.
  void back_to_best() { problem_.load(best_set_); }

  SolveReport finish() {
    if (is_quarantined()) return report_;
    if (!is_met_) {
      if (report_.sweeps > 0) back_to_best();
      report_.measure = best_;
    }
    report_.status = options_.verdict(report_.measure, rows_);
    return report_;
  }

 private:
  /// A first measure that is no number: the start stays as it was, and the island is told apart.
  bool is_not_finite() {
    if (std::isfinite(report_.measure.residual)) return false;
    report_.status = Status::quarantined;
    if (report_.sweeps > 0) back_to_best();
    return true;
  }
  bool is_done(const Measure& m) const { return options_.is_done(m, rows_); }
  void note_pace() {
    if (lately_.sweeps == 0) first_error_ = options_.error(report_.measure);
    if (measured_ < 2 * lately_.sweeps) return;
    from_ = lately_;
    lately_ = {options_.error(report_.measure), measured_};
  }
  void keep_if_best() {
    if (!(options_.is_measured() ? options_.error(report_.measure) < options_.error(best_)
                                   : report_.measure.residual < best_.residual))
      return;
    best_ = report_.measure;
    if (start_ && !has_improved_) std::swap(*start_, best_set_), has_improved_ = true;
    problem_.save(best_set_);
    if (!(options_.error(best_) < 0.5 * mark_)) return;
    mark_ = options_.error(best_);
    progressed_ = report_.sweeps;
  }
  /// The error is foretold from the sweep's movement, their ratio being that of the last measure: where that
  /// is within the tolerance it is time to measure, and no later than after twice the usual number of sweeps,
  /// but for the first few where ten times the tolerance is not in sight: a measure costs about a sweep, and
  /// small problems end after ten.
  bool is_due(double moved) const {
    if (problem_.observes_sweeps() || !options_.is_measured() || measured_ == 0) return true;
    const double foretold = per_root_of_movement_ * std::sqrt(moved);
    if (foretold <= reach_) return true;
    const bool is_late = report_.sweeps - measured_ >= 2 * inner::patience(report_.sweeps);
    return is_late && (report_.sweeps >= 7 || foretold <= 10 * reach_);
  }
  bool stalls() const {
    return options_.is_measured() &&
           report_.sweeps - progressed_ > std::max(patience_, (progressed_ - opened_) / 2);
  }

  /// Of the tolerance, at which an error foretold is worth a measure. A measure mends the ratio, so that an
  /// error that stays a little above the tolerance is not measured again in every sweep.
  static constexpr double near = 1.05;
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  static constexpr Measure unmeasured{.residual = infinity, .siconos = infinity, .worst = infinity};

  const SolveOptions options_;
  Problem& problem_;
  Impulses& best_set_;
  Impulses* start_ = nullptr;
  SolveReport report_{};
  Measure best_ = unmeasured;
  int rows_, measured_ = 0, patience_ = 0, opened_ = 0, progressed_ = 0;
  double mark_ = infinity, per_root_of_movement_ = infinity, tolerance_, reach_, first_error_ = infinity;
  struct Mark {
    double error;
    int sweeps;
  } from_{infinity, 0}, lately_{infinity, 0};  ///< measures, at less than half of the sweeps and later
  bool is_met_ = false, is_last_ = false, has_improved_ = false;
};

}  // namespace delassus::inner
