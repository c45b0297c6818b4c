/// The order of the stages.
#pragma once

#include <delassus/core/roles.hpp>

#include <type_traits>

namespace delassus {

namespace inner {

/// From what was detected to W and d.
void linearize_to_build(auto& loop) {
  loop.linearize();
  loop.free_motion();
  loop.find_islands();
  loop.make_bias();
  loop.build();
}

/// From W and d to the end of the step.
void solve_to_advance(auto& loop) {
  loop.solve();
  loop.correct();
  loop.advance();
}

/// A scheme that solves joint by joint says so: the solver and the compliance are not asked.
template <class Scheme>
inline constexpr bool visits_joints = requires { requires Scheme::visits_joints; };

}  // namespace inner

/// Detect, linearise, move freely, and solve: the plain order. A scheme calls the stages of a loop in its own order.
struct PlainOrder {
  using plays = role::Scheme;
  static constexpr bool takes_whole_steps = true;

  void run(auto& loop) const {
    if constexpr (std::remove_reference_t<decltype(loop)>::moves_freely) {
      loop.move_freely();
    } else if constexpr (std::remove_reference_t<decltype(loop)>::solves_whole_step) {
      loop.detect();
      loop.solve_whole_step();
      loop.advance();
    } else {
      loop.detect();
      inner::linearize_to_build(loop);
      inner::solve_to_advance(loop);
    }
  }
};

}  // namespace delassus
