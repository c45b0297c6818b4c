/// The scenes of the demonstration, stopped and taken up again.
#include "same_bits.hpp"

#include "../examples/demonstration/blocks_on_slope.hpp"
#include "../examples/demonstration/hanging_chain.hpp"
#include "../examples/demonstration/pile_of_shapes.hpp"
#include "../examples/demonstration/stack_of_boxes.hpp"
#include "../examples/demonstration/wall_of_boxes.hpp"

using namespace scenes;

namespace {

auto contact_loop(double friction, double margin, double tolerance) {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = friction}}},
                       NativeCollision{.margin = margin}, AcceleratedGaussSeidel{.tolerance = tolerance}};
}

}  // namespace

TEST_CASE("restored, the demonstration's falling box goes on bit for bit") {
  require_same_bits(
      1.0 / 240,
      [] {
        return AnimationLoop{World{RigidBodies{}}, ImplicitMidpoint{}};
      },
      [](auto& loop) {
        rigid_bodies(loop).add({.position = {0, 0, 1},
                                .velocity = {0, 0, 0.5 * 9.81 * 1.6},
                                .angular_velocity = {0.2, 10, 0.1},
                                .mass = 2,
                                .shape = Box{1.5, 1, 0.4}});
      });
}

TEST_CASE("restored, the demonstration's stack goes on bit for bit") {
  require_same_bits(
      1.0 / 120, [] { return contact_loop(0.6, NativeCollision{}.margin, 1e-6); },
      [](auto& loop) { demonstration::add_stack_of_boxes(rigid_bodies(loop)); });
}

TEST_CASE("restored, the demonstration's slope goes on bit for bit") {
  require_same_bits(
      1.0 / 240, [] { return contact_loop(0.5, NativeCollision{}.margin, 1e-6); },
      [](auto& loop) { demonstration::BlocksOnSlope{}.add_to(loop); });
}

TEST_CASE("restored, the demonstration's chain goes on bit for bit") {
  require_same_bits(
      1.0 / 2400,
      [] {
        return AnimationLoop{World{RigidBodies{}}, Constraints{BallJoint{}}, ImplicitMidpoint{},
                             PositionProjection{.rate = 1}, AcceleratedGaussSeidel{.tolerance = 1e-8}};
      },
      [](auto& loop) { demonstration::add_hanging_chain(loop); });
}

TEST_CASE("restored, the demonstration's wall goes on bit for bit") {
  require_same_bits(
      1.0 / 240, [] { return contact_loop(0.5, 0.03, 1e-4); },
      [](auto& loop) { demonstration::add_wall_of_boxes(rigid_bodies(loop)); }, SameBits::of_many_bodies());
}

TEST_CASE("restored, the demonstration's pile goes on bit for bit") {
  require_same_bits(
      1.0 / 240, [] { return contact_loop(0.4, 0.02, 1e-4); },
      [](auto& loop) { demonstration::add_pile_of_shapes(rigid_bodies(loop)); },
      SameBits::of_many_bodies(90));
}
