/// What the tests of `PathNewton` share, with bodies and without.
#pragma once

#include <delassus/solvers/path_newton.hpp>

#include "catch.hpp"
#include "towers.hpp"

namespace path_tests {

using namespace delassus;

using cold_problems::error;

inline constexpr PathNewton path_alone{.tolerance = 1e-7, .max_sweeps = 0};

/// λ meets the laws, and lies in the cone to rounding.
template <class Problem>
void check_solved(Problem& p, const SolveReport& r) {
  CAPTURE(r.factorizations, r.measure.residual);
  REQUIRE(r.status == Status::converged);
  REQUIRE(r.sweeps == 0);
  REQUIRE(r.factorizations > 2);
  REQUIRE(error(p) <= 1e-7);
  REQUIRE(error(p) >= 0);
  for (const Vec3& x : p.rows.template pool<0>().lambda) {
    REQUIRE(x[0] >= 0);
    REQUIRE(x.tail<2>().norm() <= 0.5 * x[0] * (1 + 1e-12) + 1e-15);
  }
}

}  // namespace path_tests
