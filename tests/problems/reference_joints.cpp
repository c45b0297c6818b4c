// The reference check on joints, springs, bouncing and frictionless contacts.
#include "reference_tests.hpp"

#include "../examples/demonstration/hanging_chain.hpp"

namespace reference_joints_tests {

using namespace reference_tests;

TEST_CASE("a hanging chain agrees with the reference, and a wrong joint impulse in it is found and named") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, ImplicitMidpoint{},
                     PositionProjection{.rate = 1}, AcceleratedGaussSeidel{.tolerance = 1e-8}};
  demonstration::add_hanging_chain(loop);
  for (int k = 0; k < 3; ++k) compare(loop, 1.0 / 2400, 1 + 200 * k);

  auto problem = loop.problem();
  REQUIRE(solve(problem, AcceleratedGaussSeidel{.tolerance = 1e-10, .max_iterations = 20000}).status ==
          Status::converged);
  for (const Index wrong : {0, 7, 19}) {
    auto broken = problem;
    broken.rows.pool<0>().lambda[wrong] += Vec3(1e-3, 0, 0);
    const ReferenceCheck check = check_against_reference(broken);
    CHECK(check.reached);
    CHECK(check.constraints.front().item == wrong);
    // Without redundancy the impulses are unique.
    CHECK(check.constraints.front().impulse == Approx(1e-3).epsilon(1e-3));
  }
}

TEST_CASE("bouncing contacts, springs and joints in one island agree with the reference") {
  AnimationLoop loop{
      World{RigidBodies{}},
      Constraints{Contact{Restitution{Coulomb{.friction = 0.4}, 0.3}}, BallJoint{}, DistanceJoint{}},
      NativeCollision{}, AcceleratedGaussSeidel{.tolerance = 1e-8}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  const auto foot =
      rigid.add({.position = {0, 0, 0.5}, .velocity = {1, 0, -1}, .mass = 3.0, .shape = Box{1, 1, 1}});
  const auto arm = rigid.add({.position = {0.2, 0, 1.6}, .mass = 1.0, .shape = Box{0.2, 0.2, 1}});
  loop.add(BallJoint::Item{anchor(rigid, foot, {0.2, 0, 0.6}), anchor(rigid, arm, {0, 0, -0.5})});
  loop.add(DistanceJoint::Item{anchor(rigid, arm, {0, 0, 0.5}), world_anchor({1.8, 0, 3}), 1.5, 2000., 10.});
  compare(loop, 1.0 / 240, 1);
  compare(loop, 1.0 / 240, 10);
}

TEST_CASE("frictionless and penalty contacts agree with the reference") {
  const auto check = [](auto law) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{law}}, NativeCollision{}};
    auto& rigid = bodies<RigidBodies>(loop.world());
    rigid.add_fixed(HalfSpace{});
    rigid.add({.position = {0, 0, 0.5}, .velocity = {0.5, 0.2, -1}, .mass = 2.0, .shape = Box{1, 1, 1}});
    rigid.add({.position = {0.1, 0, 1.5}, .velocity = {-0.5, 0, -1}, .mass = 1.0, .shape = Box{1, 1, 1}});
    compare(loop, 1.0 / 240, 1);
  };
  check(Frictionless{});
  check(Penalty{Coulomb{.friction = 0.5}, 1e5, 50});
}

}  // namespace reference_joints_tests
