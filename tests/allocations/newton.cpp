#include "allocations/count_allocations.hpp"

#include "allocations/allocation_scenes.hpp"
#include "solvers/knotted_rope.hpp"

#include <delassus/solvers/direct_gauss_seidel.hpp>
#include <delassus/solvers/proximal_newton.hpp>
#include <delassus/steppers/newton_midpoint.hpp>

TEST_CASE("a warm step of a standing stack with a pendulum beside it allocates nothing under Newton's method") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}}, ProximalNewton{}};
  auto& set = rigid_bodies(loop);
  add_stack(set, 10, Box{1, 1, 1});
  const auto rod = set.add({.position = {3, 0, 5}, .velocity = {1, 0, 0}, .mass = 0.2, .shape = Box{0.1, 0.1, 2}});
  loop.add(BallJoint::Item{anchor(set, rod, {0, 0, 1}), world_anchor({3, 0, 6})});
  REQUIRE(allocations_of(loop, 100, 1000) == 0);
}

TEST_CASE("a warm step that the default solver ends by Newton's method allocates nothing") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}};
  auto& set = rigid_bodies(loop);
  add_stack(set, 10, Box{1, 1, 1});
  set.add({.position = {0, 0, 10.5}, .mass = 1e3, .shape = Box{1, 1, 1}});
  REQUIRE(allocations_of(loop, 100, 1) == 0);
  int by_newton = 0;  // two steps of three
  for (int n = 0; n < 300; ++n) {
    REQUIRE(allocations_of(loop, 0, 1) == 0);
    REQUIRE(loop.island_reports().size() == 1);
    by_newton += loop.island_reports()[0].factorizations > 0;
  }
  REQUIRE(by_newton > 100);
}

TEST_CASE("a warm step that ends at its deadline, in the midst of a sweep or of Newton's method, allocates nothing") {
  double time = 0;
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     WithDeadline{AcceleratedGaussSeidel{.tolerance = 1e-14}, 1e9, ScriptedClock{&time, 1}}};
  add_stack(rigid_bodies(loop), 40, Box{1, 1, 1});
  REQUIRE(allocations_of(loop, 10, 1) == 0);
  for (int n = 0; n < 300; ++n) {
    loop.template policy<role::Solver>().budget = 20 + 3 * n;
    REQUIRE(allocations_of(loop, 0, 1) == 0);
  }
}

// What is freed at the end of a solve would be time after its deadline.
TEST_CASE("a problem solved in a workspace that has seen one like it allocates nothing, before a deadline either") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}};
  add_stack(rigid_bodies(loop), 40, Box{1, 1, 1});
  loop.step(1.0 / 60);
  auto start = loop.problem();
  for (auto& lambda : start.rows.pool<0>().lambda) lambda.setZero();
  const AcceleratedGaussSeidel solver{.tolerance = 1e-12};
  using Problem = decltype(start);
  SolverWorkspace<Problem, AcceleratedGaussSeidel> workspace;
  SolverWorkspace<Problem, WithDeadline<AcceleratedGaussSeidel, ScriptedClock>> timed;
  for (int n = 0; n < 60; ++n) {
    Problem p = start, q = start;
    double time = 0;
    const long before = allocations;
    Eigen::internal::set_is_malloc_allowed(n == 0);
    const SolveReport whole = solve(p, solver, workspace);
    const SolveReport cut = solve_until(q, solver, n == 0 ? 1e300 : 10.0 * n, timed, ScriptedClock{&time, 1});
    Eigen::internal::set_is_malloc_allowed(true);
    const long made = allocations - before;
    CAPTURE(n, cut.sweeps, cut.factorizations);
    REQUIRE(whole.factorizations > 0);
    REQUIRE((made == 0) == (n > 0));
  }
}

TEST_CASE("a warm step of a chain that lies on the ground allocates nothing under the direct path") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}}, DirectGaussSeidel{}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  RigidBodies::Handle last;
  for (int k = 0; k < 6; ++k) {
    const auto link = set.add({.position = {0.5 * k, 0, 0.1}, .mass = 1.0, .shape = Box{0.4, 0.2, 0.2}});
    if (k > 0) loop.add(BallJoint::Item{anchor(set, last, {0.25, 0, 0}), anchor(set, link, {-0.25, 0, 0})});
    last = link;
  }
  REQUIRE(allocations_of(loop, 100, 1000) == 0);
}

TEST_CASE("a warm step of a tight knot, whose contacts jam, allocates nothing under the direct path") {
  auto loop = knotted_rope::rope(DirectGaussSeidel{.tolerance = 1e-6});
  for (int n = 0; n < knotted_rope::tight; ++n) knotted_rope::sink(loop);
  int by_newton = 0;
  for (int n = 0; n < 300; ++n) {
    const long before = allocations;
    knotted_rope::sink(loop);
    REQUIRE(allocations == before);
    by_newton += loop.island_reports()[0].factorizations > 1;
  }
  REQUIRE(by_newton > 10);
}

TEST_CASE("a warm step of a swinging chain allocates nothing under the midpoint rule by Newton's method") {
  REQUIRE(allocations_of_swinging_chain(NewtonMidpoint{}) == 0);
}

TEST_CASE("a warm step of a chain drawn straight, whose rows yield, allocates nothing under the midpoint rule by Newton's method") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, NewtonMidpoint{}};
  auto& set = rigid_bodies(loop);
  Anchor end = world_anchor({0, 0, 0});
  for (int k = 0; k < 3; ++k) {
    const auto rod = set.add({.position = {k + 0.5, 0, 0}, .mass = 1.0, .shape = Box{1, 0.1, 0.1}});
    loop.add(BallJoint::Item{end, anchor(set, rod, {-0.5, 0, 0})});
    end = anchor(set, rod, {0.5, 0, 0});
  }
  loop.add(BallJoint::Item{end, world_anchor({3, 0, 0})});
  REQUIRE(allocations_of(loop, 10, 100) == 0);
  REQUIRE(loop.report().status == Status::stalled);
}
