#include "metamorphic.hpp"

#include "catch.hpp"

namespace metamorphic_welded_tests {

using namespace metamorphic;

// Two halves of a box, welded, spun about an axis that is principal for each of them: no gyroscopic term
// acts.
TEST_CASE("two halves that are welded move as the whole") {
  for (unsigned seed = 1; seed <= seeds(); ++seed) {
    Draw next{std::mt19937(seed)};
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Weld{}},
                       AcceleratedGaussSeidel{.tolerance = 1e-14, .max_iterations = 5000}};
    auto& set = rigid_bodies(loop);
    const double length = next(0.5, 3), width = next(0.5, 3), height = next(0.5, 3), spin = next(0.2, 1);
    const Vec3 v = next.vector(1), w(0, 0, spin), quarter(0.25 * length, 0, 0);
    const auto half = [&](double side) {
      return set.add({.position = side * quarter,
                      .velocity = v + w.cross(side * quarter),
                      .angular_velocity = w,
                      .density = 100.,
                      .shape = Box{0.5 * length, width, height}});
    };
    const auto left = half(-1), right = half(1);
    const auto whole = set.add({.position = {0, 0, 0},
                                .velocity = v,
                                .angular_velocity = w,
                                .density = 100.,
                                .shape = Box{length, width, height}});
    loop.add(Weld::Item{anchor_at(set, left, {0, 0, 0}), anchor_at(set, right, {0, 0, 0})});
    const double torque = 100 * length * width * height;
    for (int n = 0; n < 100; ++n) {
      set.apply_torque(left, {0, 0, 0.1 * torque});
      set.apply_torque(whole, {0, 0, 0.1 * torque});
      loop.step(1e-3);
    }
    CAPTURE(seed);
    // The weld is met at the start of a step and turns by h ω in it: what its halves miss is h ω² of the arm
    // a step, of which the middle of both sees nothing, by symmetry.
    REQUIRE((0.5 * (set.position(left) + set.position(right)) - set.position(whole)).norm() <= 1e-8);
    REQUIRE((set.angular_velocity(left) - set.angular_velocity(right)).norm() <= 1e-8);
    // Spin and moment of inertia: the halves' distance is held to the drift of one step, h² ω² = 1e-6 of the
    // arm.
    REQUIRE(std::abs(set.angular_velocity(left).z() - set.angular_velocity(whole).z()) <= 1e-4);
    REQUIRE(set.angular_velocity(whole).z() > spin);
  }
}

}  // namespace metamorphic_welded_tests
