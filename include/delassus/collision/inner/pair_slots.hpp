/// Where the memories of pairs lie: each in a slot of its own, which it keeps while the pair is listed.
#pragma once

#include <delassus/collision/inner/name_points.hpp>
#include <delassus/collision/inner/resting_pair.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/sort.hpp>

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace delassus::inner {

/// A job with its slot.
struct ListedPair : PairJob {
  Index slot = -1;
  bool is_asked = false;  ///< it has contacts, or is apart and asked whether it meets in the step
};

/// Looks jobs up by their pairs, which are mostly asked in the order of the jobs: the first `count` of a list
/// that is sorted, and may grow meanwhile.
class JobFinder {
 public:
  JobFinder(Array<ListedPair>& jobs, std::size_t count) : jobs_(jobs), count_(count) {}
  /// −1 where there is none.
  Index find(std::uint64_t pair) {
    ListedPair* const first = jobs_.data();
    if (next_ == unknown || (next_ > 0 && !(first[next_ - 1].pair < pair)))
      next_ = std::size_t(inner::lower_bound(first, first + count_, pair,
                                             [](const ListedPair& job, std::uint64_t key) {
                                               return job.pair < key;
                                             }) -
                          first);
    while (next_ < count_ && first[next_].pair < pair) ++next_;
    return next_ < count_ && first[next_].pair == pair ? Index(next_) : Index(-1);
  }

 private:
  static constexpr std::size_t unknown = std::size_t(-1);
  Array<ListedPair>& jobs_;
  std::size_t count_, next_ = unknown;
};

/// A memory is large and most pairs stay from step to step: lists of pairs change, memories do not move.
class PairSlots {
 public:
  /// Gives each pair of the list, which is sorted by pair, the slot that it had, or a fresh one. Slots of all others are free then.
  void assign(Array<ListedPair>& list) {
    next_.clear();
    next_.reserve(list.capacity());  // now, and not when the pairs change next in a warm step
    known_.reserve(list.capacity());
    std::size_t last = 0;
    for (ListedPair& job : list) {
      while (last < known_.size() && known_[last].pair < job.pair) free_.push_back(known_[last++].slot);
      job.slot = last < known_.size() && known_[last].pair == job.pair ? known_[last++].slot : take(job.pair);
      next_.push_back({job.pair, job.slot});
    }
    for (; last < known_.size(); ++last) free_.push_back(known_[last].slot);
    known_.swap(next_);
    free_.reserve(slot_.capacity());
  }
  [[gnu::always_inline]] RestingPair& operator[](Index slot) { return slot_[slot]; }

  /// Of pairs; and the memory of the k-th of them.
  Index count() const { return Index(known_.size()); }
  const RestingPair& memory_of(Index k) const { return slot_[known_[std::size_t(k)].slot]; }

  /// f(memory) of each pair in the order of pairs.
  template <class F>
  void each(const F& f) {
    for (const Known& k : known_) f(slot_[k.slot]);
  }
  /// As a list by pair, and nothing in it that is not meant.
  void memory(auto& archive) {
    if (!archive.reads) copy_to(listed_);
    archive(listed_);
    if (archive.reads) take_from(listed_);
  }
  void copy_to(Array<RestingPair>& pairs) const {
    pairs.clear();
    pairs.reserve(known_.size());
    for (const Known& k : known_) {
      const RestingPair& from = slot_[k.slot];
      pairs.emplace_back();
      RestingPair& to = pairs[pairs.size() - 1];
      std::memset(static_cast<void*>(&to), 0, sizeof to);
      to.copy(from);
      to.margin = from.margin;
      if (from.margin < 0) continue;
      to.shapes = from.shapes, to.normal_a = from.normal_a, to.normal_b = from.normal_b;
      for (int i = 0; i < from.count; ++i) to.gap[i] = from.gap[i], to.by_id[i] = from.by_id[i];
    }
  }
  void take_from(const Array<RestingPair>& pairs) {
    slot_ = pairs;
    free_.clear();
    known_.clear();
    for (Index k = 0; k < Index(slot_.size()); ++k) {
      slot_[k].see_if_plain();
      known_.push_back({slot_[k].pair, k});
    }
  }

 private:
  struct Known {
    std::uint64_t pair;
    Index slot;
  };

  Index take(std::uint64_t pair) {
    if (free_.empty()) {
      slot_.emplace_back();
      free_.push_back(Index(slot_.size()) - 1);
    }
    const Index slot = free_.back();
    free_.pop_back();
    slot_[slot].reset(pair);
    return slot;
  }

  Array<RestingPair> slot_;
  Array<Index> free_;
  Array<Known> known_, next_;  ///< by pair
  Array<RestingPair> listed_;  ///< room for `memory`
};

}  // namespace delassus::inner
