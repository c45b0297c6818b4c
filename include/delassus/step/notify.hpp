/// How a step notifies the listeners of its stages.
#pragma once

#include <delassus/core/roles.hpp>
#include <delassus/solvers/island_problem.hpp>

#include <type_traits>
#include <utility>

namespace delassus::inner {

/// A listener that hears a stage between Begin and Step.
template <class P>
inline constexpr bool listens_inside_step = requires { requires P::listens::inside_step; };

/// A listener that hears this stage.
template <class P, class Stage>
inline constexpr bool hears_stage = Plays<P, role::Listener> && requires { requires P::listens::template to<Stage>; };

/// A listener that wants to be told of every sweep of the solver.
template <class P>
inline constexpr bool observes_sweeps = requires { requires P::every_sweep; };

template <class Listener, class Step, class Stage>
consteval bool hears() {
  constexpr bool all = requires(Listener& l, const Step& step) { l.after(Stage{}, step); };
  static_assert(all,
                "delassus: this listener declares a stage in `listens` for which it has no after(stage::X, step); write "
                "it, or take the stage out of the list");
  return all;
}

/// Every listener that hears this stage, in the order of the arguments.
template <class Stage>
[[gnu::always_inline]] inline void notify(auto& step) {
  using Step = std::remove_reference_t<decltype(step)>;
  if constexpr (Step::Policies::template hears_stage<Stage>)
    step.policies.each([&](auto& policy) {
      using P = std::remove_reference_t<decltype(policy)>;
      if constexpr (hears_stage<P, Stage>)
        if constexpr (hears<P, Step, Stage>()) policy.after(Stage{}, std::as_const(step));
    });
}

/// f(observer): the first listener that wants every sweep, or one that wants nothing.
template <class F>
void with_observer(auto& step, F&& f) {
  if constexpr (std::remove_reference_t<decltype(step)>::observes_sweeps) {
    bool is_done = false;
    step.policies.each([&](auto& policy) {
      if constexpr (observes_sweeps<std::remove_reference_t<decltype(policy)>>)
        if (!std::exchange(is_done, true)) f(policy);
    });
  } else {
    NoObserver nobody;
    f(nobody);
  }
}

}  // namespace delassus::inner
