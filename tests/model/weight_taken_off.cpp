// Weight that a model takes off its bodies, beside the dynamics of its joint space.
#include "model/one_link.hpp"

#include <delassus/model/joint_space.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

#include "catch.hpp"

#include <vector>

namespace weight_taken_off_tests {

using namespace delassus;
using Catch::Contains;

namespace {

/// An arm about y that stands out along x, with a block fixed beside it, and a hand about x; each of another
/// share.
Model arm() {
  Model model = one_link();
  model.bodies[0].centre = {0.4, 0.1, 0}, model.bodies[0].gravity_compensation = 0.25;
  model::Body block;
  block.name = "block", block.parent = 0, block.pose.position = {0.2, 0, 0.3};
  block.mass = 3, block.centre = {0.1, 0, 0}, block.inertia = Vec3(0.1, 0.1, 0.1).asDiagonal();
  block.gravity_compensation = 1;
  model.bodies.push_back(block);
  model::Joint wrist;
  wrist.name = "wrist", wrist.axis = {1, 0, 0};
  model.joints.push_back(wrist);
  model::Body hand;
  hand.name = "hand", hand.parent = 1, hand.pose.position = {0.5, 0, 0};
  hand.mass = 1, hand.centre = {0, 0.3, 0}, hand.inertia = Vec3(0.05, 0.05, 0.05).asDiagonal();
  hand.gravity_compensation = -0.5;  // heavier than it is
  hand.joints = {1};
  model.bodies.push_back(hand);
  return model;
}

}  // namespace

// From rest a step of h gives the rates h a, and axes that turn by h² change them by the square of it.
TEST_CASE("actuate takes off weight as the joint space does") {
  const Model model = arm();
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}}, DirectGaussSeidel{.tolerance = 1e-13}};
  Machine machine = add(loop, model);
  REQUIRE(machine.left_out.size() == 1);
  CHECK_THAT(machine.left_out[0], Contains("weight of 2 of its bodies is taken off by actuate alone"));
  const double h = 1e-4;
  actuate(loop, machine, h), loop.step(h);
  JointSpace space(model);
  std::vector<double> q{0, 0}, v{0, 0}, none{0, 0}, a{0, 0}, whole{0, 0};
  space.forward_dynamics(q, v, none, a);
  space.forward_dynamics(q, v, none, whole, {.gravity_compensation = false});
  for (Index j = 0; j < 2; ++j) {
    CAPTURE(j);
    CHECK(rate_of(loop.world(), machine, j) / h == Approx(a[std::size_t(j)]).epsilon(1e-6));
    CHECK(std::abs(a[std::size_t(j)] - whole[std::size_t(j)]) > 1);
  }
}

TEST_CASE("a body without weight hovers as it turns") {
  Model model = one_link();
  model.joints[0].kind = model::JointKind::free;
  model.bodies[0].centre = {0.3, 0.2, 0.1}, model.bodies[0].gravity_compensation = 1;
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}}};
  Machine machine = add(loop, model);
  auto& set = bodies<RigidBodies>(loop.world());
  set.set_velocity(machine.parts[0].body, {0, 0, 0}, {1, 2, 3});
  const Vec3 start = set.position(machine.parts[0].body);
  for (int n = 0; n < 100; ++n) actuate(loop, machine, 1e-2), loop.step(1e-2);
  CHECK((set.position(machine.parts[0].body) - start).norm() < 1e-12);
  loop.remove(machine.parts[0].body);
  CHECK_THROWS_WITH(actuate(loop, machine, 1e-2), Contains("was removed"));
}

}  // namespace weight_taken_off_tests
