// Loops that share their steps among threads, beside one that names none.
#pragma once

#include <delassus/delassus.hpp>
#include <delassus/io/checkpoint.hpp>

#include "../worker_threads.hpp"
#include "catch.hpp"

#include <cmath>

namespace same_bits {

using namespace delassus;

/// As many rows of balls as there are along an edge, each layer a little off the one below, above a floor and
/// between walls.
inline void add_balls(RigidBodies& set, int side, double speed) {
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

inline const auto nothing = [](auto&, int) {};

}  // namespace same_bits
