/// The solved constraint problem of a step, whole, for another thread.
#pragma once

#include <delassus/core/roles.hpp>
#include <delassus/core/status.hpp>
#include <delassus/listeners/triple_buffer.hpp>
#include <delassus/loop/channels.hpp>
#include <delassus/loop/stage.hpp>

#include <cstdint>
#include <type_traits>

namespace delassus {

/// A constraint problem as it was when a step had solved it: W, d, λ, the rows and the typed items.
template <class Problem>
struct Snapshot {
  Problem problem;
  std::uint64_t sequence = 0;  ///< 1 for the first; one that is passed over leaves a gap
  double time = 0;             ///< s, simulated, at the start of the step
  Status status = Status::converged;
};

namespace inner {

/// W as a matrix: a copy of it is whole without the bodies.
template <class Operator>
concept AssembledOperator = requires(const Operator& W) { W.template blocks<0, 0>(); };

/// Sequence numbers, and the copy of a loop's problem.
template <class Loop, class Problem>
void take_snapshot(const Loop& loop, std::uint64_t sequence, Snapshot<Problem>& to) {
  loop.copy_problem(to.problem);
  to.sequence = sequence;
  to.time = loop.time();
  to.status = loop.report().status;
}

}  // namespace inner

/// Publishes the problem of every step as soon as it is solved. The reader never waits and never makes the loop wait:
///
///     auto& channel = loop.channel<DoubleBuffer>();     // before the threads start
///     if (channel.fetch()) look_at(channel.front());    // in the reader's thread, whenever it likes
///
/// What the front holds is the reader's own until it fetches again: it may change λ and d there and solve anew. Arrays keep
/// their capacity: after the largest problem has passed through the three slots, publishing allocates nothing.
/// (Two slots would do only if one thread could wait for the other.)
struct DoubleBuffer {
  using plays = role::Listener;
  using listens = Listens<stage::Solve>;

  template <class Problem>
  class Channel {
   public:
    explicit Channel(const DoubleBuffer&) {}

    /// The reader: takes the newest snapshot, true if it was not taken before.
    bool fetch() { return snapshots_.fetch(); }
    Snapshot<Problem>& front() { return snapshots_.front(); }

    /// The loop's thread.
    void publish(const auto& loop) {
      inner::take_snapshot(loop, ++sequence_, snapshots_.back());
      snapshots_.publish();
    }

   private:
    TripleBuffer<Snapshot<Problem>> snapshots_;
    std::uint64_t sequence_ = 0;
  };

  template <class Problem>
  static consteval bool can_publish() {
    if constexpr (std::is_void_v<Problem>) {
      static_assert(!std::is_void_v<Problem>,
                    "delassus: DoubleBuffer publishes the constraint problem, and this loop has none; add "
                    "Constraints{...}, or take DoubleBuffer out");
      return false;
    } else {
      constexpr bool is_matrix = inner::AssembledOperator<decltype(Problem::W)>;
      static_assert(is_matrix,
                    "delassus: DoubleBuffer publishes W as a matrix, and this compliance never forms it; take "
                    "AssembledCompliance");
      return is_matrix;
    }
  }

  void after(stage::Solve, const auto& loop) const { loop.template channel<DoubleBuffer>().publish(loop); }
};

}  // namespace delassus
