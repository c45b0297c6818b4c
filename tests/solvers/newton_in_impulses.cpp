#include <delassus/solvers/inner/newton_in_impulses.hpp>

#include "catch.hpp"
#include "scenes.hpp"
#include "towers.hpp"

namespace newton_in_impulses_tests {

using namespace scenes;
using cold_problems::error;
using cold_problems::tower;
using Newton = inner::NewtonInImpulses;

/// A hundred sweeps first, and all to 1e-9.
const Newton after_sweeps{{.tolerance = 1e-9, .max_iterations = 100}};

// Sweeps contract like r/(1 + r) there [solvers]: a hundred of them leave the error near one.
TEST_CASE(
    "Newton's method in contact space gets through mass ratios that sweeps do not, in a few factorizations") {
  for (const double heavy : {1e2, 1e4, 1e6}) {
    auto p = tower({1, heavy});
    const SolveReport r = solve(p, after_sweeps);
    CAPTURE(heavy, r.factorizations, r.measure.residual);
    REQUIRE(r.status == Status::converged);
    REQUIRE(r.sweeps <= 100);
    REQUIRE(r.factorizations <= 30);
    REQUIRE(error(p) <= 1e-9);
  }
}

TEST_CASE("a tower of twelve redundant faces is met to 1e-10") {
  auto p = tower({1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1});
  const SolveReport r = solve(p, Newton{{.tolerance = 1e-10, .max_iterations = 100}});
  CAPTURE(r.factorizations, r.measure.residual);
  REQUIRE(r.status == Status::converged);
  REQUIRE(error(p) <= 1e-10);
  for (const Vec3& x : p.rows.pool<0>().lambda) {
    REQUIRE(x[0] >= 0);
    REQUIRE(x.tail<2>().norm() <= 0.5 * x[0] * (1 + 1e-14));
  }
}

TEST_CASE("what sweeps solve at once is never factored") {
  auto p = tower({1});
  const SolveReport easy = solve(p, Newton{{.tolerance = 1e-6, .max_iterations = 100}});
  REQUIRE(easy.status == Status::converged);
  REQUIRE(easy.factorizations == 0);
}

// The chain of Newton steps ends at its limit; the best measured impulses are what is left.
TEST_CASE("with too few factorizations the best iterate is kept and the status says so") {
  double before = 2;
  for (const int limit : {0, 1, 4, 40}) {
    auto p = tower({1, 1e6});
    const SolveReport r = solve(p, Newton{after_sweeps.sweeps, limit});
    REQUIRE(r.factorizations <= limit);
    REQUIRE(error(p) == Approx(r.measure.residual).epsilon(1e-6).margin(1e-12));
    REQUIRE(error(p) <= before * (1 + 1e-9));
    before = error(p);
  }
  REQUIRE(before <= 1e-9);
}

TEST_CASE("velocities 1024 times larger or smaller change no bit of the impulses") {
  auto usual = tower({1, 1e4});
  REQUIRE(solve(usual, after_sweeps).factorizations > 0);
  for (const double factor : {1024.0, 1 / 1024.0}) {
    auto other = tower({1, 1e4});
    for (Vec3& d : other.rows.pool<0>().d) d *= factor;
    solve(other, after_sweeps);
    CAPTURE(factor);
    const auto &a = usual.rows.pool<0>().lambda, &b = other.rows.pool<0>().lambda;
    for (std::size_t i = 0; i < a.size(); ++i) REQUIRE(Vec3(factor * a[i]) == b[i]);
  }
}

}  // namespace newton_in_impulses_tests
