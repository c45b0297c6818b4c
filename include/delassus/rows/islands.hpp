/// Groups of constraints that share no moving body: each is solved, stopped, slept and lost by itself.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/owning_array.hpp>
#include <delassus/core/slice.hpp>
#include <delassus/rows/row_arrays.hpp>
#include <delassus/rows/row_system.hpp>

#include <cstddef>

namespace delassus {

/// Union-find over the blocks of H. Blocks that do not move (A⁻¹ = 0) join nothing.
///
/// Islands are numbered by their lowest block, items inside go by pool and insertion: a body far away changes
/// no order, hence no bit. An item without a moving block belongs to no island; its impulse stays zero.
template <class T>
class Islands {
  struct Items {
    Array<Index> lowest;         ///< by item: a block that it holds, or −1
    Array<Index> sorted, start;  ///< the items of island k are sorted[start[k]] … sorted[start[k + 1] − 1]
  };

 public:
  Index count() const { return count_; }

  /// The items of pool `p` in island `island`, ascending.
  inner::Slice<const Index> items(int p, Index island) const {
    const Items& of = pools_[std::size_t(p)];
    return {of.sorted.data() + of.start[island], std::size_t(of.start[island + 1] - of.start[island])};
  }

  /// The island of a block, or −1 when no constraint holds it. `block` counts through the sets in order.
  Index island_of(Index block) const { return island_[block]; }

  /// The island of an item of pool `p`, or −1.
  Index island_of(int p, Index item) const {
    const Index block = pools_[std::size_t(p)].lowest[std::size_t(item)];
    return block < 0 ? -1 : island_[block];
  }
  /// The blocks of each island.
  void count_blocks(Array<Index>& counts) const {
    counts.assign(std::size_t(count_), 0);
    for (const Index island : island_)
      if (island >= 0) ++counts[island];
  }

  /// Before `find`: every block of every set in order, then those that A couples without a constraint.
  void clear_blocks() {
    parent_.clear();
    moves_.clear();
  }
  void add_block(bool moves) {
    parent_.push_back(Index(parent_.size()));
    moves_.push_back(moves);
  }
  void tie(Index a, Index b) { unite(a, b); }

  /// `first_block[s]` is the number of the first block of set s.
  void find(AllRows<T> rows, const Index* first_block) {
    pools_.resize(rows.size());
    for (std::size_t p = 0; p < rows.size(); ++p) {
      pools_[p].lowest.resize_for_overwrite(std::size_t(rows[p].items()));
      for (Index i = 0; i < rows[p].items(); ++i) pools_[p].lowest[i] = join(rows[p], i, first_block);
    }
    number();
    for (Items& of : pools_) sort(of);
  }

  static void each_array(auto& self, auto&& f) {
    f(self.parent_), f(self.island_), f(self.moves_);
    for (auto& of : self.pools_) f(of.lowest), f(of.sorted), f(of.start);
  }

  /// Room for islands of `count` items of each pool and as many blocks.
  void reserve(int pools, std::size_t count) {
    pools_.resize(std::size_t(pools));
    each_array(*this, [count](auto& array) { array.reserve(count); });
  }

  /// No islands, within a step too: the blocks stay, each without one.
  void clear() {
    for (Items& of : pools_) of.lowest.clear(), of.sorted.clear(), of.start.clear();
    for (Index& island : island_) island = -1;
    count_ = 0;
  }

  /// One island of all items: a problem without bodies, or one whose errors shall be measured over the whole.
  void take_all(AllRows<T> rows) {
    clear_blocks();
    add_block(true);
    island_.assign(1, 0);
    count_ = 1;
    pools_.resize(rows.size());
    for (std::size_t p = 0; p < rows.size(); ++p) {
      pools_[p].lowest.assign(std::size_t(rows[p].items()), 0);
      sort(pools_[p]);
    }
  }

 private:
  Index join(const RowArrays<T>& pool, Index item, const Index* first_block) {
    Index seen = -1;
    for (int s = 0; s < pool.sets; ++s) {
      const Index *offset = pool.set[s].offset->data(), *block = pool.set[s].block->data();
      for (Index e = offset[item]; e < offset[item + 1]; ++e) {
        const Index b = first_block[s] + block[e];
        if (!moves_[b]) continue;
        if (seen >= 0) unite(seen, b);
        seen = b;
      }
    }
    return seen;
  }

  Index root(Index b) {
    while (parent_[b] != b) b = parent_[b] = parent_[parent_[b]];
    return b;
  }

  /// The lower block becomes the root, so that a root names its island's lowest block.
  void unite(Index a, Index b) {
    a = root(a);
    b = root(b);
    if (a < b) parent_[b] = a;
    if (b < a) parent_[a] = b;
  }

  void number() {
    const Index blocks = Index(parent_.size());
    island_.assign(blocks, -1);
    for (const Items& of : pools_)
      for (const Index b : of.lowest)
        if (b >= 0) island_[root(b)] = 0;
    count_ = 0;
    for (Index b = 0; b < blocks; ++b) {
      const Index r = root(b);
      if (r == b && island_[b] == 0) island_[b] = count_++;
      else island_[b] = r == b ? -1 : island_[r];
    }
  }

  /// Counting sort of one pool's items by island; stable, so insertion order stays. Islands are filled from their ends.
  void sort(Items& of) {
    of.start.assign_zeros(std::size_t(count_ + 1));
    for (const Index b : of.lowest)
      if (b >= 0) ++of.start[island_[b]];
    for (Index k = 0; k < count_; ++k) of.start[k + 1] += of.start[k];
    of.sorted.resize_for_overwrite(std::size_t(of.start[count_]));
    for (Index i = Index(of.lowest.size()); i-- > 0;)
      if (of.lowest[i] >= 0) of.sorted[--of.start[island_[of.lowest[i]]]] = i;
  }

  Index count_ = 0;
  Array<Index> parent_, island_;
  Array<char> moves_;
  OwningArray<Items> pools_;
};

}  // namespace delassus
