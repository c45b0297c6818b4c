/// Orders of the stages: collisions first, prediction, substeps, joint by joint; and the midpoint rule.
#include <delassus/bodies/anchor_at.hpp>
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/constraints/contact/penalty.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/constraints/joints/hinge.hpp>
#include <delassus/constraints/joints/limit.hpp>
#include <delassus/integrators/implicit_midpoint.hpp>
#include <delassus/schemes/collisions_first.hpp>
#include <delassus/schemes/joint_by_joint.hpp>
#include <delassus/schemes/predictive_scheme.hpp>
#include <delassus/schemes/substeps.hpp>

#include "scenes.hpp"
#include "trace.hpp"

using namespace trace;

namespace {

auto predicting() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.4}}, BallJoint{}},
                       PredictiveScheme{}};
}
auto in_parts() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.4}}, BallJoint{}},
                       Substeps{3}};
}
auto pushed_apart() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Penalty{Coulomb{.friction = 0.4}, 1e4, 20}}},
                       CollisionsFirst{}};
}
auto joint_by_joint() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{BallJoint{}}, JointByJoint{.sweeps = 4}};
}
auto midpoint_stop() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Hinge{}, Limit<Turn>{}}, ImplicitMidpoint{},
                       AcceleratedGaussSeidel{.tolerance = 1e-10}};
}
auto hold(auto& loop) {
  return [&loop](const Anchor& a, const Anchor& b) { loop.add(BallJoint::Item{a, b}); };
}
/// A chain of two beside what tumbles, which hits it.
auto with_chain(auto loop) {
  add_tumble(loop);
  add_chain(loop, 2, 1.2, hold(loop));
  return loop;
}

}  // namespace

int main(int argc, char** argv) {
  Trace all("schemes");
  const Options faces{.h = 0.01, .is_redundant = true};
  all.add("predictive", faces, [] { return with_chain(predicting()); });
  all.add(
      "substeps", faces, [] { return with_chain(in_parts()); },
      [](auto& loop, int n) {
        rigid_of(loop).apply_force(rigid_of(loop).handle(2), {0, std::sin(0.3 * n), 0});
      });
  all.add("collisions_first_penalty", {.h = 0.002}, [] {
    auto loop = pushed_apart();
    add_balls(loop);
    return loop;
  });
  all.add("joint_by_joint", {.h = 0.01, .change = 0.2}, [] {
    auto loop = joint_by_joint();
    add_chain(loop, 3, 0, hold(loop));
    return loop;
  });
  all.add("midpoint_stop", {.h = 0.01}, [] {
    auto loop = midpoint_stop();
    auto& set = rigid_of(loop);
    const Quat axis = frame_along({0, -1, 0});
    const auto arm = set.add({.position = {0.5, 0, 0}, .mass = 1.0, .shape = Box{1, 0.1, 0.1}});
    const Anchor a = world_anchor({0, 0, 0}, axis), b = anchor_at(set, arm, {0, 0, 0}, axis);
    loop.add(Hinge::Item{a, b});
    loop.add(Limit<Turn>::Item{.a = a, .b = b, .lower = -0.6, .upper = 0.2, .restitution = 0.6});
    return loop;
  });
  return all.main(argc, argv);
}
