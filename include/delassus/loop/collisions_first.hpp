/// The order of the stages in which contacts may push during the free motion.
#pragma once

#include <delassus/loop/scheme.hpp>

namespace delassus {

/// Detect, let penalty contacts push, then the plain order. With an explicit integrator (A = M) a `Penalty` contact acts
/// as a force of the free motion and has no row; with an implicit one it stays a row, the spring of implicit Euler.
struct CollisionsFirst {
  using plays = role::Scheme;

  void run(auto& loop) const {
    loop.detect();
    loop.push_apart();
    inner::linearize_to_build(loop);
    inner::solve_to_advance(loop);
  }
};

}  // namespace delassus
