// A loop by four threads, with the bits of one: islands at once, and a heap whose sweeps they share.
#include <delassus/delassus.hpp>
#include <delassus/io/checkpoint.hpp>
#include <delassus/solvers/coloured.hpp>

#include "../worker_threads.hpp"

#include <cstdint>

using namespace delassus;

namespace {

/// A heap of balls, stacks of boxes that slide, and pairs on a joint that bounce.
template <class... More>
std::uint64_t hash_of(More... more) {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Contact{Restitution{Coulomb{.friction = 0.4}, 0.3}}, BallJoint{}},
                     Coloured{AcceleratedGaussSeidel{.tolerance = 1e-3, .max_iterations = 100}}, more...};
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(HalfSpace{});
  const int side = 7;
  for (int k = 0; k < side * side * side; ++k)
    set.add({.position = {0.19 * (k % side), 0.19 * (k / side % side) + 0.01 * (k % 3),
                          0.1 + 0.195 * (k / side / side)},
             .mass = 1.,
             .shape = Sphere{0.1}});
  for (int i = 0; i < 12; ++i) {
    for (int k = 0; k < 3; ++k)
      set.add({.position = {10. + 3 * i, 0, 0.501 + 1.001 * k},
               .velocity = {0, 0.2 * i, 0},
               .mass = 1.,
               .shape = Box{1, 1, 1}});
    const auto a = set.add({.position = {10. + 3 * i, 8, 0.6},
                            .angular_velocity = {0, 1. + i, 0},
                            .mass = 1.,
                            .shape = Box{1, 0.5, 0.5}});
    const auto b = set.add({.position = {11.2 + 3 * i, 8, 0.7}, .mass = 0.5, .shape = Sphere{0.2}});
    loop.add(BallJoint::Item{anchor(set, a, {0.6, 0, 0.1}), anchor(set, b, {-0.6, 0, 0})});
  }
  for (int k = 0; k < 12; ++k) loop.step(0.01);
  return state_hash(loop);
}

}  // namespace

int main() { return hash_of(WorkerThreads{}) == hash_of() ? 0 : 1; }
