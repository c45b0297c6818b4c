/// A run that is stopped, kept and taken up again against the one that was not.
#pragma once

#include <delassus/io/checkpoint.hpp>

#include <cstdlib>
#include <random>

#include "catch.hpp"
#include "scenes.hpp"

namespace scenes {

struct SameBits {
  int moments = 3;   ///< at which the state is kept, drawn at random
  int steps = 1000;  ///< of both runs after each
  int after = 0;     ///< steps before the first draw, for scenes in which nothing touches at first

  /// A thousand steps of a hundred bodies, six times over, are a matter of minutes: one moment and fewer
  /// steps, unless DELASSUS_CHECKPOINTS is set.
  static SameBits of_many_bodies(int after = 0) {
    if (std::getenv("DELASSUS_CHECKPOINTS")) return {.after = after};
    return {.moments = 1, .steps = 50, .after = after};
  }
};

/// At random steps the state goes into a loop that is fresh and empty; both then run on. Before every step
/// drive(loop, n) does what the example's program does: n counts from the start.
template <class Fresh, class Fill, class Drive>
void require_same_bits(double h, const Fresh& fresh, const Fill& fill, const Drive& drive,
                       SameBits how = {}) {
  auto loop = fresh();
  fill(loop);
  std::minstd_rand random(3);
  int at = 0;
  for (int k = 0; k < how.moments; ++k) {
    for (int n = std::uniform_int_distribution<int>(1, 200)(random) + (k == 0 ? how.after : 0); n > 0;
         --n, ++at) {
      drive(loop, at);
      loop.step(h);
    }
    const auto bytes = checkpoint(loop);
    auto restored = fresh();
    restore(restored, bytes);
    REQUIRE(restored.time() == loop.time());
    auto original = loop.clone();
    for (int n = at; n < at + how.steps; ++n) {
      drive(original, n);
      drive(restored, n);
      const StepReport a = original.step(h), b = restored.step(h);
      REQUIRE(a.sweeps == b.sweeps);
      REQUIRE(state_hash(original) == state_hash(restored));
    }
  }
}

template <class Fresh, class Fill>
void require_same_bits(double h, const Fresh& fresh, const Fill& fill, SameBits how = {}) {
  require_same_bits(
      h, fresh, fill, [](auto&, int) {}, how);
}

}  // namespace scenes
