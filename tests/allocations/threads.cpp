// Warm steps by several workers, in turns, so that who does what is the same in each run.
#include "allocations/count_allocations.hpp"

#include <delassus/solvers/coloured.hpp>
#include <delassus/step/in_parallel.hpp>

#include "allocations/allocation_scenes.hpp"
#include "in_turns.hpp"

TEST_CASE("a warm step of ten stacks by three workers allocates nothing") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, InTurns{}};
  for (int i = 0; i < 10; ++i) add_stack(rigid_bodies(loop), 8, Box{1, 1, 1}, 1e-3, {3. * i, 0, 0});
  REQUIRE(allocations_of(loop, 200, 500) == 0);
}

TEST_CASE("a warm step of a wall whose sweeps are shared allocates nothing") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     Coloured{AcceleratedGaussSeidel{.tolerance = 1e-3}}, InTurns{}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  for (int row = 0; row < 8; ++row)
    for (int k = 0; k < 10; ++k)
      set.add({.position = {1.01 * k + 0.5 * (row % 2), 0, 0.5 + row}, .mass = 1., .shape = Box{1, 1, 1}});
  const long made = allocations_of(loop, 400, 200);  // its rows stay from the 300th step on
  CHECK(loop.report().rows > inner::large_island);
  REQUIRE(made == 0);
}
