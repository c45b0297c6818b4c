// The direct path with a motor beside the joints.
#include "direct_tests.hpp"

namespace direct_motor_tests {

using namespace direct_tests;

// A load of 1000 times the jib's mass, lifted by a motor: the joints hold as well as their rows are solved.
TEST_CASE("a motor on a chain of hinges with a heavy end turns at its speed") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, BallJoint{}, Motor<Turn>{}},
                     DirectGaussSeidel{.tolerance = 1e-9}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const Quat axis = frame_along({0, -1, 0});
  const auto jib = rigid.add({.position = {1, 0, 0}, .mass = 1.0, .shape = Box{2, 0.1, 0.1}});
  const auto load = rigid.add({.position = {2, 0, -1}, .mass = 1000.0, .shape = Sphere{0.3}});
  const Anchor mast = world_anchor(Vec3::Zero(), axis), foot = anchor_at(rigid, jib, Vec3::Zero(), axis);
  loop.add(Hinge::Item{mast, foot});
  loop.add(BallJoint::Item{anchor_at(rigid, jib, {2, 0, 0}), anchor_at(rigid, load, {2, 0, 0})});
  loop.add(Motor<Turn>::Item{.a = mast, .b = foot, .speed = 0.1});
  for (int n = 0; n < 100; ++n) {
    const StepReport report = loop.step(1e-3);
    REQUIRE(report.status == Status::converged);
    // The measure is of the largest velocity, 1 m/s at most; the motor's row is one of nine.
    REQUIRE(std::abs(rigid.angular_velocity(jib).y() + 0.1) <= 1e-6);
  }
}

}  // namespace direct_motor_tests
