/// Records a running loop for the replay page.
#pragma once

#include <delassus/bodies/invariants.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/io/recording.hpp>
#include <delassus/listeners/stopwatch.hpp>
#include <delassus/rows/alive.hpp>
#include <delassus/step/stage.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

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
/// a step. A Stopwatch listed before it gives the stage times. A joint is drawn from the centre of one body
/// through its anchors to the centre of the other, a soft body as the edges of its surface.
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
    if (recording_.wants_frame(loop.time())) add_frame(loop);
  }

 private:
  void begin(const auto& loop) {
    recording_.steps.tolerance = inner::tolerance_of(loop);
    loop.world().each([&](const auto& set, auto s) {
      for (const Index b : alive(set)) {
        if (set.has_collider(b))
          recording_.bodies.push_back(recorded_body(set.shape(b), is_fixed(set, b)));
        else
          recording_.bodies.push_back(recorded_particle(has_mesh<decltype(set)> ? 1e-3 : 0.03));
      }
      each_mesh(set, [&](Index, auto, const auto& body) { find_edges(Index(s), body); });
    });
  }

  template <class Set>
  static constexpr bool has_mesh = requires(const std::remove_cvref_t<Set>& set) {
    set.each_mesh([](Index, auto, const auto&) {});
  };

  static void each_mesh(const auto& set, const auto& f) {
    if constexpr (has_mesh<decltype(set)>) set.each_mesh(f);
  }

  /// The edges of a body's surface, each once, by blocks of its set.
  void find_edges(Index set, const auto& body) {
    const std::size_t first = edges_.size();
    for (const auto& t : surface(body.mesh()))
      for (int k = 0; k < 3; ++k) {
        const Index a = t[k], b = t[(k + 1) % 3];
        edges_.push_back({set, body.blocks()[std::min(a, b)], body.blocks()[std::max(a, b)]});
      }
    std::sort(edges_.begin() + std::ptrdiff_t(first), edges_.end());
    edges_.erase(std::unique(edges_.begin() + std::ptrdiff_t(first), edges_.end()), edges_.end());
  }

  /// A kinematic body has no mass that answers, and moves.
  static bool is_fixed(const auto& set, Index b) {
    if constexpr (requires { set.motion(b); })
      return set.motion(b) == Motion::fixed;
    else
      return !set.moves(b);
  }

  void add_frame(const auto& loop) {
    RecordedFrame frame;
    frame.time = loop.time();
    loop.world().each([&](const auto& set, auto) {
      for (const Index b : alive(set)) {
        const Pose pose = set.pose(b);
        frame.poses.push_back({pose.position, Quat(pose.rotation)});
      }
    });
    if constexpr (requires { loop.contacts(); })
      for (const auto& c : loop.contacts()) {
        if (c.impulse.dot(c.record.normal) > 0)
          frame.contacts.push_back(
              {c.record.point(), c.impulse, c.is_sliding ? RecordedState::sliding : RecordedState::sticking});
      }
    loop.each_joint([&](const Anchor& a, const Anchor& b) { add_joint(frame, loop.world(), a, b); });
    loop.world().each([&](const auto& set, auto s) {
      for (const auto& [of, a, b] : edges_)
        if (of == Index(s)) frame.lines.push_back({set.pose(a).position, set.pose(b).position});
    });
    recording_.frames.push_back(std::move(frame));
  }

  static void add_joint(RecordedFrame& frame, const auto& world, const Anchor& a, const Anchor& b) {
    const Vec3 xa = world.point(a), xb = world.point(b);
    frame.lines.push_back({xa, xb});
    add_arm(frame, world, a, xa);
    add_arm(frame, world, b, xb);
  }
  /// From the centre of the anchor's body to the anchor; the world has no centre.
  static void add_arm(RecordedFrame& frame, const auto& world, const Anchor& anchor, const Vec3& end) {
    world.visit(anchor.set, [&](const auto& set, auto) {
      const Vec3 centre = set.pose(anchor.block).position;
      if (centre != end) frame.lines.push_back({centre, end});
    });
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
  std::vector<std::array<Index, 3>> edges_;  ///< set and two of its blocks
};

}  // namespace delassus
