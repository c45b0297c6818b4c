/// One pass after the other, as a host calls them that interleaves its own work.
#pragma once

/// A step up to the velocities after the impulses: the bodies have not moved yet.
template <class Loop>
void solve_by_stages(Loop& loop, double h) {
  loop.begin(h);
  loop.detect();
  loop.linearize();
  loop.free_motion();
  loop.find_islands();
  loop.make_bias();
  loop.build();
  loop.solve();
  loop.correct();
}

template <class Loop>
void step_by_stages(Loop& loop, double h) {
  solve_by_stages(loop, h);
  loop.advance();
}
