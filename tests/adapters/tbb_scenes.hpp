/// Scenes on several threads, beside the same that name none.
#pragma once

#include <delassus/adapters/tbb.hpp>

#include <delassus/delassus.hpp>
#include <delassus/io/checkpoint.hpp>

#include "catch.hpp"
#include "scenes.hpp"

#include <oneapi/tbb/global_control.h>

#include <cstdint>
#include <utility>

namespace tbb_scenes {

using namespace delassus;
using namespace scenes;

/// As many threads as a test asks for, however many processors there are.
inline const oneapi::tbb::global_control eight(oneapi::tbb::global_control::max_allowed_parallelism, 8);

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
  const std::uint64_t alone = hash_after(steps, h, scene);
  for (const int threads : {1, 2, 3, 8}) {
    CAPTURE(threads);
    CHECK(hash_after(steps, h, scene, Threads{threads}) == alone);
  }
}

/// `count` stacks of five boxes, each pushed to its own side, so that they slide and some fall.
inline void add_stacks(RigidBodies& set, int count) {
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
inline void add_heap(RigidBodies& set, int side) {
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

}  // namespace tbb_scenes
