/// The order of the stages in which last step's impulses act first.
#pragma once

#include <delassus/loop/scheme.hpp>

namespace delassus {

/// Predict and correct: the impulses of the last step, matched by constraint and by contact id, act on the free motion;
/// the solve finds the total impulses; the corrective motion moves by the difference. Detection comes before the free
/// motion here, so the prediction is made with the H of this step at once: a contact that has gone predicts nothing.
/// With an exact W the motion is that of `PlainOrder`; with an inexact one its error acts on the change of λ alone.
struct PredictiveScheme {
  using plays = role::Scheme;
  static constexpr bool predicts = true;

  void run(auto& loop) const {
    loop.detect();
    inner::linearize_to_build(loop);
    loop.predict();
    inner::solve_to_advance(loop);
  }
};

}  // namespace delassus
