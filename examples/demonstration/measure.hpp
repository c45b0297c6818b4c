/// Runs a scene of the demonstration and gathers what the table and the page say of it.
#pragma once

#include "scene.hpp"
#include "thread_time.hpp"

#include <delassus/delassus.hpp>
#include <delassus/io/recorder.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace demonstration {

/// Steps `loop` for `seconds` by h, `drive(time)` before each step. It must list StepTime, Stopwatch and
/// Recorder, in this order.
template <class Loop, class Drive>
Scene measure(Loop& loop, const std::string& backend, double h, double seconds, const Watch& watch, Drive&& drive) {
  const int steps = int(std::lround(seconds / h));
  Scene scene{.backend = backend, .h = h, .steps = steps};
  for (int i = 0; i < steps; ++i) {
    drive(i * h);
    const StepReport report = loop.step(h);
    scene.mean_contacts += double(report.contacts) / steps;
    scene.max_penetration = std::max(scene.max_penetration, report.max_penetration);
    scene.max_joint_gap = std::max(scene.max_joint_gap, report.max_joint_violation);
    ++scene.status[std::size_t(report.status)];
    watch(double(i + 1) / steps);
  }
  loop.world().each([&](const auto& set, auto) {
    for (const Index b : set.active()) scene.bodies += set.moves(b);
    scene.kinetic_energy += kinetic_energy(set);
  });
  scene.milliseconds = mean_of(loop.template get<StepTime>().milliseconds());
  scene.recording = std::move(loop.template get<Recorder>().recording());
  return scene;
}
template <class Loop>
Scene measure(Loop& loop, const std::string& backend, double h, double seconds, const Watch& watch) {
  return measure(loop, backend, h, seconds, watch, [](double) {});
}

}  // namespace demonstration
