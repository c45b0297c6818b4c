/// A step from begin to advance, on one page.
#pragma once

#include <delassus/step/move_freely.hpp>
#include <delassus/step/notify.hpp>
#include <delassus/step/stage.hpp>

#include <tuple>
#include <type_traits>

namespace delassus {

template <class Step>
using StagesOf = typename std::remove_reference_t<Step>::Stages;

namespace inner {
struct StepProbe;
}

/// An integrator that makes its step at once, joints and bodies together, brings all between Detect and Advance:
/// `void move(auto& step) const`.
template <class I>
concept MovesAtOnce = requires(const I& integrator, inner::StepProbe& step) { integrator.move(step); };

/// One function a stage: it does its work, see `PlainStages`, and then the listeners hear of it. A host that interleaves
/// its own work calls them one by one on `loop.data()`.
namespace stage {

void begin(auto& step, double h) { StagesOf<decltype(step)>::begin(step, h), inner::notify<Begin>(step); }
void detect(auto& step) { StagesOf<decltype(step)>::detect(step), inner::notify<Detect>(step); }
void linearize(auto& step) { StagesOf<decltype(step)>::linearize(step), inner::notify<Linearize>(step); }
void free_motion(auto& step) { StagesOf<decltype(step)>::free_motion(step), inner::notify<FreeMotion>(step); }
void find_islands(auto& step) { StagesOf<decltype(step)>::find_islands(step), inner::notify<Islands>(step); }
void make_bias(auto& step) { StagesOf<decltype(step)>::make_bias(step), inner::notify<Bias>(step); }
void build(auto& step) { StagesOf<decltype(step)>::build(step), inner::notify<Build>(step); }
void solve(auto& step) { StagesOf<decltype(step)>::solve(step), inner::notify<Solve>(step); }
void correct(auto& step) { StagesOf<decltype(step)>::correct(step), inner::notify<Correct>(step); }
void advance(auto& step) { StagesOf<decltype(step)>::advance(step), inner::notify<Advance>(step); }

/// All after Detect. Where nothing holds the bodies and nobody listens, each goes its way in one pass.
void move(auto& step) {
  using Data = std::remove_reference_t<decltype(step)>;
  if constexpr (Data::moves_freely) {
    move_freely(step);
  } else {
    if constexpr (MovesAtOnce<typename Data::Policies::Integrator>) {
      step.integrator().move(step);
    } else {
      using Stages = StagesOf<decltype(step)>;
      Stages::linearize(step), inner::notify<Linearize>(step);
      Stages::free_motion(step), inner::notify<FreeMotion>(step);
      Stages::find_islands(step), inner::notify<Islands>(step);
      Stages::make_bias(step), inner::notify<Bias>(step);
      Stages::build(step), inner::notify<Build>(step);
      Stages::solve(step), inner::notify<Solve>(step);
      Stages::correct(step), inner::notify<Correct>(step);
    }
    advance(step);
  }
}

}  // namespace stage

}  // namespace delassus
