/// Three copies of a value between one thread that writes and one that reads: neither ever waits.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace delassus {

/// At each moment one slot is the writer's, one the reader's, and one lies between them. The atomic byte `middle_` names
/// the one between, and says whether it is newer than the reader's.
///
///   Publish: The writer's slot goes to the middle, the middle's to the writer.
///   Fetch:   If the middle is newer, it goes to the reader, and the reader's to the middle.
///
/// Each is one atomic exchange, so a slot has one owner at all times: No read can be torn, and the reader gets the newest
/// that was published before it asked. What it did not ask for in time is overwritten, never queued.
///
/// Memory order. The exchange releases the slot that is given away, with all that was written there, and acquires the one
/// that is taken: `acq_rel` on both sides, since the reader may write in its slot too. The reader's first look is
/// `relaxed`: It orders nothing, and what it decides to take it takes by the exchange.
///
/// One thread calls back and publish, one calls front and fetch. Slots are built in place and never move.
template <class T>
class TripleBuffer {
 public:
  /// f(slot) for all three, before there are two threads.
  void each(auto&& f) {
    for (T& slot : slots_) f(slot);
  }

  /// The writer's slot: some older value, to be written over.
  T& back() { return slots_[back_]; }

  /// Hands the writer's slot over. Wait-free.
  void publish() {
    back_ = middle_.exchange(std::uint8_t(back_ | is_fresh), std::memory_order_acq_rel) & index;
  }

  /// Takes the newest value, if there is one that was not taken before. Wait-free.
  bool fetch() {
    if (!(middle_.load(std::memory_order_relaxed) & is_fresh)) return false;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & index;
    return true;
  }

  /// The reader's slot: what `fetch` took last, the reader's own until it fetches again.
  T& front() { return slots_[front_]; }

 private:
  static constexpr std::uint8_t index = 3, is_fresh = 4;
  static_assert(std::atomic<std::uint8_t>::is_always_lock_free);

  std::array<T, 3> slots_{};
  // Each on a cache line of its own: the two threads share `middle_` and nothing else.
  alignas(64) std::uint8_t back_ = 0;
  alignas(64) std::atomic<std::uint8_t> middle_{1};
  alignas(64) std::uint8_t front_ = 2;
};

}  // namespace delassus
