/// Places in an array that can be given back and reused, each with a generation, so that nothing ever moves.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>

#include <algorithm>
#include <cstdint>

namespace delassus {

/// Hands out indices. `take` reuses the place freed last; `active` lists the live ones that are awake, ascending.
class Slots {
 public:
  /// A free place; `size()` has grown when it is a new one.
  Index take() {
    Index place = size();
    if (free_.empty()) {
      generation_.push_back(first_);
      alive_.push_back(1);
    } else {
      place = free_.back();
      free_.pop_back();
      alive_[place] = 1;
      generation_[place] = std::max(generation_[place] + 1, first_);
    }
    list();
    return place;
  }

  void release(Index place) {
    alive_[place] = 0;
    ++removals_;
    free_.push_back(place);
    list();
  }

  Index size() const { return Index(alive_.size()); }
  /// A place asleep is alive and current, and in no list.
  void set_awake(Index place, bool is_awake) {
    alive_[place] = is_awake ? 1 : 2;
    list();
  }
  bool is_awake(Index place) const { return place >= 0 && place < size() && alive_[place] == 1; }
  bool is_alive(Index place) const { return place >= 0 && place < size() && alive_[place] != 0; }
  bool is_current(Index place, std::uint32_t generation) const {
    return is_alive(place) && generation_[place] == generation;
  }
  /// Has grown when places that were alive may not be any more, by `release` or because other slots were assigned.
  std::uint32_t removals() const { return removals_.value; }
  /// Of a free place that of its last owner.
  std::uint32_t generation(Index place) const { return generation_[place]; }
  const Array<Index>& active() const {
    if (stale_) [[unlikely]] gather();
    return active_;
  }

  static void each_array(auto& self, auto&& f) {
    f(self.generation_), f(self.alive_), f(self.free_), f(self.active_);
  }

  /// What outlives a step. Whoever is given a place after it was read has a generation that nobody had before.
  void memory(auto& archive) {
    if (archive.reads)
      for (const std::uint32_t generation : generation_) first_ = std::max(first_, generation + 1);
    archive(generation_, alive_, free_);
    ++removals_;
    list();
  }

 private:
  void list() { stale_ = true; }
  /// Apart from `active`, so that asking for a list that is there stays a look at one flag.
  [[gnu::noinline]] void gather() const {
    active_.clear();
    for (Index i = 0; i < size(); ++i)
      if (alive_[i] == 1) active_.push_back(i);
    stale_ = false;
  }

  /// A count that grows with what is assigned to it, too: it is never again what it was.
  struct Growing {
    std::uint32_t value = 0;

    Growing() = default;
    Growing(const Growing&) = default;
    Growing& operator=(const Growing& o) {
      value = std::max(value, o.value) + 1;
      return *this;
    }
    void operator++() { ++value; }
  };

  Growing removals_;
  std::uint32_t first_ = 0;  ///< the least generation that is given
  Array<std::uint32_t> generation_;
  Array<char> alive_;  ///< 0 free, 1 awake, 2 asleep
  Array<Index> free_;
  mutable Array<Index> active_;
  mutable bool stale_ = false;
};

}  // namespace delassus
