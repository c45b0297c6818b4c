// What a user writes outside the library: a law, an integrator and a listener, none of which the library knows.
#include <delassus/delassus.hpp>

#include "catch.hpp"
#include "rope.hpp"

namespace users_own_parts_tests {

using namespace delassus;

namespace {

/// Symplectic Euler in a medium that takes the share `drag` of the velocity per second.
struct DraggedEuler {
  using plays = role::Integrator;
  double drag = 0;

  SystemScale scale(double h) const { return {.mass = 1 + h * drag}; }
  void impulse(const auto& set, auto& p, double h) const {
    set.add_forces(p);
    set.add_mass_times_velocity(p, -drag);
    for (auto& x : p) x *= h;
  }
  void advance(auto& set, double h) const { set.advance(h); }
};

struct CountSolves {
  using plays = role::Listener;
  using listens = Listens<stage::Solve>;
  int count = 0;
  void after(stage::Solve, const auto&) { ++count; }
};

}  // namespace

TEST_CASE("a rope of one's own is slack while its end falls, and holds when it is taut") {
  AnimationLoop loop{World{Particles{}}, Constraints{Rope{}}};
  auto& set = bodies<Particles>(loop.world());
  const auto stone = set.add({.position = {0, 0, -0.2}, .mass = 2.0});
  const auto rope = loop.add(Rope::Item{anchor(set, stone), world_anchor({0, 0, 0}), 1.0});
  const double h = 1e-3;
  double pull = 0;
  for (int n = 1; n <= 2000; ++n) {
    loop.step(h);
    pull = loop.impulse(rope)[0] / h;
    REQUIRE(pull <= 0);
    if (n <= 380) {  // √(2 · 0.8/g) = 0.404 s
      REQUIRE(pull == 0);
      REQUIRE(set.velocity(stone).z() == Approx(-n * h * 9.81).epsilon(1e-12));
    }
    REQUIRE(set.position(stone).norm() <= 1 + 1e-9);
  }
  REQUIRE(pull == Approx(-2 * 9.81).epsilon(1e-6));
}

// A y-shaped problem without vertical line: the rope swings a rigid box about its corner, as a pendulum under a pull of
// m (g + v²/r) at the bottom, and its length never grows beyond first order.
TEST_CASE("a rope of one's own serves rigid bodies and particles with the same code") {
  AnimationLoop loop{World{RigidBodies{}, Particles{}}, Constraints{Rope{}}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  auto& particles = bodies<Particles>(loop.world());
  const auto box = rigid.add({.position = {0, 0, 0}, .mass = 3.0, .shape = Box{0.2, 0.2, 0.2}});
  const auto stone = particles.add({.position = {0, 0, -1}, .mass = 1.0});
  loop.add(Rope::Item{anchor(rigid, box, {0, 0, 0.1}), world_anchor({0, 0, 1.1}), 1.0});
  const auto lower = loop.add(Rope::Item{anchor(particles, stone), anchor(rigid, box, {0, 0, -0.1}), 0.9});
  for (int n = 0; n < 200; ++n) REQUIRE(loop.step(1e-3).status == Status::converged);
  REQUIRE(loop.impulse(lower)[0] / 1e-3 == Approx(-9.81).epsilon(1e-6));
  REQUIRE(rigid.position(box).norm() < 1e-6);
}

// (1 + h c) v⁺ = v + h g (1 − …): v (1 + h c) + h (g − c v) → v⁺ = v + h (g − c v)/(1 + h c), whose limit is g/c.
TEST_CASE("an integrator of one's own moves the bodies by its own formula") {
  AnimationLoop loop{World{RigidBodies{}}, DraggedEuler{.drag = 2}};
  auto& set = bodies<RigidBodies>(loop.world());
  const auto ball = set.add({.position = {0, 0, 0}, .mass = 0.3, .shape = Sphere{0.1}});
  double v = 0;
  for (int n = 0; n < 1000; ++n) {
    loop.step(0.01);
    v += 0.01 * (-9.81 - 2 * v) / (1 + 0.01 * 2);
    REQUIRE(set.velocity(ball).z() == Approx(v).epsilon(1e-13));
  }
  REQUIRE(v == Approx(-9.81 / 2).epsilon(1e-6));
}

TEST_CASE("a listener of one's own hears the stage it names, once a step") {
  AnimationLoop loop{World{Particles{}}, Constraints{Rope{}}, CountSolves{}};
  for (int n = 0; n < 7; ++n) loop.step(0.01);
  REQUIRE(loop.get<CountSolves>().count == 7);
}

}  // namespace users_own_parts_tests
