/// Many worlds of one loop type, all at once, for steps in turn with what a program does between them.
#pragma once

#include <delassus/core/archive.hpp>
#include <delassus/core/execution.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/status.hpp>
#include <delassus/io/checkpoint.hpp>
#include <delassus/loop/why_quarantined.hpp>
#include <delassus/step/step_report.hpp>
#include <delassus/study/inner/failure_of.hpp>

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace delassus {

/// `Batch{make_loop, parameters, Threads{}}`: make_loop(parameters[i]) returns the loop of world i. The worlds do not meet: each has the
/// bits that it has alone, whatever the execution. Warm steps and resets allocate nothing but what the loops and the execution do.
template <class MakeLoop, class P, Execution E = Serial>
class Batch {
 public:
  using Loop = std::invoke_result_t<const MakeLoop&, const P&>;  ///< of each world
  static_assert(!std::is_reference_v<Loop>, "delassus: make_loop of a Batch must return a new loop, not a reference to one");

  /// Makes all loops, on several threads at once, and keeps the state of each for `reset`. Throws InvalidArgument when there are no
  /// parameters, and whatever make_loop throws.
  Batch(const MakeLoop& make_loop, std::vector<P> parameters, E execution = {})
      : parameters_(std::move(parameters)), execution_(std::move(execution)), worlds_(parameters_.size()) {
    DELASSUS_EXPECT(!parameters_.empty(), "batch: the list of parameters is empty; give it those of one world at least");
    execution_.run(size(), [&](Index i, Index) {
      worlds_[std::size_t(i)].reset(new World{make_loop(parameters_[std::size_t(i)])});
      ArchiveWriter archive;
      loop(i).memory(archive);
      world(i).start = std::move(archive.data);
    });
  }

  Index size() const { return Index(worlds_.size()); }  ///< worlds
  Loop& loop(Index i) { return world(i).loop; }  ///< of world i
  const Loop& loop(Index i) const { return world(i).loop; }  ///< the same
  /// What world i was made from.
  const P& parameters(Index i) const { return parameters_[place(i)]; }
  /// Of its last step, whether it failed or not.
  const StepReport& report(Index i) const { return world(i).report; }
  /// Why world i is not stepped any more: a step threw, or a body was quarantined. Empty while it is sound.
  const std::string& failure(Index i) const { return world(i).failure; }

  /// Moves every world that has not failed by h seconds. Throws InvalidArgument unless h is finite and > 0.
  void step(double h) {
    inner::expect_positive("batch: h", h, "s");
    execution_.run(size(), [this, h](Index i, Index) {
      World& w = world(i);
      if (w.failure.empty()) w.failure = inner::failure_of([&] { w.report = w.loop.step(h); });
      if (w.failure.empty() && w.report.status == Status::quarantined) w.failure = why_quarantined(w.loop);
    });
  }

  /// f(loop, parameters, i) for each world, failed ones included, several at once: to act on it, to observe it, to reset it. What f throws
  /// passes through.
  template <class F>
  void each(F&& f) {
    execution_.run(size(), [this, &f](Index i, Index) { f(loop(i), parameters(i), i); });
  }

  /// Gives world i the state that make_loop gave it; numbers of policies stay as they are. Handles that were good then are good again.
  void reset(Index i) {
    World& w = world(i);
    ArchiveReader archive(w.start);
    w.loop.memory(archive);
    w.report = {}, w.failure.clear();
  }
  /// Or that of a `checkpoint`. Throws InvalidArgument as `restore` does, the world being as it was.
  void reset(Index i, std::span<const char> checkpoint) {
    World& w = world(i);
    restore(w.loop, checkpoint);
    w.report = {}, w.failure.clear();
  }
  /// All of them, to what make_loop gave.
  void reset() {
    execution_.run(size(), [this](Index i, Index) { reset(i); });
  }

 private:
  struct World {
    Loop loop;
    StepReport report{};
    std::string failure{};
    std::vector<char> start{};
  };

  std::size_t place(Index i) const {
    DELASSUS_EXPECT(i >= 0 && i < size(), "batch: there is no world " + std::to_string(i) + " among " + std::to_string(size()));
    return std::size_t(i);
  }
  World& world(Index i) { return *worlds_[place(i)]; }
  const World& world(Index i) const { return *worlds_[place(i)]; }

  std::vector<P> parameters_;
  E execution_;
  std::vector<std::unique_ptr<World>> worlds_;
};

}  // namespace delassus
