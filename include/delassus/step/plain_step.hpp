/// A step from begin to advance, on one page.
#pragma once

#include <delassus/step/inner/lead.hpp>
#include <delassus/step/move_freely.hpp>
#include <delassus/step/moves_at_once.hpp>
#include <delassus/step/notify.hpp>
#include <delassus/step/stage.hpp>

#include <tuple>
#include <type_traits>

namespace delassus {

template <class Step>
using StagesOf = typename std::remove_reference_t<Step>::Stages;

/// One function a stage: it does its work, see `PlainStages`, and then the listeners hear of it. A host that interleaves
/// its own work calls them one by one on `loop.data()`.
namespace stage {

void begin(auto& step, double h) { inner::lead(step, h), StagesOf<decltype(step)>::begin(step, h), inner::notify<Begin>(step); }
void detect(auto& step) { StagesOf<decltype(step)>::detect(step), inner::notify<Detect>(step); }
void linearize(auto& step) { StagesOf<decltype(step)>::linearize(step), inner::notify<Linearize>(step); }
void free_motion(auto& step) { StagesOf<decltype(step)>::free_motion(step), inner::notify<FreeMotion>(step); }
void find_islands(auto& step) { StagesOf<decltype(step)>::find_islands(step), inner::notify<Islands>(step); }
void make_bias(auto& step) { StagesOf<decltype(step)>::make_bias(step), inner::notify<Bias>(step); }
void build(auto& step) { StagesOf<decltype(step)>::build(step), inner::notify<Build>(step); }
void solve(auto& step) { StagesOf<decltype(step)>::solve(step), inner::notify<Solve>(step); }
void correct(auto& step) { StagesOf<decltype(step)>::correct(step), inner::notify<Correct>(step); }
void advance(auto& step) { StagesOf<decltype(step)>::advance(step), inner::notify<Advance>(step); }
/// After Correct: true where bodies that Detect left out meet by v_next. Then Linearize to Correct are to be done again.
bool find_missed(auto& step) { return StagesOf<decltype(step)>::find_missed(step); }

/// All after Detect; from Linearize to Correct again where bodies that Detect left out meet by v_next. Where nothing holds the
/// bodies and nobody listens, each goes its way in one pass.
void move(auto& step) {
  using Data = std::remove_reference_t<decltype(step)>;
  if constexpr (Data::moves_freely) {
    move_freely(step);
  } else {
    if constexpr (MovesAtOnce<typename Data::Policies::Integrator>) {
      step.integrator().move(step);
    } else {
      using Stages = StagesOf<decltype(step)>;
      do {
        Stages::linearize(step), inner::notify<Linearize>(step);
        Stages::free_motion(step), inner::notify<FreeMotion>(step);
        Stages::find_islands(step), inner::notify<Islands>(step);
        Stages::make_bias(step), inner::notify<Bias>(step);
        Stages::build(step), inner::notify<Build>(step);
        Stages::solve(step), inner::notify<Solve>(step);
        Stages::correct(step), inner::notify<Correct>(step);
      } while (Stages::find_missed(step));
    }
    advance(step);
  }
}

}  // namespace stage

}  // namespace delassus
