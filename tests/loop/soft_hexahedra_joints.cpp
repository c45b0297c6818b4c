// Joints at points inside of hexahedra.
#include <delassus/bodies/anchor_at.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/loop/animation_loop.hpp>

#include "catch.hpp"
#include "hexahedral_scenes.hpp"

namespace soft_hexahedra_joints_tests {

using namespace delassus;

TEST_CASE(
    "a ball that hangs on a point inside a hexahedron pulls with its weight when all has come to rest") {
  using Soft = HexahedralFem<Corotational>;
  AnimationLoop loop{World{RigidBodies{}, Soft{}}, Constraints{BallJoint{}},
                     ImplicitEuler{.rayleigh_mass = 2, .rayleigh_stiffness = 0.02},
                     AcceleratedGaussSeidel{.tolerance = 1e-12, .max_iterations = 5000}};
  auto& soft = bodies<Soft>(loop.world());
  auto& rigid = bodies<RigidBodies>(loop.world());
  const auto bar = soft.add({.mesh = hexahedral_box({1, 0.2, 0.2}, {5, 1, 1}), .elasticity = {.young = 3e5}});
  soft.fix(bar, [](const Vec3& x) { return x[0] < 1e-9; });
  const Vec3 place(0.47, 0.12, 0.05);
  const auto ball = rigid.add({.position = place + Vec3(0, 0, -0.3), .mass = 0.5, .shape = Sphere{0.1}});
  const auto joint = loop.add(BallJoint::Item{soft.anchor_at(bar, place), anchor_at(rigid, ball, place)});
  const double h = 0.01;
  for (int n = 0; n < 1500; ++n) REQUIRE(loop.step(h).status == Status::converged);
  // At rest from both sides: the ball's weight, and a bar bent in equilibrium with it, on its eight nodes. The
  // ball still swings, as a pendulum that implicit Euler alone damps, by ω² h/2 = 0.16/s: from the way of a
  // point that sinks by d = 4 mm on a bar of L = 0.5 m, d²/L of 0.3 m, 1e-4 of the weight, a tenth is left.
  CHECK((loop.impulse(joint) / h - Vec3(0, 0, -0.5 * 9.81)).norm() < 5e-5);
  CHECK(loop.report().max_joint_violation < 1e-10);
  CHECK(kinetic_energy(soft) < 1e-12);
  const Vec3 end = rigid.position(ball) + rigid.orientation(ball) * Vec3(0, 0, 0.3);
  CHECK(end[2] < place[2] - 0.001);
}

}  // namespace soft_hexahedra_joints_tests
