/// Groups of constraints that share no moving body: each is solved, stopped, slept and lost by itself.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/rows/row_system.hpp>

#include <array>
#include <span>

namespace delassus {

/// Union-find over the blocks of H. Blocks that do not move (A⁻¹ = 0) join nothing.
///
/// Islands are numbered by their lowest block, items inside go by pool and insertion: a body far away changes
/// no order, hence no bit. An item without a moving block belongs to no island; its impulse stays zero.
template <int pools>
class Islands {
 public:
  Index count() const { return count_; }

  /// The items of pool `p` in island `island`, ascending.
  std::span<const Index> items(int p, Index island) const {
    const auto& start = start_[p];
    return std::span<const Index>(items_[p]).subspan(start[island], start[island + 1] - start[island]);
  }

  /// The island of a block, or −1 when no constraint holds it. `block` counts through the sets in order.
  Index island_of(Index block) const { return island_[block]; }

  /// `first_block[s]` is the number of the first block of set s; moves(s, b) tells whether A⁻¹ ≠ 0 there; ties(f) calls
  /// f(a, b) for numbers of blocks that A couples without a constraint.
  void find(const auto& rows, std::span<const Index> first_block, Index blocks, const auto& moves, const auto& ties) {
    parent_.resize(blocks);
    for (Index b = 0; b < blocks; ++b) parent_[b] = b;
    ties([this](Index a, Index b) { unite(a, b); });
    each_pool(rows, [&](auto p, const auto& pool) {
      lowest_[p].assign(pool.items(), -1);
      for (Index i = 0; i < pool.items(); ++i) join(pool, i, first_block, moves, lowest_[p][i]);
    });
    number();
    for_each_index<pools>([&](auto p) { sort(p); });
  }

  static void each_array(auto& self, auto&& f) {
    f(self.parent_), f(self.island_), f(self.next_);
    for (auto* arrays : {&self.lowest_, &self.items_, &self.start_})
      for (auto& array : *arrays) f(array);
  }

  /// No islands; what they were kept in stays.
  void clear() {
    each_array(*this, [](auto& array) { array.clear(); });
    count_ = 0;
  }

  /// One island of all items: a problem without bodies, or one whose errors shall be measured over the whole.
  void take_all(const auto& rows) {
    parent_.assign(1, 0);
    island_.assign(1, 0);
    count_ = 1;
    for_each_index<pools>([&](auto p) {
      lowest_[p].assign(rows.template pool<p>().items(), 0);
      sort(p);
    });
  }

 private:
  void join(const auto& pool, Index item, std::span<const Index> first_block, const auto& moves, Index& seen) {
    for_each_index<std::remove_cvref_t<decltype(pool)>::set_count>([&](auto s) {
      const auto& set = inner::part<s>(pool.sets);
      for (Index e = set.offset[item]; e < set.offset[item + 1]; ++e) {
        if (!moves(s, set.block[e])) continue;
        const Index b = first_block[s] + set.block[e];
        if (seen >= 0) unite(seen, b);
        seen = b;
      }
    });
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
    for (const auto& pool : lowest_)
      for (const Index b : pool)
        if (b >= 0) island_[root(b)] = 0;
    count_ = 0;
    for (Index b = 0; b < blocks; ++b) {
      const Index r = root(b);
      if (r == b && island_[b] == 0) island_[b] = count_++;
      else island_[b] = r == b ? -1 : island_[r];
    }
  }

  /// Counting sort of one pool's items by island; stable, so insertion order stays.
  void sort(int p) {
    auto& start = start_[p];
    start.assign(count_ + 1, 0);
    for (const Index b : lowest_[p])
      if (b >= 0) ++start[island_[b] + 1];
    for (Index k = 0; k < count_; ++k) start[k + 1] += start[k];
    items_[p].resize(start[count_]);
    next_.assign(start.begin(), start.end());
    for (Index i = 0; i < Index(lowest_[p].size()); ++i)
      if (lowest_[p][i] >= 0) items_[p][next_[island_[lowest_[p][i]]]++] = i;
  }

  Index count_ = 0;
  Array<Index> parent_, island_, next_;
  std::array<Array<Index>, pools> lowest_, items_, start_;
};

namespace inner {

/// f(p, i) for every item of an island.
template <int pools, class F>
void each_item(const Islands<pools>& islands, Index island, F&& f) {
  for_each_index<pools>([&](auto p) {
    for (const Index i : islands.items(p, island)) f(p, i);
  });
}

}  // namespace inner

}  // namespace delassus
