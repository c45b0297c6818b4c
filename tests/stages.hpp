/// One pass after the other, as a host calls them that interleaves its own work.
#pragma once

#include <delassus/step/plain_step.hpp>

namespace stage = delassus::stage;

/// From Linearize to Build: rows, W and d are there.
template <class Step>
void linearize_to_build(Step& step) {
  stage::linearize(step);
  stage::free_motion(step);
  stage::find_islands(step);
  stage::make_bias(step);
  stage::build(step);
}

/// A step up to the velocities after the impulses: the bodies have not moved yet.
template <class Loop>
void solve_by_stages(Loop& loop, double h) {
  auto& step = loop.data();
  stage::begin(step, h);
  stage::detect(step);
  do {
    linearize_to_build(step);
    stage::solve(step);
    stage::correct(step);
  } while (stage::find_missed(step));
}

template <class Loop>
void step_by_stages(Loop& loop, double h) {
  solve_by_stages(loop, h);
  stage::advance(loop.data());
}
