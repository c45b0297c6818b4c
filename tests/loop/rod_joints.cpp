// Rods on joints, and the exact W that holds them.
#include <delassus/bodies/anchor_at.hpp>
#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/constraints/joints/weld.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/loop/animation_loop.hpp>

#include "catch.hpp"
#include "rod_scenes.hpp"
#include "stages.hpp"

namespace rod_joints_tests {

using namespace delassus;
using namespace rod_scenes;

TEST_CASE("a rod welded to a rigid arm turns with it, and hangs at its own length from a ball joint") {
  AnimationLoop loop{World{RigidBodies{}, Rods{}}, Constraints{Weld{}, BallJoint{}},
                     ImplicitEuler{.rayleigh_mass = 3}};
  auto& rods = bodies<Rods>(loop.world());
  auto& rigid = bodies<RigidBodies>(loop.world());
  const auto arm =
      rigid.add({.position = {-0.1, 0, 0}, .shape = Box{0.2, 0.05, 0.05}, .motion = Motion::kinematic});
  const auto rod = rods.add(
      {.points = straight_line({0, 0, 0}, {0.5, 0, 0}, 10), .section = round_section(0.004), .young = 2e9});
  loop.add(Weld::Item{anchor_at(rigid, arm, Vec3(0, 0, 0)), anchor(rods, rods.node(rod, 0))});
  const auto bob =
      rigid.add({.position = {0.25, 0, -0.1}, .mass = 0.2, .inertia = 1e-4 * Mat3(Mat3::Identity())});
  const auto hook =
      loop.add(BallJoint::Item{rods.anchor_at(rod, {0.27, 0, 0}), anchor_at(rigid, bob, Vec3(0.27, 0, 0))});
  const double h = 0.01;
  for (int n = 0; n < 200; ++n) {
    const double angle = 0.5 * std::min(1.0, n * h);
    const Quat turn = exponential<double>(Vec3(0, 0, angle));
    rigid.move_to(arm, turn * Vec3(-0.1, 0, 0), turn);
    loop.step(h);
    REQUIRE(loop.report().status == Status::converged);
  }
  for (int n = 0; n < 800; ++n) loop.step(h);
  const auto base = rods.node(rod, 0);
  CHECK(rods.position(base).norm() < 1e-5);
  CHECK(logarithm<double>(rods.orientation(base).conjugate() * exponential<double>(Vec3(0, 0, 0.5))).norm() <
        1e-4);
  CHECK(std::abs(std::abs(loop.impulse(hook)[2]) / h - 0.2 * 9.81) < 1e-3);  // what hangs there, at rest
  CHECK(rods.position(rods.node(rod, 10))[2] < -0.01);
}

TEST_CASE("W of a rod's joints is H A^-1 H^T of a dense A, and the corrective motion is W lambda") {
  AnimationLoop loop{World{Rods{}}, Constraints{BallJoint{}}, ImplicitEuler{}};
  auto& rods = bodies<Rods>(loop.world());
  const auto rod = rods.add(bent_rod());
  rods.fix(rods.node(rod, 0));
  loop.add(BallJoint::Item{anchor(rods, rods.node(rod, 3), {0.01, 0, 0}),
                           world_anchor(rods.position(rods.node(rod, 3)))});
  const Vec3 between = 0.5 * Vec3(rods.position(rods.node(rod, 5)) + rods.position(rods.node(rod, 6)));
  loop.add(BallJoint::Item{rods.anchor_at(rod, between), world_anchor(between)});
  for (int n = 0; n < 10; ++n) loop.step(0.01);
  stage::begin(loop.data(), 0.01);
  linearize_to_build(loop.data());
  const auto problem = loop.problem();
  const auto& pool = problem.rows.template pool<0>();
  const auto& set = inner::part<0>(pool.sets);
  const auto W = problem.W.template blocks<0, 0>();
  double worst = 0, size = 0;
  for (Index j = 0; j < 2; ++j)
    for (int l = 0; l < 3; ++l) {
      std::vector<Vec<6>> x(rods.blocks(), Vec<6>::Zero());
      for (Index e = set.offset[j]; e < set.offset[j + 1]; ++e)
        for (int k = 0; k < 6; ++k) x[set.block[e]][k] += set.H[e](l, k);
      rods.solve(x);
      for (Index i = 0; i < 2; ++i)
        for (int k = 0; k < 3; ++k) {
          double full = 0;
          for (Index e = set.offset[i]; e < set.offset[i + 1]; ++e)
            for (int c = 0; c < 6; ++c) full += set.H[e](k, c) * x[set.block[e]][c];
          const double ours = i == j ? problem.W.template diagonal<0>(i)(k, l) : W.block[W.start[i]](k, l);
          worst = std::max(worst, std::abs(ours - full));
          size = std::max(size, std::abs(full));
        }
    }
  CHECK(size > 0);
  CHECK(worst < 1e-10 * size);
  CHECK(W.block.size() == 2);  // A couples the two
}

}  // namespace rod_joints_tests
