/// What the rows of delassus_ladders share: a run that is watched at every step.
#pragma once

#include "ladder.hpp"

#include <delassus/delassus.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <type_traits>

namespace ladders {

using namespace delassus;

inline constexpr double g = 9.81, frame = 1.0 / 60;

template <class... Values>
std::string format(const char* pattern, Values... values) {
  char buffer[96];
  std::snprintf(buffer, sizeof buffer, pattern, values...);
  return buffer;
}

/// The larger of two numbers; what is not finite once stays so, where std::max would drop it.
inline double most(double seen, double now) { return now > seen || std::isnan(now) ? now : seen; }

/// Kinetic and potential energy of all bodies, J. (Springs between particles included, soft joints not.)
double energy(const auto& loop) {
  double sum = 0;
  loop.world().each([&](const auto& set, auto) { sum += kinetic_energy(set) + potential_energy(set); });
  return sum;
}

/// The largest speed of a body, m/s.
double top_speed(const auto& loop) {
  double top = 0;
  loop.world().each([&](const auto& set, auto) {
    for (const Index b : alive(set))
      if (set.moves(b)) top = most(top, double(set.velocity()[b].template head<3>().norm()));
  });
  return top;
}

/// What a run showed at its worst.
struct Seen {
  double penetration = 0, joint_gap = 0, residual = 0, speed = 0;
  double gain = 0;      ///< of energy above the start, J
  int sweeps = 0;       ///< or factorizations, of the step that took most
  int unconverged = 0;  ///< steps that did not converge, and said so
  double first_energy = 0, last_energy = 0;
  double last_penetration = 0;  ///< of the last step, m
  double last_overlap = 0;      ///< the mean of its contacts that overlap, m
};

namespace inner {

/// each(step), or each(step, what was seen up to it).
template <class F>
void call(F& each, int step, const Seen& seen) {
  if constexpr (std::is_invocable_v<F&, int, const Seen&>) each(step, seen);
  else each(step);
}

/// The mean of the overlaps of the last step's contacts, m.
double mean_overlap(const auto& loop) {
  double sum = 0;
  int touching = 0;
  if constexpr (requires { loop.contacts(); })
    for (const ContactResult& contact : loop.contacts())
      if (contact.record.gap < 0) sum -= contact.record.gap, ++touching;
  return touching ? sum / touching : 0;
}

}  // namespace inner

/// The same run where poses and velocities say what is seen, and another engine may move the bodies.
template <class Loop, class F>
Seen run_compared(Ladder& ladder, Loop& loop, double seconds, double h, F& each) {
  peers::Course<Loop> course(*ladder.comparison(), loop, h);
  Seen seen;
  seen.first_energy = course.start().energy;
  const int steps = std::max(1, int(std::lround(seconds / h)));
  for (int n = 0; n < steps; ++n) {
    const peers::Reading now = course.step(h);
    seen.last_penetration = now.penetration;
    seen.last_overlap = now.mean_penetration;
    seen.penetration = most(seen.penetration, now.penetration);
    seen.joint_gap = most(seen.joint_gap, now.joint_gap);
    seen.last_energy = now.energy;
    seen.speed = most(seen.speed, now.speed);
    seen.gain = most(seen.gain, now.energy - seen.first_energy);
    inner::call(each, n, seen);
    ladder.show((n + 1.0) / steps);
  }
  return seen;
}

/// Steps the loop for `seconds` at h, calling each(step) or each(step, seen) after every step.
template <class Loop, class F>
Seen run(Ladder& ladder, Loop& loop, double seconds, double h, F&& each) {
  if (ladder.comparison()) return run_compared(ladder, loop, seconds, h, each);
  Seen seen;
  seen.first_energy = energy(loop);
  const int steps = std::max(1, int(std::lround(seconds / h)));
  for (int n = 0; n < steps; ++n) {
    const StepReport report = loop.step(h);
    seen.last_penetration = report.max_penetration;
    seen.penetration = std::max(seen.penetration, report.max_penetration);
    seen.joint_gap = std::max(seen.joint_gap, report.max_joint_violation);
    seen.residual = std::max(seen.residual, report.residual);
    seen.unconverged += report.status != Status::converged;
    if constexpr (Loop::has_constraints)
      for (const SolveReport& island : loop.island_reports())
        seen.sweeps = std::max(seen.sweeps, island.sweeps + island.factorizations);
    seen.last_energy = energy(loop);
    seen.speed = most(seen.speed, top_speed(loop));
    seen.gain = most(seen.gain, seen.last_energy - seen.first_energy);
    inner::call(each, n, seen);
    ladder.show((n + 1.0) / steps);
  }
  seen.last_overlap = inner::mean_overlap(loop);
  return seen;
}
template <class Loop>
Seen run(Ladder& ladder, Loop& loop, double seconds, double h) {
  return run(ladder, loop, seconds, h, [](int) {});
}

/// The marks every rung has: nothing gains more than the energy `scale` (J) that is in the scene, silver and
/// gold not more than a hundredth of it.
inline Mark energy_mark(const Seen& seen, double scale, double allowed = 0.01) {
  return {"energy gained / energy of the scene", seen.gain / scale, allowed, allowed, 2};
}

/// Σ of the contact forces on the bodies above a body's contacts, N, along the world's z: of contacts with
/// body a = `ground`.
double force_from(const auto& loop, Index ground) {
  double sum = 0;
  for (const ContactResult& contact : loop.contacts()) {
    if (contact.record.a.block == ground) sum += contact.impulse.z();
    if (contact.record.b.block == ground) sum -= contact.impulse.z();
  }
  return sum / loop.step_size();
}

}  // namespace ladders
