/// Positions projected after the step, the midpoint rule, and restitution between them.
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/constraints/contact/penalty.hpp>
#include <delassus/constraints/contact/restitution.hpp>
#include <delassus/constraints/contact/sequential_restitution.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/integrators/implicit_midpoint.hpp>
#include <delassus/schemes/collisions_first.hpp>
#include <delassus/schemes/substeps.hpp>
#include <delassus/stabilisation/position_projection.hpp>

#include "scenes.hpp"
#include "trace.hpp"

using namespace trace;

namespace {

auto projected() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.4}}, BallJoint{}},
                       PositionProjection{.rate = 0.5}};
}
auto midpoint_projected() {
  return AnimationLoop{World{RigidBodies{}},
                       Constraints{Contact{Restitution{Coulomb{.friction = 0.3}, 0.5}}, BallJoint{}},
                       ImplicitMidpoint{}, PositionProjection{}};
}
auto in_turn() {
  return AnimationLoop{World{RigidBodies{}},
                       Constraints{Contact{SequentialRestitution{Coulomb{.friction = 0.3}, 0.9}}}};
}
auto springs_in_parts() {
  return AnimationLoop{World{RigidBodies{}},
                       Constraints{Contact{Penalty{Coulomb{.friction = 0.4}, 1e4, 20, AtMean{}}}},
                       ImplicitMidpoint{}, PositionProjection{}};
}
auto first_of_all() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.4}}},
                       CollisionsFirst{}};
}
auto hold(auto& loop) {
  return [&loop](const Anchor& a, const Anchor& b) { loop.add(BallJoint::Item{a, b}); };
}
auto with_chain(auto loop) {
  add_tumble(loop);
  add_chain(loop, 2, 1.2, hold(loop));
  return loop;
}

}  // namespace

int main(int argc, char** argv) {
  Trace all("schemes_more");
  const Options faces{.h = 0.01, .is_redundant = true};
  all.add("projection", faces, [] { return with_chain(projected()); });
  all.add("midpoint_projection_restitution", faces, [] { return with_chain(midpoint_projected()); });
  all.add("impacts_in_turn", {.h = 0.005}, [] {
    auto loop = in_turn();
    auto& set = rigid_of(loop);
    set.gravity.setZero();
    for (int k = 0; k < 4; ++k)
      set.add({.position = {0.2 * k + (k == 0 ? -0.3 : 0), 0.01 * k, 0},
               .mass = 1.0 + k % 2,
               .shape = Sphere{0.1}});
    set.set_velocity(set.handle(0), {2, 0, 0}, {0, 0, 5});
    set.set_velocity(set.handle(3), {-0.5, 0, 0});
    return loop;
  });
  all.add("midpoint_springs", {.h = 0.004}, [] {
    auto loop = springs_in_parts();
    add_balls(loop, 2);
    return loop;
  });
  all.add("collisions_first", faces, [] {
    auto loop = first_of_all();
    add_heap(loop);
    return loop;
  });
  return all.main(argc, argv);
}
