/// What a study compares its runs with: the scene itself, at finer steps, more than once.
#pragma once

#include <delassus/core/expect.hpp>

#include <tuple>
#include <utility>

namespace delassus {

/// The scene with these policies at 1/refinement of the plan's smallest step.
template <class... P>
struct Refined {
  int refinement;  ///< at least 1
  std::tuple<P...> policies;  ///< what the scene is called with
};

/// `refined(10, ImplicitMidpoint{}, GaussSeidel{.tolerance = 1e-12})`.
template <class... P>
Refined<P...> refined(int refinement, P... policies) {
  DELASSUS_EXPECT(refinement >= 1, "refined: the refinement of a reference must be >= 1");
  return {refinement, {std::move(policies)...}};
}

/// The first run is the reference; the largest distance to the others is its uncertainty. Take another
/// integrator for them: one method at two steps agrees with itself where both are wrong. A method of first
/// order may be refined more.
template <class... R>
struct References {
  static constexpr int count = int(sizeof...(R));  ///< at least 2 where a measure has no exact(t)
  std::tuple<R...> runs;  ///< in the order given

  References() = default;
  /// At least one.
  explicit References(R... r) requires(sizeof...(R) > 0) : runs(std::move(r)...) {}
};
/// `References{refined(...), refined(...)}`.
template <class... R>
References(R...) -> References<R...>;

}  // namespace delassus
