/// Gauss-Seidel sweeps with momentum, and what helps when they stall.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/solvers/inner/anderson.hpp>
#include <delassus/solvers/inner/compromise.hpp>
#include <delassus/solvers/inner/contradiction.hpp>
#include <delassus/solvers/inner/convergence_monitor.hpp>
#include <delassus/solvers/inner/extrapolate_to_cone_boundary.hpp>
#include <delassus/solvers/inner/momentum.hpp>
#include <delassus/solvers/inner/newton_stage.hpp>
#include <delassus/solvers/inner/settle_loads.hpp>
#include <delassus/solvers/island.hpp>
#include <delassus/solvers/solve_options.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <algorithm>
#include <cstddef>

namespace delassus {
namespace inner {

/// Room for accelerated sweeps.
template <class T, class Newton>
struct SweepSpace {
  Array<T> x, best;
  History history;
  SettleSpace<T> loads;
  [[no_unique_address]] Newton newton;
  void reset(Index rows) {
    const std::size_t room = std::size_t(rows);
    if (x.capacity() >= room && history.change_z[0].capacity() >= room) return;  // all grow together
    for (auto* impulses : {&x, &best}) impulses->reserve(room);
    history.each([room](Array<double>& v) { v.reserve(room); });
    loads.reserve(rows);
    newton.reserve(room);
  }
};

}  // namespace inner

/// Stages, each begun from the best measured impulses when the one before has stalled by the measured error.
///
///   Momentum:      Nesterov over exact sweeps. Ends nearly every solve.
///   Extrapolation: Where sweeps only drift along impulses that move nothing. To the end of that way, where a contact
///                  slips that had stuck, and momentum again.
///   Anderson:      Forty plain sweeps, then mixes the last five. Breaks limit cycles, and ends the few slow directions
///                  that a warm start leaves.
///   Momentum:      Again, with three times the patience, unless it went in circles.
///   Projection:    Nesterov over sweeps of one projection a visit. Slower, without the exact law's cycles.
///   Patient:       Momentum again, with ten times the patience.
///
/// Then from the start again with twice the patience. In the midst of momentum, as soon as the sweeps have cost what it
/// may, and now and then again, there is one more stage.
///
///   Newton:        In the velocities of the bodies, `inner::NewtonStage`. Ends what takes sweeps by the thousand, stacks
///                  and large ratios of masses.
///
/// That acts where every law of the island has a `tangent` and no springs under an implicit integrator couple its bodies.
/// Elsewhere, and where the problem has no bodies, there are sweeps alone. `SweepsAlone` in the place of `ThenNewton` has
/// sweeps alone everywhere. The best measured iterate is kept, and the report names the stage that ended the solve. A solve
/// that soon ends is in the first stage alone.
///
/// Rows that contradict each other let λ run away, which `inner::Contradiction` proves when momentum has stalled. The status
/// is `infeasible` then, and λ that of rows which yield by a tenth of their own W. That is a compromise, bounded, the same
/// whatever came before.
template <class Newton>
struct BasicAcceleratedGaussSeidel {
  using plays = role::Solver;
  double tolerance = 1e-6;       ///< of the criterion
  int max_iterations = 4000;     ///< sweeps; reaching it is a status
  int min_iterations = 1;        ///< sweeps even when the warm start is within the tolerance
  double relaxation = 1;         ///< ω in (0, 2) of each sweep
  bool scale_tolerance = false;  ///< tolerance × number of rows
  bool all_verified = false;     ///< every constraint's share below the tolerance, not the sum
  Criterion criterion = Criterion::residual;  ///< what the tolerance is compared with
  int share_loads_up_to = 16;  ///< contacts of an island whose loads are not left to chance; 0: of none

  static constexpr Needs needs = Newton::needs;
  template <class Rows>
  using Workspace =
      inner::SweepSpace<typename Rows::Scalar, typename Newton::template Space<typename Rows::Scalar, Rows::widest>>;

  SolveOptions options() const { return {tolerance, max_iterations, min_iterations, scale_tolerance, all_verified, criterion}; }
  void check() const {
    const auto name = [](const char* number) { return std::string(Newton::solver) + ": " + number; };
    if (!(tolerance >= 0)) inner::expect_at_least_zero(name("tolerance"), tolerance);
    if (!(max_iterations >= 0)) inner::expect_at_least_zero(name("max_iterations"), max_iterations);
    if (share_loads_up_to < 0) inner::expect_at_least_zero(name("share_loads_up_to"), share_loads_up_to);
    if (!(relaxation > 0 && relaxation < 2)) inner::expect_number(false, name("relaxation"), relaxation, "must lie in (0, 2)");
  }

  /// Sweeps in which the error must halve, at first. Momentum may stand for a thousand before it goes on:
  /// where it does not go round in circles it has three times as many once more, after the mixing.
  static int first_patience(int rows) { return std::clamp(3 * rows, 100, 400); }

  template <class T, class Space>
  SolveReport solve(Island<T>& problem, Space& work) const;

 private:
  /// What the stages have found, or what they find from loads that are shared.
  template <class T, class Space>
  [[gnu::always_inline]] SolveReport finish(auto& monitor, Island<T>& problem, Space& work) const {
    SolveReport report = monitor.finish();  // the only one that is returned, and so never copied
    if (share_loads_up_to > 0 && (work.loads.rounds > 0 || problem.row_count() >= inner::fewest_rows_of_loads))
      share_loads(report, problem, work);
    return report;
  }
  /// Solves again from loads that are shared, where they are left to chance; keeps what was before where that finds less.
  template <class T, class Space>
  void share_loads(SolveReport& report, Island<T>& problem, Space& work) const {
    inner::SettleSpace<T>& loads = work.loads;
    if (loads.rounds > 0 && report.status > loads.before.status) {
      problem.load(loads.solved_before);
      const int sweeps = report.sweeps;
      report = loads.before;
      report.are_loads_decided = false;
      report.sweeps = sweeps;
    } else if (report.sweeps < max_iterations &&
               inner::settle_loads(problem, loads, share_loads_up_to, options(), report)) {
      report = solve(problem, work);
      return;
    }
    loads.rounds = loads.sweeps = 0;
  }
  /// Plain sweeps, until what is left is a few slow directions or one circle, which five changes can tell. Of a rough start
  /// five changes tell nothing, and mixing at once may end none: therefore forty sweeps.
  static bool settle(auto& monitor, auto& problem, const SweepRule& rule) {
    for (int k = 0; k < 40; ++k)
      if (!monitor.goes_on(problem.sweep(rule))) return false;
    return true;
  }
  /// Whether there is time for the next stage.
  static bool open(auto& monitor, const char* name, int patience, bool from_best) {
    if (monitor.is_over()) return false;
    if (from_best) monitor.back_to_best();
    monitor.open(name, patience);
    return true;
  }
};

template <class Newton>
template <class T, class Space>
SolveReport BasicAcceleratedGaussSeidel<Newton>::solve(Island<T>& problem, Space& work) const {
  const SolveOptions limits = options();
  inner::ConvergenceMonitor<Island<T>, Array<T>> monitor(limits, problem, work.best, work.loads.sweeps);
  if (!monitor.begin()) return finish(monitor, problem, work);
  const SweepRule exact{.relaxation = relaxation, .tells_change = !limits.is_measured()}, projection{.projects = true};
  auto newton = Newton::stage(limits, problem, monitor, work.newton);
  const int shortest = first_patience(problem.row_count());
  for (int patience = shortest;; patience *= 2) {
    const bool is_again = patience > shortest;
    bool is_in_circles = false;
    for (int leaps = 0;; ++leaps) {
      is_in_circles = open(monitor, "momentum", patience, is_again) &&
                      inner::momentum(problem, monitor, work.x, exact, newton, "momentum");
      if (monitor.is_over()) return finish(monitor, problem, work);
      const inner::SlowDirection way = inner::find_slow_direction(problem, work.x);
      if (leaps == 3 || !inner::extrapolate_to_cone_boundary(problem, monitor, work.x, way, patience)) break;
    }
    if (inner::contradicts(problem, monitor, work.x))
      return inner::compromise(problem, monitor.finish(), work.best, work.x);
    if (open(monitor, "anderson", patience, true) && settle(monitor, problem, exact))
      inner::anderson(problem, monitor, work.history, exact);
    if (!is_in_circles && open(monitor, "momentum", 3 * patience, is_again))
      inner::momentum(problem, monitor, work.x, exact, newton, "momentum");
    if (open(monitor, "projection", 4 * patience, true))
      inner::momentum(problem, monitor, work.x, projection, newton, "projection");
    if (open(monitor, "patient", 10 * patience, true))
      inner::momentum(problem, monitor, work.x, exact, newton, "patient");
    if (monitor.is_over()) return finish(monitor, problem, work);
  }
}

/// Sweeps alone: less compiler memory than with Newton's method, and the same for what soon ends.
using AcceleratedSweeps = BasicAcceleratedGaussSeidel<SweepsAlone>;

namespace inner {

/// Sweeps to the tolerance of another solver, or to a share of it.
inline AcceleratedSweeps sweeps_of(const SolveOptions& solver, int most, int least, double share = 1) {
  return {.tolerance = share * solver.tolerance,
          .max_iterations = most,
          .min_iterations = least,
          .scale_tolerance = solver.scale_tolerance,
          .all_verified = solver.all_verified,
          .criterion = solver.criterion,
          .share_loads_up_to = 0};
}

}  // namespace inner

/// The default of a loop.
using AcceleratedGaussSeidel = BasicAcceleratedGaussSeidel<ThenNewton>;

}  // namespace delassus
