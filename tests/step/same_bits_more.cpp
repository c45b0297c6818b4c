// The same of more scenes: in flight, asleep, with bodies that are quarantined, of particles, and by workers that take turns.
#include <delassus/activity/sleeping.hpp>
#include <delassus/delassus.hpp>

#include "../in_turns.hpp"
#include "catch.hpp"
#include "same_bits.hpp"

#include <limits>

namespace same_bits_more_tests {

using namespace same_bits;

TEST_CASE("a pile has the same bits by workers that take turns on one thread") {
  const auto hash_of = [](auto... more) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, more...};
    add_balls(bodies<RigidBodies>(loop.world()), 7, 1);
    for (int n = 0; n < 20; ++n) loop.step(5e-3);
    return state_hash(loop);
  };
  CHECK(hash_of(InTurns{}) == hash_of());
}

TEST_CASE("balls that fly at each other have the same bits on threads") {
  check_same(
      [](auto... more) {
        AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.2}}},
                           GaussSeidel{.tolerance = 1e-2, .max_iterations = 30}, more...};
        auto& set = bodies<RigidBodies>(loop.world());
        add_balls(set, 8, 3);
        for (int k = 0; k < 40; ++k)
          set.add({.position = {0.05 * (k % 7), 0.03 * (k % 5), 3 + 0.5 * k},
                   .velocity = {0, 0, -60},
                   .mass = 2.0,
                   .shape = Box{0.1, 0.2, 0.1}});
        return loop;
      },
      12, 1e-2, nothing);
}

TEST_CASE("stacks that fall asleep and are removed have the same bits on threads") {
  check_same(
      [](auto... more) {
        AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, Sleeping{},
                           more...};
        auto& set = bodies<RigidBodies>(loop.world());
        set.add_fixed(HalfSpace{});
        for (int n = 0; n < 60; ++n)
          for (int k = 0; k < 5; ++k)
            set.add(
                {.position = {3. * (n % 10) + 0.02 * ((k * 7 + n) % 5 - 2), 3. * (n / 10), 0.51 + 1.01 * k},
                 .mass = 1.0,
                 .shape = Box{1, 1, 1}});
        return loop;
      },
      60, 1e-2,
      [](auto& loop, int n) {
        auto& set = bodies<RigidBodies>(loop.world());
        if (n % 10 == 9) loop.remove(set.handle(1 + 5 * n));
      });
}

TEST_CASE("bodies that a force without a number holds have the same bits on threads") {
  check_same(
      [](auto... more) {
        AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, more...};
        auto& set = bodies<RigidBodies>(loop.world());
        set.add_fixed(HalfSpace{});
        for (int n = 0; n < 700; ++n)
          set.add({.position = {0.5 * (n % 30), 0.5 * (n / 30), 0.1}, .mass = 1.0, .shape = Sphere{0.1}});
        for (int n = 0; n < 20; ++n)
          set.add({.position = {0.7 * n, -2, 0.5}, .shape = Box{0.2, 0.2, 0.2}, .motion = Motion::kinematic});
        return loop;
      },
      5, 1e-2,
      [](auto& loop, int n) {
        auto& set = bodies<RigidBodies>(loop.world());
        for (const Index b : {650, 20, 333})
          if (n == 2) set.apply_force(set.handle(b), Vec3(0, std::numeric_limits<double>::infinity(), 0));
        for (Index b = 701; b < 721; ++b)
          set.move_to(set.handle(b), set.position(set.handle(b)) + Vec3(0, 0, b == 710 ? 1e308 : 0.01));
      });
}

TEST_CASE("particles and their contacts have the same bits on threads") {
  check_same(
      [](auto... more) {
        AnimationLoop loop{World{RigidBodies{}, Particles{}}, Constraints{Contact{Coulomb{.friction = 0.4}}},
                           more...};
        bodies<RigidBodies>(loop.world()).add_fixed(HalfSpace{});
        auto& set = bodies<Particles>(loop.world());
        for (int n = 0; n < 800; ++n)
          set.add({.position = {0.11 * (n % 40), 0.11 * (n / 40), 0.05 + 0.001 * (n % 3)},
                   .velocity = {0.1 * (n % 3), 0, -1},
                   .mass = 0.1,
                   .radius = 0.05});
        return loop;
      },
      10, 5e-3, nothing);
}

}  // namespace same_bits_more_tests
