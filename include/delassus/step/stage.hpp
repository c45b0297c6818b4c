/// The names of the stages, for listeners.
#pragma once

#include <type_traits>

namespace delassus {

/// In the order of the plain scheme, each heard when it is done. `Begin` is heard first, `Step` when all is done.
namespace stage {
struct Begin {};
struct Detect {};
struct Linearize {};
struct FreeMotion {};
struct Islands {};
struct Bias {};
struct Build {};
struct Solve {};
struct Correct {};
struct Advance {};
struct Step {};
}  // namespace stage

/// `using listens = Listens<stage::Solve, stage::Step>;`: what a listener hears, so that a misspelt callback is an error.
template <class... Stages>
struct Listens {
  template <class Stage>
  static constexpr bool to = (std::is_same_v<Stage, Stages> || ...);
  /// Some stage between Begin and Step.
  static constexpr bool inside_step = ((!std::is_same_v<stage::Begin, Stages> && !std::is_same_v<stage::Step, Stages>) || ...);
};
using ListensToAll = Listens<stage::Begin, stage::Detect, stage::Linearize, stage::FreeMotion, stage::Islands, stage::Bias,
                             stage::Build, stage::Solve, stage::Correct, stage::Advance, stage::Step>;

}  // namespace delassus
