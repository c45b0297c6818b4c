// Full Newton on bodies at rest, and on sets of which one body is no number.
#include <delassus/bodies/world.hpp>
#include <delassus/loop/animation_loop.hpp>
#include <delassus/steppers/full_newton.hpp>

#include "catch.hpp"
#include "rod_scenes.hpp"
#include "soft_scenes.hpp"

#include <cmath>

namespace full_newton_standing_tests {

using namespace delassus;

namespace {

using Standing = TetrahedralFem<Corotational>;

auto add_standing(Standing& set) {
  return set.add({.mesh = soft_scenes::cube(2), .elasticity = {.young = 1e5}});
}
auto add_standing(Rods& set) {
  Rod rod{.section = rectangular_section(0.02, 0.02), .young = 1e7, .density = 800, .up = {0, 0, 1}};
  for (int k = 0; k < 5; ++k) rod.points.push_back({0.1 * k, 0, 0});
  return set.add(rod);
}

}  // namespace

// Their places are no finer than ε times the reach of the bodies, and velocities than that a step: below, the
// last change of Newton's method is rounding.
TEMPLATE_TEST_CASE("a body that has come to rest under full Newton ends its steps at rounding", "", Standing,
                   Rods) {
  AnimationLoop loop{World{TestType{}}, FullNewton{}};
  auto& set = bodies<TestType>(loop.world());
  const auto body = add_standing(set);
  set.fix(body, [](const Vec3& x) { return x.x() < 1e-9; });
  for (int k = 0; k < 400; ++k) loop.step(0.1);
  for (int k = 0; k < 20; ++k) {
    CAPTURE(k);
    CHECK(loop.step(0.01).status <= Status::stalled);
  }
}

// The others' own Newton steps end at 1e-12 of their velocities, a few m/s, each step.
TEMPLATE_TEST_CASE("a load that is no number stops its own body under full Newton, and no other", "",
                   Standing, Rods) {
  const auto fall = [](bool is_poisoned) {
    AnimationLoop loop{World{TestType{}}, FullNewton{.max_iterations = 300}};
    auto& set = bodies<TestType>(loop.world());
    const auto first = add_standing(set), second = add_standing(set);
    const Vec3 start = set.position(set.node(first, 1));
    for (int k = 0; k < 5; ++k) {
      if (is_poisoned) set.apply_force(set.node(first, 0), {NAN, 0, 0});
      set.apply_force(set.node(second, 1), {0.1, 0, 0});
      const Status status = loop.step(0.01).status;
      CHECK((status == Status::quarantined) == is_poisoned);
      CHECK((set.position(set.node(first, 1)) == start) == is_poisoned);
    }
    return set.position(set.node(second, 1));
  };
  CHECK((fall(true) - fall(false)).norm() < 1e-11);
}

}  // namespace full_newton_standing_tests
