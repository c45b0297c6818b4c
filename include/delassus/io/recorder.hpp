/// Records a running loop for the replay page.
#pragma once

#include <delassus/bodies/invariants.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/io/inner/drawn_scene.hpp>
#include <delassus/io/recording.hpp>
#include <delassus/listeners/stopwatch.hpp>
#include <delassus/step/stage.hpp>

#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>

namespace delassus {
namespace inner {

/// What a step was asked for: by its scheme, else by the solver if there is one to ask; 0 if nobody.
template <class Loop>
double tolerance_of(const Loop& loop) {
  if constexpr (requires { loop.template policy<role::Scheme>().tolerance; }) {
    return loop.template policy<role::Scheme>().tolerance;
  } else if constexpr (requires { loop.island_reports(); }) {  // else there is no solver to look at
    if constexpr (requires { loop.template policy<role::Solver>().tolerance; }) return loop.template policy<role::Solver>().tolerance;
  }
  return 0;
}

}  // namespace inner

/// Bodies as they are when the first step ends; frames at most `frames_per_second`; a sample of every series
/// a step. A Stopwatch listed before it gives the stage times. Compounds are drawn part by part, meshes and
/// height fields as their triangles. A joint is drawn from the centre of one body through its anchors to the
/// centre of the other, a soft body as the edges of its surface.
class Recorder {
 public:
  using plays = role::Listener;
  using listens = Listens<stage::Step>;

  Recorder() = default;
  /// What the page calls the scene, a sentence under that, and the most frames a simulated second.
  Recorder(std::string name, std::string caption, double frames_per_second = 30) {
    recording_.name = std::move(name);
    recording_.caption = std::move(caption);
    recording_.frames_per_second = frames_per_second;
  }

  /// What it has so far.
  const Recording& recording() const { return recording_; }
  /// The same, to be changed or moved away.
  Recording& recording() { return recording_; }

  void after(stage::Step, const auto& loop) {
    if (recording_.bodies.empty()) begin(loop);
    sample(loop);
    if (recording_.wants_frame(loop.time())) recording_.frames.push_back(scene_.frame(loop));
  }

 private:
  void begin(const auto& loop) {
    recording_.steps.tolerance = inner::tolerance_of(loop);
    scene_.begin(loop, recording_.bodies);
  }

  void sample(const auto& loop) {
    RecordedSteps& steps = recording_.steps;
    const auto& report = loop.report();
    double energy = 0;
    loop.world().each([&](const auto& set, auto) { energy += kinetic_energy(set) + potential_energy(set); });
    steps.time.push_back(loop.time());
    steps.energy.push_back(energy);
    if constexpr (requires { loop.island_reports(); }) {
      steps.residual.push_back(report.residual);
      steps.sweeps.push_back(report.sweeps);
    }
    if constexpr (std::remove_cvref_t<decltype(loop)>::template has<Stopwatch>)
      add_times(loop.template get<Stopwatch>().last());
  }

  void add_times(const Stopwatch::Times& times) {
    auto& stages = recording_.steps.stages;
    if (stages.empty())
      for (const char* name : Stopwatch::names) stages.push_back({name, {}});
    for (std::size_t s = 0; s < times.size(); ++s) stages[s].milliseconds.push_back(times[s]);
  }

  Recording recording_;
  inner::DrawnScene scene_;
};

}  // namespace delassus
