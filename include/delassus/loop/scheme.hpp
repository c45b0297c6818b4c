/// The order of the stages.
#pragma once

#include <delassus/core/roles.hpp>

#include <type_traits>

namespace delassus {

/// Detect, linearise, move freely, and solve: the plain order. A scheme calls the stages of a loop in its own order.
struct PlainOrder {
  using plays = role::Scheme;

  void run(auto& loop) const {
    if constexpr (std::remove_reference_t<decltype(loop)>::moves_freely) {
      loop.move_freely();
    } else {
      loop.detect();
      loop.linearize();
      loop.free_motion();
      loop.find_islands();
      loop.make_bias();
      loop.build();
      loop.solve();
      loop.correct();
      loop.advance();
    }
  }
};

}  // namespace delassus
