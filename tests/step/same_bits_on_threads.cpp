// Whole steps of scenes that are large enough for every part of a step to be shared: the bits are those of a
// loop that names no threads, whatever their number.
#include <delassus/activity/sleeping.hpp>
#include <delassus/collision/with_filter.hpp>
#include <delassus/delassus.hpp>
#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>
#include <delassus/io/checkpoint.hpp>
#include <delassus/solvers/coloured.hpp>

#include "../in_turns.hpp"
#include "../worker_threads.hpp"
#include "catch.hpp"

#include <cmath>
#include <limits>

namespace same_bits_on_threads_tests {

using namespace delassus;

namespace {

/// As many rows of balls as there are along an edge, each layer a little off the one below, above a floor and
/// between walls.
void add_balls(RigidBodies& set, int side, double speed) {
  const double pitch = 0.21, half = 0.5 * pitch * side + 0.05;
  set.add_fixed(HalfSpace{});
  for (int wall = 0; wall < 4; ++wall) {
    const double angle = 1.5707963267948966 * wall;
    const Vec3 inward{-std::cos(angle), -std::sin(angle), 0};
    set.add_fixed(HalfSpace{inward, -half});
  }
  for (int n = 0; n < side * side * side; ++n) {
    const int i = n % side, j = n / side % side, k = n / (side * side);
    const double off = 0.02 * ((k * 7 + i * 3 + j * 5) % 5 - 2);
    set.add({.position = {pitch * (i - 0.5 * (side - 1)) + off, pitch * (j - 0.5 * (side - 1)) - off,
                          0.1 + pitch * k},
             .velocity = {0, 0, -speed},
             .mass = 1.0,
             .shape = Sphere{0.1}});
  }
}

/// Steps the loops that `make` returns for each execution; each(loop, n) is called before a step.
template <class Make, class Each>
void check_same(const Make& make, int steps, double h, const Each& each) {
  auto alone = make();
  for (int n = 0; n < steps; ++n) each(alone, n), alone.step(h);
  CHECK(alone.report().contacts > 100);
  const auto check = [&](auto execution) {  // one type of them: each takes the compiler a whole loop
    auto shared = make(execution);
    for (int n = 0; n < steps; ++n) each(shared, n), shared.step(h);
    CAPTURE(execution.workers());
    CHECK(state_hash(shared) == state_hash(alone));
    CHECK(shared.report().contacts == alone.report().contacts);
    CHECK(shared.report().pairs == alone.report().pairs);
    CHECK(shared.report().queries == alone.report().queries);
    CHECK(shared.report().sweeps == alone.report().sweeps);
    CHECK(shared.report().quarantined == alone.report().quarantined);
  };
  for (const int workers : {1, 2, 3, 8}) check(WorkerThreads{{}, workers});
}

const auto nothing = [](auto&, int) {};

}  // namespace

TEST_CASE("a pile in one island has the same bits on threads") {
  check_same(
      [](auto... more) {
        AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                           Coloured{AcceleratedGaussSeidel{.tolerance = 1e-2}}, more...};
        add_balls(bodies<RigidBodies>(loop.world()), 9, 1);
        return loop;
      },
      30, 5e-3, nothing);
}

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

TEST_CASE("chains of joints in a heap have the same bits on threads") {
  check_same(
      [](auto... more) {
        AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.4}}, BallJoint{}},
                           WithFilter{NativeCollision{}}, Coloured{AcceleratedGaussSeidel{.tolerance = 1e-2}},
                           more...};
        auto& set = bodies<RigidBodies>(loop.world());
        set.add_fixed(HalfSpace{});
        for (int c = 0; c < 60; ++c)
          for (int k = 0; k < 8; ++k) {
            const auto link = set.add({.position = {0.25 * k, 0.19 * (c % 10), 0.1 + 0.19 * (c / 10)},
                                       .mass = 1.0,
                                       .shape = Capsule{0.09, 0.1}});
            if (k > 0)
              loop.add(BallJoint::Item{anchor(set, set.handle(link.index - 1), Vec3(0.125, 0, 0)),
                                       anchor(set, link, Vec3(-0.125, 0, 0))});
          }
        return loop;
      },
      15, 5e-3, nothing);
}

TEST_CASE("a soft body in contact has the same bits on threads") {
  using Soft = TetrahedralFem<Corotational>;
  check_same(
      [](auto... more) {
        AnimationLoop loop{World{RigidBodies{}, Soft{}}, Constraints{Contact{Coulomb{.friction = 0.4}}},
                           ImplicitEuler{}, more...};
        auto& rigid = bodies<RigidBodies>(loop.world());
        rigid.add_fixed(HalfSpace{});
        for (int n = 0; n < 200; ++n)
          rigid.add(
              {.position = {0.3 * (n % 20) - 3, 2 + 0.3 * (n / 20), 0.1}, .mass = 1.0, .shape = Sphere{0.1}});
        bodies<Soft>(loop.world())
            .add({.mesh = box_mesh({1.2, 1.2, 0.4}, {12, 12, 3}),
                  .elasticity = {.young = 1e5},
                  .position = {0, 0, 0.01},
                  .velocity = {0.1, 0, -0.5},
                  .contact_radius = 0.01});
        return loop;
      },
      6, 1e-2, nothing);
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

}  // namespace same_bits_on_threads_tests
