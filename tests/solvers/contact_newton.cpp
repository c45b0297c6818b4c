#include <delassus/solvers/contact_newton.hpp>

#include "catch.hpp"
#include "scenes.hpp"
#include "towers.hpp"

namespace contact_newton_tests {

using namespace scenes;
using cold_problems::error;
using cold_problems::tower;

// Sweeps contract like r/(1 + r) there [solvers]: a hundred of them leave the error near one.
TEST_CASE(
    "Newton's method in contact space gets through mass ratios that sweeps do not, in a few factorizations") {
  for (const double heavy : {1e2, 1e4, 1e6}) {
    auto p = tower({1, heavy});
    const SolveReport r = solve(p, ContactNewton{.tolerance = 1e-9, .max_sweeps = 100});
    CAPTURE(heavy, r.factorizations, r.measure.residual);
    REQUIRE(r.status == Status::converged);
    REQUIRE(r.sweeps <= 100);
    REQUIRE(r.factorizations <= 30);
    REQUIRE(error(p) <= 1e-9);
  }
}

TEST_CASE("a tower of twelve redundant faces is met to 1e-10") {
  auto p = tower({1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1});
  const SolveReport r = solve(p, ContactNewton{.tolerance = 1e-10, .max_sweeps = 100});
  CAPTURE(r.factorizations, r.measure.residual);
  REQUIRE(r.status == Status::converged);
  REQUIRE(error(p) <= 1e-10);
  for (const Vec3& x : p.rows.pool<0>().lambda) {
    REQUIRE(x[0] >= 0);
    REQUIRE(x.tail<2>().norm() <= 0.5 * x[0] * (1 + 1e-14));
  }
}

TEST_CASE("what sweeps solve at once is never factored, and more rows than allowed are swept") {
  auto p = tower({1});
  const SolveReport easy = solve(p, ContactNewton{.tolerance = 1e-6});
  REQUIRE(easy.status == Status::converged);
  REQUIRE(easy.factorizations == 0);
  auto q = tower({1, 1e4});
  const SolveReport large = solve(q, ContactNewton{.tolerance = 1e-9, .max_sweeps = 300, .max_rows = 5});
  REQUIRE(large.factorizations == 0);
  REQUIRE(large.sweeps == 300);
}

// The chain of Newton steps ends at its limit; the best measured impulses are what is left.
TEST_CASE("with too few factorizations the best iterate is kept and the status says so") {
  double before = 2;
  for (const int limit : {0, 1, 4, 40}) {
    auto p = tower({1, 1e6});
    const SolveReport r =
        solve(p, ContactNewton{.tolerance = 1e-9, .max_iterations = limit, .max_sweeps = 100});
    REQUIRE(r.factorizations <= limit);
    REQUIRE(error(p) == Approx(r.measure.residual).epsilon(1e-6).margin(1e-12));
    REQUIRE(error(p) <= before * (1 + 1e-9));
    before = error(p);
  }
  REQUIRE(before <= 1e-9);
}

TEST_CASE("velocities 1024 times larger or smaller change no bit of the impulses") {
  auto usual = tower({1, 1e4});
  const ContactNewton solver{.tolerance = 1e-9, .max_sweeps = 100};
  REQUIRE(solve(usual, solver).factorizations > 0);
  for (const double factor : {1024.0, 1 / 1024.0}) {
    auto other = tower({1, 1e4});
    for (Vec3& d : other.rows.pool<0>().d) d *= factor;
    solve(other, solver);
    CAPTURE(factor);
    const auto &a = usual.rows.pool<0>().lambda, &b = other.rows.pool<0>().lambda;
    for (std::size_t i = 0; i < a.size(); ++i) REQUIRE(Vec3(factor * a[i]) == b[i]);
  }
}

TEST_CASE("a number of the contact-space Newton solver that cannot be is refused in one sentence") {
  REQUIRE_THROWS_WITH(ContactNewton{.tolerance = -1}.check(), Catch::Contains("ContactNewton: tolerance -1"));
  REQUIRE_THROWS_WITH(ContactNewton{.first_sweeps = 0}.check(),
                      Catch::Contains("first_sweeps 0 must be >= 1"));
  REQUIRE_THROWS_WITH((ContactNewton{.first_sweeps = 9, .max_sweeps = 8}.check()),
                      Catch::Contains("max_sweeps 8"));
}

}  // namespace contact_newton_tests
