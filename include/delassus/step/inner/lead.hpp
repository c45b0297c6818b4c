/// Listeners that lead kinematic bodies are asked where these are at the end of a step.
#pragma once

#include <type_traits>

namespace delassus::inner {

/// Calls `lead(world, t, h)` of who has it, before a step of h (s). A scheme with `leads_parts` asks for each
/// of its parts instead.
[[gnu::always_inline]] inline void lead(auto& step, double h) {
  using Scheme = typename std::remove_reference_t<decltype(step)>::Policies::Scheme;
  if constexpr (!(requires { requires Scheme::leads_parts; }))
    step.policies.each([&](auto& policy) __attribute__((always_inline)) {
      if constexpr (requires { policy.lead(step.world(), h, h); }) policy.lead(step.world(), step.time(), h);
    });
}

}  // namespace delassus::inner
