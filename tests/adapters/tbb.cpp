// The same bits at any number of threads: each scene by 1, 2, 3 and 8 of them, beside the loop that names
// none.
#include <delassus/adapters/tbb.hpp>

#include <delassus/delassus.hpp>
#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>
#include <delassus/solvers/coloured.hpp>
#include <delassus/solvers/with_deadline.hpp>

#include "catch.hpp"
#include "scenes.hpp"
#include "tbb_scenes.hpp"

#include <atomic>

namespace tbb_tests {

using namespace delassus;
using namespace scenes;
using namespace tbb_scenes;

TEST_CASE("stacks, an island each: the same bits by any number of threads") {
  check_same_bits(100, 1. / 120, [](auto make, auto run) {
    auto loop = make(World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.3}}});
    add_stacks(rigid_bodies(loop), 30);
    return run(loop);
  });
}

TEST_CASE("Serial that is named has the bits of a loop that names none") {
  const auto scene = [](auto make, auto run) {
    auto loop = make(World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.3}}});
    add_stacks(rigid_bodies(loop), 5);
    return run(loop);
  };
  CHECK(hash_after(50, 1. / 120, scene, Serial{}) == hash_after(50, 1. / 120, scene));
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
