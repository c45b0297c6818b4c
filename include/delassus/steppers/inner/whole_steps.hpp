/// What integrators that make their whole step have in common.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/integrators/integrator.hpp>
#include <delassus/solvers/solve_report.hpp>
#include <delassus/step/notify.hpp>
#include <delassus/step/plain_step.hpp>
#include <delassus/step/warm_start.hpp>

#include <algorithm>
#include <string>
#include <type_traits>

namespace delassus::inner {

/// The numbers of a Newton's method, of the integrator `name`.
inline void check_newton(const std::string& name, double tolerance, int max_iterations) {
  DELASSUS_EXPECT(tolerance >= 0, name + ": tolerance " + text(tolerance) + " must be >= 0");
  DELASSUS_EXPECT(max_iterations > 0, name + ": max_iterations " + text(max_iterations) + " must be > 0");
}

/// Linearize to Correct by the state of the integrator, whose solve(world, laws, rows, integrator, h) leaves v_next and λ,
/// and returns a SolveReport.
void solve_at_once(auto& step) {
  auto& own = step.template state<role::Integrator>();
  each_pool(step.laws(), [&](auto, const auto& pool) {
    constexpr bool knows_rotors = requires { requires std::remove_cvref_t<decltype(step.integrator())>::knows_rotors; };
    constexpr bool is_rotor = requires { requires std::remove_cvref_t<decltype(pool.law)>::resists; };
    static_assert(knows_rotors || !is_rotor, "delassus: of the integrators that make a step at once NewtonMidpoint alone takes a RotorInertia; take it, or ImplicitMidpoint");
  });
  stage::linearize(step);
  if constexpr (std::remove_reference_t<decltype(step)>::has_constraints) {
    step.reports.assign(1, own.solve(step.world(), step.laws(), step.rows, step.integrator(), step.h));
    step.summary.status = worse(step.summary.status, step.reports[0].status);
    step.summary.residual = std::max(step.summary.residual, step.reports[0].measure.residual);
    step.summary.islands = 1;
    keep_impulses(step.pools.all(), step.arrays.all(), step.contact_cache);
  } else {
    typename std::remove_reference_t<decltype(step)>::Policies::Rows none;
    const SolveReport report = own.solve(step.world(), step.laws(), none, step.integrator(), step.h);
    step.summary.status = worse(step.summary.status, report.status);
  }
  notify<stage::Solve>(step);
  notify<stage::Correct>(step);
}

}  // namespace delassus::inner
