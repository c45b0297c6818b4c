// A program of its own: it counts every call of operator new. Warm steps on two threads.
#define EIGEN_RUNTIME_NO_MALLOC
#include <delassus/adapters/tbb.hpp>
#include <delassus/solvers/coloured.hpp>

#include "allocation_scenes.hpp"

TEST_CASE("a warm step of ten stacks on two threads allocates nothing") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, Threads{2}};
  for (int i = 0; i < 10; ++i) add_stack(rigid_bodies(loop), 8, Box{1, 1, 1}, 1e-3, {3. * i, 0, 0});
  REQUIRE(allocations_of(loop, 200, 500) == 0);
}

TEST_CASE("a warm step of a heap whose sweeps two threads share allocates nothing") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     Coloured{AcceleratedGaussSeidel{.tolerance = 1e-2}}, Threads{2}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  for (const Vec3& in : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)})
    set.add_fixed(HalfSpace{in, -0.8});
  for (int k = 0; k < 343; ++k)
    set.add(
        {.position = {0.21 * (k % 7 - 3) + 1e-3 * (k % 5), 0.21 * (k / 7 % 7 - 3), 0.1 + 0.205 * (k / 49)},
         .mass = 1.,
         .shape = Sphere{0.1}});
  const long made = allocations_of(loop, 300, 100);
  CHECK(loop.report().rows > 3 * 343);
  REQUIRE(made == 0);
}
