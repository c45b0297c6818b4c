/// The bodies of a set, those asleep included.
#pragma once

#include <delassus/core/index.hpp>

namespace delassus {

/// `for (const Index b : alive(set))`: the blocks of all bodies that were added and not taken out, ascending. A set's own
/// `active` leaves out who sleeps.
template <class Set>
class alive {
 public:
  explicit alive(const Set& set) : set_(set) {}

  class iterator {
   public:
    iterator(const Set& set, Index block) : set_(set), block_(block) { skip(); }
    Index operator*() const { return block_; }
    iterator& operator++() {
      ++block_;
      skip();
      return *this;
    }
    bool operator!=(const iterator& other) const { return block_ != other.block_; }

   private:
    void skip() {
      while (block_ < set_.blocks() && !set_.is_alive(block_)) ++block_;
    }
    const Set& set_;
    Index block_;
  };
  iterator begin() const { return {set_, 0}; }
  iterator end() const { return {set_, set_.blocks()}; }

 private:
  const Set& set_;
};

}  // namespace delassus
