/// Stacks on a backend's contacts: they stand, and go on bit for bit from a checkpoint.
#pragma once

#include <delassus/io/checkpoint.hpp>

#include "catch.hpp"
#include "scenes.hpp"

namespace scenes {

template <class Backend>
auto stack_loop_on() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, Backend{},
                       AcceleratedGaussSeidel{.tolerance = 1e-6}};
}

/// Ten bodies of unit height for a minute. The bounds are those of tests/loop/standing.cpp: they are the
/// solver's, not the backend's.
template <class Backend>
void check_ten_stand(const Shape& shape) {
  auto loop = stack_loop_on<Backend>();
  const auto boxes = add_stack(rigid_bodies(loop), 10, shape);
  const Standing seen = stand(loop, boxes.back());
  CHECK(seen.unconverged == 0);
  CHECK(seen.drift < 2e-3);
  CHECK(seen.penetration < 5e-4);
  CHECK(seen.kinetic_energy < 1e-8);
}

template <class Backend>
void require_same_bits_after_restore() {
  auto loop = stack_loop_on<Backend>();
  add_stack(rigid_bodies(loop), 5, Box{1, 1, 1}, 1e-2);
  for (int n = 0; n < 37; ++n) loop.step(1.0 / 60);
  auto restored = stack_loop_on<Backend>();
  restore(restored, checkpoint(loop));
  for (int n = 0; n < 1000; ++n) {
    loop.step(1.0 / 60);
    restored.step(1.0 / 60);
    REQUIRE(state_hash(loop) == state_hash(restored));
  }
}

}  // namespace scenes
