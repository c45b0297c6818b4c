#include "../../benchmarks/siconos/contacts_alone.hpp"

#include <delassus/bodies/anchor_at.hpp>
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/constraints/joints/hinge.hpp>
#include <delassus/constraints/joints/motor.hpp>
#include <delassus/io/problem_file.hpp>
#include <delassus/loop/animation_loop.hpp>
#include <delassus/solvers/accelerated_gauss_seidel.hpp>

#include "catch.hpp"

namespace contacts_alone_tests {

using namespace delassus;

namespace {

auto make_loop() {
  return AnimationLoop{World{RigidBodies{}},
                       Constraints{Contact{Coulomb{.friction = 0.4}}, BallJoint{}, Hinge{}, Motor<Turn>{}},
                       AcceleratedGaussSeidel{.tolerance = 1e-10, .max_iterations = 100000}};
}

/// Two balls on a ball joint on the ground, and an arm on a motor that pushes one of them along. Balls touch
/// in points, and no three of them in a ring: λ is unique. `hinges` are so many at one place.
auto pushed_balls(double cap, int hinges = 1) {
  auto loop = make_loop();
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(HalfSpace{});
  const auto ball = [&](const Vec3& at, double mass) {
    return set.add({.position = at, .mass = mass, .shape = Sphere{0.1}});
  };
  const auto first = ball({0, 0, 0.1}, 1), second = ball({0.3, 0.02, 0.1}, 2);
  loop.add(
      BallJoint::Item{anchor_at(set, first, {0.15, 0.01, 0.12}), anchor_at(set, second, {0.15, 0.01, 0.12})});
  const auto arm = set.add({.position = {0, -0.19, 0.12}, .mass = 0.5, .shape = Sphere{0.09}});
  const Vec3 pivot(-0.5, -0.19, 0.12);
  const Anchor end = world_anchor(pivot), other = anchor_at(set, arm, pivot);
  for (int k = 0; k < hinges; ++k) loop.add(Hinge::Item{end, other});
  loop.add(Motor<Turn>::Item{.a = end, .b = other, .speed = 0.6, .max_force = cap});
  for (int n = 0; n < 5; ++n) REQUIRE(loop.step(5e-3).status == Status::converged);
  return loop;
}

FrictionProblem problem_of(const auto& loop) {
  const auto from = loop.problem();
  return problems::contacts_alone(from);
}

}  // namespace

// What is left of either solve is 1e-10 of |u|, and the condition of three contacts of like masses is below
// 1e3.
TEST_CASE("contacts taken from a step with joints have the impulses of the loop") {
  for (const double cap : {2.0, 1e9}) {  // N·m: at its cap, and below it
    const auto loop = pushed_balls(cap);
    const FrictionProblem exported = problem_of(loop);
    FrictionProblem p = parse_problem(problem_text(exported), "text");
    REQUIRE(p.rows.pool<0>().items() == 3);
    REQUIRE(solve(p, AcceleratedGaussSeidel{.tolerance = 1e-10, .max_iterations = 100000}).status ==
            Status::converged);
    for (Index i = 0; i < 3; ++i) {
      const Vec3 &found = p.rows.pool<0>().lambda[i], &wanted = exported.rows.pool<0>().lambda[i];
      CAPTURE(cap, i, found.transpose(), wanted.transpose());
      CHECK(wanted.norm() > 1e-3);
      CHECK((found - wanted).norm() <= 1e-7 * wanted.norm());
    }
  }
}

TEST_CASE("joints that are there twice change no problem of the contacts") {
  const FrictionProblem once = problem_of(pushed_balls(1e9)), twice = problem_of(pushed_balls(1e9, 2));
  for (Index i = 0; i < 3; ++i) {
    CHECK((once.W.diagonal<0>(i) - twice.W.diagonal<0>(i)).norm() <= 1e-8 * once.W.diagonal<0>(i).norm());
    CHECK((once.rows.pool<0>().d[i] - twice.rows.pool<0>().d[i]).norm() <= 1e-6);
  }
}

TEST_CASE("without joints the problem is that of the loop, and symmetric to the bit") {
  auto loop = AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(HalfSpace{});
  for (int i = 0; i < 4; ++i)
    set.add({.position = {0.05 * i, 0, 0.5 + i}, .mass = 1.0, .shape = Box{1, 1, 1}});
  for (int n = 0; n < 3; ++n) loop.step(5e-3);
  const auto from = loop.problem();
  const FrictionProblem p = problems::contacts_alone(from), plain = friction_problem(from);
  CHECK(problem_text(p).starts_with("fcp 1 sym"));
  REQUIRE(p.rows.pool<0>().items() == plain.rows.pool<0>().items());
  const Index n = p.rows.pool<0>().items();
  REQUIRE(n == 16);
  for (Index i = 0; i < n; ++i) {
    CHECK(p.rows.pool<0>().d[i] == plain.rows.pool<0>().d[i]);
    CHECK(p.rows.pool<0>().lambda[i] == plain.rows.pool<0>().lambda[i]);
    CHECK((p.W.residual<0>(p.rows, i) - plain.W.residual<0>(plain.rows, i)).norm() < 1e-14);
  }
}

}  // namespace contacts_alone_tests
