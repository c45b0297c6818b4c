/// The default scheme: Detect, then all other stages, once a step.
#pragma once

#include <delassus/core/roles.hpp>
#include <delassus/step/plain_step.hpp>

namespace delassus {

/// Detect, linearise, move freely, and solve: the plain order. A scheme calls the stages of a step in its own order.
struct PlainOrder {
  using plays = role::Scheme;
  static constexpr bool takes_whole_steps = true;  ///< read by the checks: suits integrators that make a whole step at once

  void run(auto& step) const {
    stage::detect(step);
    stage::move(step);
  }
};

}  // namespace delassus
