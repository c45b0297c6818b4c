// Soft bodies by four threads, with the bits of one: a large one that they share, and small ones.
#include <delassus/delassus.hpp>
#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>
#include <delassus/io/checkpoint.hpp>

#include "../worker_threads.hpp"

#include <cstdint>

using namespace delassus;

namespace {

template <class... More>
std::uint64_t hash_of(More... more) {
  using Soft = TetrahedralFem<Corotational>;
  AnimationLoop loop{World{RigidBodies{}, Soft{}}, Constraints{Contact{Coulomb{.friction = 0.4}}},
                     ImplicitEuler{}, more...};
  auto& rigid = bodies<RigidBodies>(loop.world());
  auto& soft = bodies<Soft>(loop.world());
  rigid.add_fixed(HalfSpace{});
  for (const Index n : {8, 2, 3, 2})
    soft.add({.mesh = box_mesh({0.4, 0.4, 0.4}, {n, n, n}),
              .elasticity = {.young = 1e5},
              .position = {0.1 * n * n, 1. * n, 0.02},
              .velocity = {0, 0.1, -0.5},
              .contact_radius = 0.01});
  rigid.add({.position = {6.6, 8.2, 0.55}, .mass = 1., .shape = Box{0.2, 0.2, 0.2}});
  for (int k = 0; k < 4; ++k) loop.step(0.01);
  return state_hash(loop);
}

}  // namespace

int main() { return hash_of(WorkerThreads{}) == hash_of() ? 0 : 1; }
