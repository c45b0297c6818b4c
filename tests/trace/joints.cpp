/// Joints: chains and closed loops with the direct solver, a hinge at its stop, a motor.
#include <delassus/bodies/anchor_at.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/constraints/joints/hinge.hpp>
#include <delassus/constraints/joints/limit.hpp>
#include <delassus/constraints/joints/motor.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

#include "scenes.hpp"
#include "trace.hpp"

using namespace trace;

namespace {

auto machine() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Hinge{}, Limit<Turn>{}, Motor<Turn>{}}};
}
auto direct() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{BallJoint{}}, DirectGaussSeidel{.tolerance = 1e-10}};
}
auto ball_joints(auto& loop) {
  return [&loop](const Anchor& a, const Anchor& b) { loop.add(BallJoint::Item{a, b}); };
}

}  // namespace

int main(int argc, char** argv) {
  Trace all("joints");
  all.add("chain", {.h = 0.01, .change = 0.3}, [] {
    auto loop = direct();
    add_chain(loop, 4, 0, ball_joints(loop), 50);
    return loop;
  });
  // Both ends of the last bar are held, and a second joint holds one of them again.
  all.add("closed_loop_held_twice", {.h = 0.01, .is_redundant = true}, [] {
    auto loop = direct();
    add_chain(loop, 3, 0, ball_joints(loop));
    auto& set = rigid_of(loop);
    for (int k = 0; k < 2; ++k)
      loop.add(BallJoint::Item{anchor_at(set, set.handle(2), {1.5, 0, 0}), world_anchor({1.5, 0, 0})});
    set.set_velocity(set.handle(1), {0, 0.5, 2});
    return loop;
  });
  // An arm falls on its stop and comes back, another is turned by a motor that is too weak at first.
  all.add(
      "stop_and_motor", {.h = 0.01},
      [] {
        auto loop = machine();
        auto& set = rigid_of(loop);
        const Quat axis = frame_along({0, -1, 0});
        for (int k = 0; k < 2; ++k) {
          const Vec3 foot(0, k, 0);
          const auto arm =
              set.add({.position = foot + Vec3(0.5, 0, 0), .mass = 1.0 + k, .shape = Box{1, 0.1, 0.1}});
          const Anchor a = world_anchor(foot, axis), b = anchor_at(set, arm, foot, axis);
          loop.add(Hinge::Item{a, b});
          if (k == 0)
            loop.add(Limit<Turn>::Item{.a = a, .b = b, .lower = -0.6, .upper = 0.2, .restitution = 0.5});
          if (k == 1) loop.add(Motor<Turn>::Item{.a = a, .b = b, .speed = 3, .max_force = 15});
        }
        return loop;
      },
      [](auto& loop, int n) {
        loop.item(loop.template constraint<Motor<Turn>>(0)).max_force = n < 60 ? 5 : 30;
      });
  // A joint goes while the loop runs.
  all.add(
      "chain_is_cut", {.h = 0.01},
      [] {
        auto loop = direct();
        add_chain(loop, 3, 0.3, ball_joints(loop));
        return loop;
      },
      [](auto& loop, int n) {
        if (n == 15) loop.remove(loop.template constraint<BallJoint>(1));
      });
  return all.main(argc, argv);
}
