/// Steps whose size follows an error that the user asks for.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/schemes/error_report.hpp>
#include <delassus/schemes/inner/controlled_steps.hpp>

#include <string>

namespace delassus {

/// `loop.step(h)` goes h seconds in as many inner steps as the accuracy takes. Each is tried as one step of its size and as two
/// halves. Their difference
///
///   e = max over bodies of |Δx|/L + |Δθ| + τ (|Δv|/L + |Δω|),   L = max(bounding radius, `length`),
///
/// is at most `accuracy`, or the step is repeated, smaller. Where nothing pushes the end is extrapolated, and one order better
/// than the integrator; joints are closed after it. Elsewhere the halves are taken. Where something begins to push τ is the
/// step and the gap at which it does counts with (1 + e) gap/L. `error_report(loop)` says what happened.
///
/// A listener with `lead(world, t, h)` is called before each inner step of h s from t, tried ones too, and says by `move_to` where
/// kinematic bodies are at its end. It then leads all of them: what the host told them is taken for the end of an inner step. Other
/// schemes ask it once, before each step of the host.
struct ErrorControlled {
  using plays = role::Scheme;
  static constexpr bool takes_whole_steps = true;  ///< read by the checks: suits integrators that make a whole step at once
  static constexpr bool divides_step = true;       ///< read by the checks, which refuse an activity beside it
  static constexpr bool leads_parts = true;     ///< read by the step: asks listeners that lead itself
  template <class P>
  using State = inner::ControlledSteps<P>;

  double accuracy = 1e-3;   ///< asked error of an inner step, in (0, 0.1]: a share of a body's size, and rad
  double length = 0;        ///< m: what is smaller counts as that large
  double horizon = 0.1;     ///< τ, s: an error of velocity counts as the way that it makes in this time
  double min_step = 1e-7;   ///< s: a step of that size is accepted whatever its error, and counted
  double max_step = 0.1;    ///< s
  double output_step = 0;   ///< s: inner steps end at all multiples of it; 0: at none
  bool per_second = false;  ///< arcs keep the accuracy per second and not per step; impacts per step all the same

  void check() const {
    inner::expect_number(accuracy > 0 && accuracy <= 0.1, "ErrorControlled: accuracy", accuracy, "must be in (0, 0.1]");
    inner::expect_not_negative("ErrorControlled: length", length, "m");
    inner::expect_not_negative("ErrorControlled: horizon", horizon, "s");
    inner::expect_positive("ErrorControlled: min_step", min_step, "s");
    inner::expect_positive("ErrorControlled: max_step", max_step, "s");
    inner::expect_not_negative("ErrorControlled: output_step", output_step, "s");
    DELASSUS_EXPECT(min_step <= max_step, "ErrorControlled: min_step = " + inner::text(min_step) + " s is above max_step = " + inner::text(max_step) + " s");
    DELASSUS_EXPECT(output_step == 0 || output_step >= min_step,
                    "ErrorControlled: output_step = " + inner::text(output_step) + " s is below min_step = " + inner::text(min_step) + " s; take 0 for no outputs");
  }
  void run(auto& step) const { step.template state<role::Scheme>().run(step, *this); }
};

/// What the last step of a loop under `ErrorControlled` took.
template <class Loop>
const ErrorReport& error_report(const Loop& loop) {
  return loop.data().template state<role::Scheme>().report();
}

}  // namespace delassus
