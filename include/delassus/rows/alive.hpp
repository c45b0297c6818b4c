/// The bodies of a set, those asleep included.
#pragma once

#include <delassus/core/index.hpp>

#include <iterator>

namespace delassus {

/// `for (const Index b : alive(set))`: the blocks of all bodies that were added and not taken out, ascending. A set's own
/// `active` leaves out who sleeps.
template <class Set>
class alive {
 public:
  explicit alive(const Set& set) : set_(set) { skip(); }
  alive begin() const { return *this; }
  std::default_sentinel_t end() const { return {}; }

  Index operator*() const { return block_; }
  alive& operator++() {
    ++block_;
    skip();
    return *this;
  }
  bool operator==(std::default_sentinel_t) const { return block_ >= set_.blocks(); }

 private:
  void skip() {
    while (block_ < set_.blocks() && !set_.is_alive(block_)) ++block_;
  }
  const Set& set_;
  Index block_ = 0;
};

}  // namespace delassus
