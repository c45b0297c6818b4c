// The same bits at any number of threads: each scene by 1, 2, 3 and 8 of them, beside the loop that names
// none.
#include <delassus/adapters/tbb.hpp>

#include <delassus/activity/sleeping.hpp>
#include <delassus/constraints/joints/hinge.hpp>
#include <delassus/delassus.hpp>
#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>
#include <delassus/integrators/implicit_midpoint.hpp>
#include <delassus/io/checkpoint.hpp>
#include <delassus/schemes/substeps.hpp>
#include <delassus/solvers/coloured.hpp>
#include <delassus/solvers/with_deadline.hpp>

#include "catch.hpp"
#include "scenes.hpp"

#include <oneapi/tbb/global_control.h>

#include <atomic>

namespace tbb_tests {

using namespace delassus;
using namespace scenes;

namespace {

/// As many threads as a test asks for, however many processors there are.
const oneapi::tbb::global_control eight(oneapi::tbb::global_control::max_allowed_parallelism, 8);

/// Hash of a scene after so many steps. The scene adds its bodies and gets a loop with the policies beside
/// its own.
template <class Scene, class... More>
std::uint64_t hash_after(int steps, double h, const Scene& scene, More... more) {
  return scene(
      [&](auto... policies) {
        return AnimationLoop{std::move(policies)..., more...};
      },
      [&](auto& loop) {
        for (int k = 0; k < steps; ++k) loop.step(h);
        return state_hash(loop);
      });
}
template <class Scene>
void check_same_bits(int steps, double h, const Scene& scene) {
  const std::uint64_t alone = hash_after(steps, h, scene), serial = hash_after(steps, h, scene, Serial{});
  CHECK(serial == alone);
  for (const int threads : {1, 2, 3, 8}) {
    CAPTURE(threads);
    CHECK(hash_after(steps, h, scene, Threads{threads}) == alone);
  }
}

/// `count` stacks of five boxes, each pushed to its own side, so that they slide and some fall.
void add_stacks(RigidBodies& set, int count) {
  set.add_fixed(HalfSpace{});
  for (int i = 0; i < count; ++i)
    for (int k = 0; k < 5; ++k)
      set.add({.position = {3. * i, 0.02 * ((i + k) % 3), 0.501 + 1.001 * k},
               .velocity = {0, 0.1 * i, 0},
               .angular_velocity = {0.01 * i, 0, 0.02 * k},
               .mass = 1.,
               .shape = Box{1, 1, 1}});
}
/// Balls that fall into a pit, one heap.
void add_heap(RigidBodies& set, int side) {
  set.add_fixed(HalfSpace{});
  for (const Vec3& in : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)})
    set.add_fixed(HalfSpace{in, -0.11 * side});
  for (int k = 0; k < side * side * side; ++k)
    set.add({.position = {0.21 * (k % side - 0.5 * side + 0.5) + 0.003 * (k % 7),
                          0.21 * (k / side % side - 0.5 * side + 0.5) - 0.002 * (k % 5),
                          0.1 + 0.205 * (k / side / side)},
             .mass = 1.,
             .shape = Sphere{0.1}});
}

}  // namespace

TEST_CASE("stacks, an island each: the same bits by any number of threads") {
  check_same_bits(100, 1. / 120, [](auto make, auto run) {
    auto loop = make(World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.3}}});
    add_stacks(rigid_bodies(loop), 30);
    return run(loop);
  });
}

TEST_CASE("a heap in one island, coloured or not: the same bits by any number of threads") {
  check_same_bits(60, 1. / 60, [](auto make, auto run) {
    auto loop = make(World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     Coloured{AcceleratedGaussSeidel{.tolerance = 1e-3}});
    add_heap(rigid_bodies(loop), 7);
    const auto hash = run(loop);
    CHECK(loop.report().contacts * 3 > inner::large_island);
    return hash;
  });
  check_same_bits(40, 1. / 60, [](auto make, auto run) {
    auto loop = make(World{RigidBodies{}}, Constraints{Contact{Restitution{Coulomb{.friction = 0.5}, 0.4}}},
                     Coloured{AcceleratedSweeps{.tolerance = 1e-2}});
    add_heap(rigid_bodies(loop), 7);
    return run(loop);
  });
  check_same_bits(30, 1. / 60, [](auto make, auto run) {
    auto loop = make(World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     GaussSeidel{.tolerance = 1e-2});
    add_heap(rigid_bodies(loop), 6);
    return run(loop);
  });
}

TEST_CASE("bounces, joints with limits and another law of contacts: the same bits by any number of threads") {
  check_same_bits(100, 1. / 100, [](auto make, auto run) {
    auto loop = make(World{RigidBodies{}}, Constraints{Contact{Restitution{Coulomb{.friction = 0.3}, 0.5}},
                                                       BallJoint{}, Limit<Turn>{}, Hinge{}});
    auto& set = rigid_bodies(loop);
    set.add_fixed(HalfSpace{});
    for (int i = 0; i < 40; ++i) {
      const Vec3 at(4. * i, 0, 0.6 + 0.01 * i);
      const auto a = set.add(
          {.position = at, .angular_velocity = {0, 1. + i, 0}, .mass = 1., .shape = Box{1, 0.5, 0.5}});
      const auto b = set.add({.position = at + Vec3(1.2, 0, 0.3), .mass = 0.5, .shape = Capsule{0.2, 0.6}});
      if (i % 2)
        loop.add(BallJoint::Item{anchor(set, a, {0.6, 0, 0.15}), anchor(set, b, {-0.6, 0, -0.15})});
      else
        loop.add(Hinge::Item{anchor(set, a, {0.6, 0, 0.15}), anchor(set, b, {-0.6, 0, -0.15})});
    }
    return run(loop);
  });
}

TEST_CASE("the midpoint rule, sleep and substeps: the same bits by any number of threads") {
  check_same_bits(100, 1. / 100, [](auto make, auto run) {
    auto loop = make(World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.3}}, BallJoint{}},
                     ImplicitMidpoint{});
    auto& set = rigid_bodies(loop);
    add_stacks(set, 10);
    for (int i = 0; i < 10; ++i) {
      const auto rod = set.add({.position = {3. * i, 5, 3},
                                .angular_velocity = {0, 0, 1. * i},
                                .mass = 1.,
                                .shape = Box{1, 0.2, 0.2}});
      loop.add(BallJoint::Item{anchor(set, rod, {-0.5, 0, 0}), world_anchor({3. * i - 0.5, 5, 3})});
    }
    return run(loop);
  });
  check_same_bits(150, 1. / 60, [](auto make, auto run) {
    auto loop = make(World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.6}}}, Sleeping{});
    add_stacks(rigid_bodies(loop), 8);
    return run(loop);
  });
  check_same_bits(30, 1. / 30, [](auto make, auto run) {
    auto loop =
        make(World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.6}}}, Substeps{.count = 4});
    add_stacks(rigid_bodies(loop), 8);
    return run(loop);
  });
}

TEST_CASE("soft blocks and W without a matrix: the same bits by any number of threads") {
  using Soft = TetrahedralFem<Corotational>;
  check_same_bits(20, 1. / 200, [](auto make, auto run) {
    auto loop = make(World{RigidBodies{}, Soft{}},
                     Constraints{Contact{Coulomb{.friction = 0.6}}, BallJoint{}}, ImplicitEuler{});
    add_stacks(rigid_bodies(loop), 3);
    auto& soft = bodies<Soft>(loop.world());
    for (int i = 0; i < 2; ++i) {
      const auto block = soft.add({.mesh = box_mesh({1, 0.5, 0.5}, {4, 2, 2}),
                                   .elasticity = {.young = 1e5, .poisson = 0.3},
                                   .density = 500});
      soft.fix(block, [](const Vec3& x) { return x.x() < 1e-9; });
      const Vec3 tip(1, 0.25, 0.25);
      const auto ball =
          rigid_bodies(loop).add({.position = {1, 0.25, -0.25}, .mass = 1. + i, .shape = Sphere{0.05}});
      loop.add(BallJoint::Item{anchor_at(rigid_bodies(loop), ball, tip), soft.anchor_at(block, tip)});
    }
    return run(loop);
  });
  check_same_bits(60, 1. / 100, [](auto make, auto run) {
    auto loop =
        make(World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.3}}}, MatrixFreeCompliance{});
    add_stacks(rigid_bodies(loop), 8);
    return run(loop);
  });
}

TEST_CASE("Threads runs each task once, and by workers that are not at two places at once") {
  const Threads threads{8};
  REQUIRE(threads.workers() == 8);
  std::vector<std::atomic<int>> count(10000), busy(8);
  std::atomic<int> clashes{0};
  threads.run(10000, [&](Index task, Index worker) {
    if (busy[std::size_t(worker)]++ != 0) ++clashes;
    ++count[std::size_t(task)];
    --busy[std::size_t(worker)];
  });
  for (const auto& c : count) REQUIRE(c == 1);
  CHECK(clashes == 0);
  threads.run(0, [](Index, Index) { FAIL("there is no task"); });
  CHECK_THROWS_AS(threads.run(100,
                              [](Index task, Index) {
                                if (task == 57) inner::refuse("task 57");
                              }),
                  InvalidArgument);
}

TEST_CASE("a number of threads that is none is refused") {
  CHECK_THROWS_WITH(Threads{-1}, Catch::Contains("-1 threads"));
  CHECK_THROWS_AS(Threads{100000}, InvalidArgument);
  CHECK(Threads{}.workers() == 8);  // of `eight`
  CHECK(Threads{3}.workers() == 3);
  CHECK(Threads{9}.workers() == 8);
}

}  // namespace tbb_tests
