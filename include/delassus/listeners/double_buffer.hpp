/// The solved constraint problem of a step, whole, for another thread.
#pragma once

#include <delassus/core/roles.hpp>
#include <delassus/core/status.hpp>
#include <delassus/listeners/triple_buffer.hpp>
#include <delassus/step/channels.hpp>
#include <delassus/step/stage.hpp>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace delassus {

/// A constraint problem as it was when a step had solved it: W, d, λ, the rows and the typed items.
template <class Problem>
struct Snapshot {
  Problem problem;  ///< a copy that is whole without the bodies
  std::uint64_t sequence = 0;  ///< 1 for the first; one that is passed over leaves a gap
  double time = 0;             ///< s, simulated, at the start of the step
  Status status = Status::converged;  ///< of the step's report when it was solved
};

namespace inner {

/// W as a matrix: a copy of it is whole without the bodies.
template <class Operator>
concept AssembledOperator = requires(Operator& W) { W.copy_matrix(W); };

/// How long an array of a snapshot may become, and what was too long for it.
class Room {
 public:
  explicit Room(std::size_t reserve) : reserve_(reserve) {}

  /// Makes it in the arrays of one problem.
  template <class Problem>
  void make_in(Problem& problem) const {
    const auto reserve = [&](auto& array) { array.reserve(reserve_); };
    problem.laws.each_array(problem.laws, reserve);
    problem.rows.each_array(problem.rows, reserve);
    problem.W.each_array(problem.W, reserve);
    problem.islands.reserve(decltype(problem.rows)::pool_count, reserve_);
  }

  /// Whether the problem of the loop's last step has room; counted when it has not.
  template <class Loop>
  bool takes(const Loop& loop) {
    std::size_t longest = 0;
    loop.each_problem_part(
        [&](const auto& part) { part.each_array(part, [&](const auto& a) { longest = std::max(longest, a.size()); }); });
    if (longest > needed()) needed_.store(longest, std::memory_order_relaxed);
    if (reserve_ == 0 || longest <= reserve_) return true;
    skipped_.fetch_add(1, std::memory_order_relaxed);
    return false;
  }

  /// How many problems were passed over for want of room, and the longest array of all so far. Any thread may ask.
  std::uint64_t skipped() const { return skipped_.load(std::memory_order_relaxed); }
  std::size_t needed() const { return needed_.load(std::memory_order_relaxed); }

 private:
  std::size_t reserve_;
  std::atomic<std::uint64_t> skipped_{0};
  std::atomic<std::size_t> needed_{0};
};

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
/// What the front holds is the reader's own until it fetches again. It may change λ and d there and solve anew.
///
/// With `DoubleBuffer{.reserve = 4096}` each array of a snapshot has room for so many elements from the start, and publishing
/// allocates nothing, ever. A problem that is larger is passed over, and counted in `skipped`. Without, arrays grow and keep
/// their capacity.
/// (Two slots would do only if one thread could wait for the other.)
struct DoubleBuffer {
  using plays = role::Listener;
  using listens = Listens<stage::Solve>;
  std::size_t reserve = 0;  ///< elements of an array; the longest are the blocks of W between two laws. 0: as it comes

  /// What `loop.channel<DoubleBuffer>()` returns, for both threads.
  template <class Problem>
  class Channel : inner::Room {
   public:
    /// Takes the room that `parameters` ask for.
    explicit Channel(const DoubleBuffer& parameters) : Room(parameters.reserve) {
      snapshots_.each([&](auto& snapshot) { this->make_in(snapshot.problem); });
    }

    using Room::skipped, Room::needed;

    /// The reader: takes the newest snapshot, true if it was not taken before.
    bool fetch() { return snapshots_.fetch(); }
    /// The reader: what was taken last.
    Snapshot<Problem>& front() { return snapshots_.front(); }

    /// The loop's thread.
    void publish(const auto& loop) {
      ++sequence_;
      if (!this->takes(loop)) return;
      inner::take_snapshot(loop, sequence_, snapshots_.back());
      snapshots_.publish();
    }

   private:
    TripleBuffer<Snapshot<Problem>> snapshots_;
    std::uint64_t sequence_ = 0;
  };

  /// Asked by the checks: says what the loop lacks, constraints or W as a matrix.
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
