// Deformable bodies on their own, their steps solved to the end.
#include <delassus/bodies/world.hpp>
#include <delassus/loop/animation_loop.hpp>
#include <delassus/steppers/full_newton.hpp>

#include "catch.hpp"
#include "energy_watch.hpp"
#include "rod_scenes.hpp"
#include "soft_scenes.hpp"

namespace full_newton_tests {

using namespace delassus;
using namespace rod_scenes;

namespace {

using Soft = TetrahedralFem<Corotational>;
const Vec3 along(1, 2, 3), spin(0.5, -0.3, 2);

/// A body that flies and spins, not yet stretched by it: it will ring.
void add_spinning(Soft& set) {
  set.add({.mesh = soft_scenes::cube(1), .elasticity = {.young = 1e5}});
  for (const Index b : set.active()) set.velocity()[b] = along + spin.cross(set.position(set.handle(b)));
}
void add_spinning(Rods& set) {
  set.add(bent_rod(4));
  for (const Index b : set.active())
    set.velocity()[b] = twist<double>(Vec3(along + spin.cross(set.position(set.handle(b)))), spin);
}

/// What 10 000 steps do: the drift of P and L, the largest rise of the energy in a step, the energy at the
/// end, all as shares.
struct Outcome {
  double P, L, rise, left;
};
template <class Set>
Outcome fly(double theta) {
  AnimationLoop loop{World{Set{}}, FullNewton{.theta = theta, .max_iterations = 300}};
  auto& set = bodies<Set>(loop.world());
  set.gravity.setZero();
  add_spinning(set);
  const Vec3 P = momentum(set), L = angular_momentum(set);
  const double first = total_energy(set);
  const EnergyWatch seen = watch_energy(loop, set, 10000, 0.001);
  CHECK(loop.report().status <= Status::stalled);
  return {(momentum(set) - P).norm() / P.norm(), (angular_momentum(set) - L).norm() / L.norm(),
          seen.rise / first, seen.last / first};
}

}  // namespace

TEMPLATE_TEST_CASE("the midpoint rule keeps P and L of a spinning body over 10 000 steps", "", Soft, Rods) {
  const Outcome out = fly<TestType>(0.5);
  CHECK(out.P < 1e-11);
  CHECK(out.L < 1e-11);
  CHECK(std::abs(out.left - 1) < 1e-4);  // it swings with what rings
}

TEMPLATE_TEST_CASE("implicit Euler solved to the end keeps P of a spinning body, and its energy never rises",
                   "", Soft, Rods) {
  const Outcome out = fly<TestType>(1);
  CHECK(out.P < 1e-11);
  CHECK(out.rise <= 1e-14);  // roundings of the sum
  CHECK(out.left < 1);
}

TEST_CASE("implicit Euler solved to the end takes a shaken rod to rest, and its energy never rises") {
  AnimationLoop loop{World{Rods{}}, FullNewton{.max_iterations = 300}};
  auto& set = bodies<Rods>(loop.world());
  set.gravity.setZero();
  set.add(bent_rod());
  shake(set, 0.05, 1);
  const double first = total_energy(set);
  CHECK(watch_energy(loop, set, 200, 0.02).rise <= 1e-14 * first);
  CHECK(set.elastic_energy() < 1e-3 * first);
}

TEST_CASE("what is no number stays where it was, and impossible settings are refused") {
  AnimationLoop loop{World{Rods{}}, FullNewton{}};
  auto& set = bodies<Rods>(loop.world());
  const auto rod = set.add(bent_rod());
  const Vec3 before = set.position(set.node(rod, 3));
  set.apply_force(set.node(rod, 3), {0.0 / 0.0, 0, 0});
  loop.step(0.01);
  CHECK(loop.report().status != Status::converged);
  CHECK(set.position(set.node(rod, 3)) == before);
  loop.step(0.01);
  CHECK(loop.report().status <= Status::stalled);
  CHECK(set.position(set.node(rod, 3)) != before);
  CHECK_THROWS_WITH((AnimationLoop{World{Rods{}}, FullNewton{.theta = 0.7}}),
                    Catch::Contains("theta 0.7 must be 1"));
}

}  // namespace full_newton_tests
