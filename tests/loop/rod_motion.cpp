// Free rods: what implicit Euler does to energy and momentum, and what is not finite.
#include <delassus/bodies/world.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/loop/animation_loop.hpp>

#include <algorithm>
#include <limits>

#include "catch.hpp"
#include "energy_watch.hpp"
#include "rod_scenes.hpp"

namespace rod_motion_tests {

using namespace delassus;
using namespace rod_scenes;

TEST_CASE("a rod that falls freely keeps its shape, its momentum and its turn") {
  AnimationLoop loop{World{Rods{}}, ImplicitEuler{}};
  auto& set = bodies<Rods>(loop.world());
  Rod rod = bent_rod();
  rod.velocity = {1, 2, 3};
  set.add(rod);
  for (int n = 0; n < 50; ++n) loop.step(0.01);
  for (const Index b : set.active())
    CHECK((linear_part(set.velocity()[b]) - Vec3(1, 2, 3 - 9.81 * 0.5)).norm() < 1e-10);
  CHECK(set.elastic_energy() < 1e-18);
}

TEST_CASE("under implicit Euler the energy of a shaken rod never rises") {
  for (const double turn : {0.1, 0.5, 1.0}) {
    AnimationLoop loop{World{Rods{}}, ImplicitEuler{}};
    auto& set = bodies<Rods>(loop.world());
    set.gravity.setZero();
    set.add(bent_rod(12));
    shake(set, 0.02 * turn, turn);
    const double first = total_energy(set);
    const EnergyWatch seen = watch_energy(loop, set, 500, 0.01);
    CAPTURE(turn);
    CHECK(seen.rise <= 1e-14 * first);
    CHECK(seen.last < 0.1 * first);
  }
}

TEST_CASE("a rod that is given a force that is no number stays where it was, and no other notices") {
  AnimationLoop loop{World{Rods{}}, ImplicitEuler{}};
  AnimationLoop alone{World{Rods{}}, ImplicitEuler{}};
  auto& rods = bodies<Rods>(loop.world());
  const auto sick = rods.add(bent_rod());
  rods.add(bent_rod());
  auto& other = bodies<Rods>(alone.world());
  other.add(bent_rod());
  const Vec3 before = rods.position(rods.node(sick, 3));
  rods.apply_force(rods.node(sick, 3), {std::numeric_limits<double>::quiet_NaN(), 0, 0});
  loop.step(0.01), alone.step(0.01);
  CHECK(loop.report().status == Status::quarantined);
  CHECK(rods.position(rods.node(sick, 3)) == before);
  for (Index k = 0; k < 7; ++k) CHECK(rods.pose(7 + k).position == other.pose(k).position);
  loop.step(0.01);
  CHECK(loop.report().status == Status::converged);
  CHECK(rods.position(rods.node(sick, 3)) != before);
}

// Segments of 5 cm, where the weight bends over (EI/w)^(1/3) = 6 mm: they cannot follow the bend at the
// clamp.
TEST_CASE("a thread whose segments are much longer than its bends swings down and does not grow") {
  AnimationLoop loop{World{Rods{}}, ImplicitEuler{}};
  auto& set = bodies<Rods>(loop.world());
  const auto rod = set.add(
      {.points = straight_line({0, 0, 0}, {1, 0, 0}, 20), .section = round_section(1e-4), .young = 1e6});
  set.fix(set.node(rod, 0));
  double longest = 0;
  for (int n = 0; n < 400; ++n) {
    loop.step(0.005);
    for (Index k = 0; k < 20; ++k)
      longest =
          std::max(longest, (set.position(set.node(rod, k + 1)) - set.position(set.node(rod, k))).norm());
  }
  // Its weight strains it by ρ g L/E = 1e-2; a bar that swings down pulls with 2.5 times that.
  CHECK(longest / 0.05 - 1 < 2 * 2.5e-2);
  CHECK(longest / 0.05 - 1 > 1e-3);
  CHECK(set.position(set.node(rod, 20))[2] < -0.5);
}

}  // namespace rod_motion_tests
