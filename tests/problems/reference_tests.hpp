/// What the tests of the reference check share: scenes of the demonstration, and what agreement means.
#pragma once

#include <delassus/delassus.hpp>
#include <delassus/io/checkpoint.hpp>
#include <delassus/problems/reference_check.hpp>

#include "catch.hpp"

#include <algorithm>
#include <initializer_list>

namespace reference_tests {

using namespace delassus;

inline auto contact_loop(double friction, double margin = NativeCollision{}.margin, double tolerance = 1e-6) {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = friction}}},
                       NativeCollision{.margin = margin}, AcceleratedGaussSeidel{.tolerance = tolerance}};
}

/// Solves the loop's last problem by Gauss-Seidel to 1e-10 and compares. Two residuals of 1e-10, relative to
/// √n times velocities of at most 10 m/s, leave the velocities apart by that and a factor for the problem's
/// conditioning: of order N² for N bodies on each other.
template <class Loop>
void compare(Loop& loop) {
  auto problem = loop.problem();
  const SolveReport r = solve(problem, AcceleratedGaussSeidel{.tolerance = 1e-10, .max_iterations = 20000});
  const ReferenceCheck check = check_against_reference(problem);
  INFO(check.text());
  CHECK(r.status == Status::converged);
  CHECK(!check.constraints.empty());
  CHECK(check.reached);
  CHECK(check.residual <= 1e-10);
  CHECK(check.reference.measure.residual <= 1e-10);
  CHECK(check.velocity <= 1e-6);
}

template <class Loop>
void run(Loop& loop, double h, int steps) {
  for (int n = 0; n < steps; ++n) loop.step(h);
}

template <class Loop>
void compare(Loop& loop, double h, int steps) {
  run(loop, h, steps);
  compare(loop);
}

/// At `steps`, ascending: the reference gets to its 1e-10 at each. Gauss-Seidel's velocities are off by its
/// own residual, to the same factor; not where friction wedges bodies, which then move by what no law asks
/// about.
template <class Loop>
void compare_at(Loop& loop, double h, std::initializer_list<int> steps, bool is_wedged = false) {
  int done = 0;
  for (const int step : steps) {
    run(loop, h, step - done);
    done = step;
    auto problem = loop.problem();
    solve(problem, AcceleratedGaussSeidel{.tolerance = 1e-10, .max_iterations = 20000});
    const ReferenceCheck check = check_against_reference(problem);
    CAPTURE(step, check.text());
    CHECK(check.reached);
    CHECK(check.reference.measure.residual <= 1e-10);
    if (!is_wedged) CHECK(check.velocity <= 1e4 * std::max(check.residual, 1e-10));
  }
}

}  // namespace reference_tests
