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
/// A listener for whom contacts within the margin are there whether bodies meet or not.
template <class P>
inline constexpr bool wants_open_contacts = requires { requires P::wants_open_contacts; };

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

/// The listener that wants every sweep, of which a loop takes one: of the policies' types, and where it is.
template <class... P>
struct sweep_observer {
  using type = NoObserver;
};
template <class P, class... Rest>
struct sweep_observer<P, Rest...> : std::conditional_t<observes_sweeps<P>, std::type_identity<P>, sweep_observer<Rest...>> {};

}  // namespace delassus::inner
