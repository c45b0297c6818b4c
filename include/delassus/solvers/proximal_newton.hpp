/// Newton's method in the velocities of the bodies, inside a proximal point iteration on the impulses.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/solvers/accelerated_gauss_seidel.hpp>
#include <delassus/solvers/inner/body_space.hpp>
#include <delassus/solvers/inner/proximal_point.hpp>
#include <delassus/solvers/island.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <algorithm>
#include <cstddef>

namespace delassus {

/// Outside, the proximal point: λ̂ ← λ, where λ meets the laws of d + W λ + ε w (λ − λ̂), w_i = tr(W_ii)/rows. (The number ε
/// shrinks by 0.01 a time, where that is slow by what it has to.) Inside, Newton's method for the velocities of the bodies
/// with F and J of `inner::BodySpace`, each step halved until the rows see less of F. At the fixed point nothing is left of
/// ε: The laws are met as they are, Coulomb's too.
///
/// The number of factorizations hardly grows with the height of a stack or the ratio of masses; one costs a few sweeps. Where
/// Newton's method stalls, accelerated sweeps lead on from the best λ. An island that it cannot treat is swept throughout, and
/// one that it did not bring to the tolerance is swept from its start. (It cannot treat a law without `tangent`, nor bodies
/// coupled by springs under an implicit integrator.) The smallest measured residual is what is kept. Source: [Rockafellar1976]
/// for the proximal point, [QiSun1993] for Newton's method on it, [AcaryBremondHuber2018] for both together,
/// [AlartCurnier1991] for the contact's equations.
struct ProximalNewton {
  using plays = role::Solver;
  double tolerance = 1e-8;       ///< of the criterion
  int max_iterations = 60;       ///< factorizations; then come the sweeps
  int min_iterations = 1;        ///< factorizations even when the warm start is within the tolerance
  int max_sweeps = 4000;         ///< in all, of an island where Newton's method stalls or cannot act
  bool scale_tolerance = false;  ///< tolerance × number of rows
  bool all_verified = false;     ///< every constraint's share below the tolerance, not the sum
  Criterion criterion = Criterion::residual;  ///< what the tolerance is compared with

  static constexpr Needs needs = Needs::tangents;
  /// What outlives a solve: room.
  template <class Rows>
  struct Workspace {
    using T = typename Rows::Scalar;  ///< scalar of W and λ
    static_assert(Rows::widest > 0,
                  "delassus: Newton's method needs the bodies of a problem, and this one, as a FrictionProblem, has W alone; "
                  "solve it by AcceleratedGaussSeidel");
    inner::BodySpace<T, inner::NewtonSystem<T, std::max(1, Rows::widest)>, inner::LawsAsTheyAre<T>> body;  ///< of the Newton steps
    AcceleratedSweeps::Workspace<Rows> sweeps;  ///< room of the sweeps where Newton's method does not act
    Array<T> start;  ///< λ from before the first step, or after sweeps that led on
    void reset(Index rows) {
      sweeps.reset(rows);
      start.reserve(std::size_t(rows));
    }
  };

  SolveOptions options() const { return {tolerance, max_iterations, min_iterations, scale_tolerance, all_verified, criterion}; }
  void check() const {
    inner::expect_at_least_zero("ProximalNewton: tolerance", tolerance);
    inner::expect_at_least_zero("ProximalNewton: max_iterations", max_iterations);
    inner::expect_at_least_zero("ProximalNewton: max_sweeps", max_sweeps);
    inner::expect_measured("ProximalNewton", criterion);
  }

  template <class T, class Space>
  SolveReport solve(Island<T>& problem, Space& work) const {
    problem.must_complete();  // what `body` has found since the last measure by W is the better λ
    if (!work.body.gather(problem)) return sweep(problem, work, max_sweeps, min_iterations);
    const SolveOptions limits = options();
    inner::ProximalPoint<T, decltype(work.body)> now(limits, problem, work.body);
    const Measure start = now.begin();
    problem.notify(0, start);
    if (!std::isfinite(start.residual)) return {.status = Status::quarantined, .measure = start};
    if (min_iterations == 0 && now.is_done(start)) return finish(now);
    problem.save(work.start);
    double allowed = 0;
    for (int patience = 20; now.has_time();) {
      if (now.run()) {
        if (now.is_met()) return finish(now);
      } else {
        now.restore_best();
        if (allowed == 0) allowed = largest_energy(problem, work);
        patience = std::min(2 * patience, max_sweeps - now.sweeps);
        if (patience <= 0 || !(problem.energy() <= allowed)) break;
        now.sweeps += sweep(problem, work, patience, 1).sweeps;
        if (problem.energy() <= allowed) problem.save(work.start);
      }
      if (!now.restart()) break;
      if (now.is_done(now.measure)) return finish(now);
    }
    return give_up(now, work);
  }

 private:
  /// Σ w_i |λ_i|² beyond which λ has run away along what moves nothing.
  static double largest_energy(auto& problem, auto& work) {
    return 100 * std::max(problem.energy(work.start), work.body.energy_of_stopping(problem));
  }

  /// The tolerance was not met: what is left of the sweeps leads on from the best λ. Where that has run away along what moves
  /// nothing, as in a wedge that jams, its loads are none: the sweeps lead on from the last λ that had not.
  SolveReport give_up(auto& now, auto& work) const {
    auto& problem = now.problem();
    now.restore_best();
    if (!(problem.energy() <= largest_energy(problem, work))) problem.load(work.start);
    const int left = max_sweeps - now.sweeps;
    if (!now.is_late() && left > 0) {
      const SolveReport swept = sweep(problem, work, left, 1);
      now.sweeps += swept.sweeps;
      now.measure = swept.measure;
      if (swept.status == Status::infeasible) return {swept.status, now.sweeps, now.measure, now.factorizations, swept.ended_by};
      return finish(now, swept.ended_by);
    }
    now.measure = problem.measure();
    return finish(now);
  }

  SolveReport sweep(auto& problem, auto& work, int most, int least) const {
    return inner::sweeps_of(options(), most, least).solve(problem, work.sweeps);
  }

  SolveReport finish(const auto& now, const char* stage = "newton") const {
    return {options().verdict(now.measure, now.rows()), now.sweeps, now.measure, now.factorizations, stage};
  }
};

}  // namespace delassus
