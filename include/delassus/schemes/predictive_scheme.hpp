/// A scheme that changes Solve and Correct: last step's impulses act first.
#pragma once

#include <delassus/core/roles.hpp>
#include <delassus/schemes/inner/predict.hpp>
#include <delassus/step/plain_step.hpp>

namespace delassus {

/// Predict and correct: the impulses of the last step, matched by constraint and by contact id, act on the free motion;
/// the solve finds the total impulses; the corrective motion moves by the difference. The prediction is made
/// with the H of this step, after detection: a contact that has gone predicts nothing.
/// With an exact W the motion is that of `PlainOrder`; with an inexact one its error acts on the change of λ alone.
struct PredictiveScheme {
  using plays = role::Scheme;

  template <class Base>
  using stages = inner::PredictiveStages<Base>;
  template <class P>
    requires(P::Laws::pool_count > 0)
  using State = inner::PredictedState<P>;

  void run(auto& step) const {
    stage::detect(step);
    stage::move(step);
  }
};

}  // namespace delassus
