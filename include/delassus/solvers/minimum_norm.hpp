/// Of all impulses that make the same motion, the smallest.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/core/if_it_has.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/core/wrapping.hpp>
#include <delassus/solvers/solve_options.hpp>
#include <delassus/solvers/inner/least_impulses.hpp>
#include <delassus/solvers/island.hpp>
#include <delassus/solvers/solve_report.hpp>

namespace delassus {
namespace inner {

template <class T, class Space>
struct NormSpace {
  Space solver;
  LeastImpulsesSpace<T> least;
  void begin_step() { begin_step_if_it_can(solver); }
  void reset(Index rows) {
    reset_if_it_can(solver, rows);
    least.reserve(rows);
  }
};

/// When a solver, or the one it goes around, may stop; of one that does not say so, near the residual where it did.
SolveOptions limits_of(const auto& solver, const Measure& measure) {
  if constexpr (requires { solver.solver; }) return limits_of(solver.solver, measure);
  else if constexpr (requires { solver.options(); }) return solver.options();
  else return {.tolerance = 2 * measure.residual};
}

}  // namespace inner

/// `MinimumNorm{AcceleratedGaussSeidel{}}`: Where constraints are redundant λ is not unique. (A table on four legs, a door
/// on three hinges, a contact found twice.) Which one sweeps find depends on their order and start. After a solve that
/// converged this takes
///
///   λ = argmin Σ w_i |λ_i|²  with  W λ unchanged,   w_i = tr(W_ii)/rows.
///
/// It does so by conjugate gradients from zero on W λ = W λ*, which never leave the range of W. Equal legs carry equal loads,
/// and λ is as continuous in time as the motion is. Constraints that stand still are free in it, contacts that slip keep
/// their direction, what is open keeps its zero. Where a cone is in the way λ goes as far as it lets it, and on without the
/// constraint that is at its limit.
///
/// The motion is that of the solve, to its tolerance; otherwise λ* is kept. It costs a product with W for each of the distinct
/// eigenvalues of W, about. Source: [HestenesStiefel1952].
template <class Solver = inner::Absent>
struct MinimumNorm {
  using plays = role::Solver;
  static constexpr unsigned layers = inner::layers_of<Solver> | inner::layer::minimum_norm;
  Solver solver{};  ///< finds the motion
  int max_products = 200;  ///< with W; when they run out λ stays as it was solved

  static constexpr Needs needs = inner::needs_of<Solver>;
  template <class Rows>
  using Workspace = inner::NormSpace<typename Rows::Scalar, typename Solver::template Workspace<Rows>>;

  void check() const {
    solver.check();
    inner::expect_at_least_zero("MinimumNorm: max_products", max_products);
  }

  template <class T, class Space>
  SolveReport solve(Island<T>& problem, Space& work) const {
    SolveReport report = solver.solve(problem, work.solver);
    if (report.status > Status::stalled || problem.is_out_of_time()) return report;
    inner::LeastImpulses<T> least(problem, work.least);
    least.sort(report.measure);
    for (int round = 0; round < 4; ++round)
      if (!least.shrink(max_products)) break;
    if (least.keep(inner::limits_of(solver, report.measure), report)) report.are_loads_decided = true;
    return report;
  }
};

/// Around what is no solver, as in `MinimumNorm{1e-6}`, or another one; the loop's checks say so.
template <class Solver>
  requires(!inner::Fills<Solver, role::Solver, inner::layer::minimum_norm>)
struct MinimumNorm<Solver> : inner::Hollow {
  using plays = role::Solver;
  using inner::Hollow::Hollow;
};

/// `MinimumNorm{solver}`.
template <class Solver>
MinimumNorm(Solver) -> MinimumNorm<Solver>;
/// `MinimumNorm{solver, max_products}`.
template <class Solver>
MinimumNorm(Solver, int) -> MinimumNorm<Solver>;

}  // namespace delassus
