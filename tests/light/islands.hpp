/// Groups of items that share no moving body, on flat rows.
#pragma once

#include "pool.hpp"

#include <vector>

namespace light {

/// Union-find over the blocks, as in `delassus::Islands`: numbered by the lowest block, items by pool and
/// insertion.
template <class T>
class Islands {
 public:
  Index count() const { return count_; }
  std::span<const Index> items(int p, Index island) const {
    const Sorted& s = sorted_[p];
    return {s.items.data() + s.start[island], s.items.data() + s.start[island + 1]};
  }

  void find(const WorldView<T>& world, std::span<Pool<T>* const> pools, const Rows<T>& rows) {
    parent_.resize(std::size_t(world.blocks));
    for (Index b = 0; b < world.blocks; ++b) parent_[b] = b;
    for (const SetView<T>& s : world.sets) tie(s);
    lowest_.assign(std::size_t(rows.items()), -1);
    for (Index i = 0; i < rows.items(); ++i) join(world, rows, i);
    number();
    sorted_.resize(pools.size());
    for (std::size_t p = 0; p < pools.size(); ++p) sort(*pools[p], sorted_[p]);
  }

 private:
  struct Sorted {
    Array<Index> items, start, next;
  };
  struct Tie {
    Islands* self;
    Index first;
  };

  void tie(const SetView<T>& s) {
    Tie to{this, s.first_block};
    s.table->ties(s.set, &to, [](void* at, Index a, Index b) {
      const auto [self, first] = *static_cast<Tie*>(at);
      self->unite(first + a, first + b);
    });
  }
  void join(const WorldView<T>& world, const Rows<T>& rows, Index i) {
    for (Index e = rows.entry[i]; e < rows.entry[i + 1]; ++e) {
      const Entry& at = rows.entries[e];
      const SetView<T>& s = world.sets[at.set];
      if (!s.table->moves(s.set, at.block - s.first_block)) continue;
      if (lowest_[i] >= 0) unite(lowest_[i], at.block);
      lowest_[i] = at.block;
    }
  }
  Index root(Index b) {
    while (parent_[b] != b) b = parent_[b] = parent_[parent_[b]];
    return b;
  }
  void unite(Index a, Index b) {
    a = root(a), b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }
  void number() {
    island_.assign(parent_.size(), -1);
    for (const Index b : lowest_)
      if (b >= 0) island_[root(b)] = 0;
    count_ = 0;
    for (Index b = 0; b < Index(parent_.size()); ++b) {
      const Index r = root(b);
      if (r != b)
        island_[b] = island_[r];
      else if (island_[b] == 0)
        island_[b] = count_++;
    }
  }
  /// By island; insertion order stays.
  void sort(const Pool<T>& pool, Sorted& s) {
    s.start.assign(std::size_t(count_) + 1, 0);
    const Index* const lowest = lowest_.data() + pool.first_item;
    for (Index i = 0; i < pool.items; ++i)
      if (lowest[i] >= 0) ++s.start[island_[lowest[i]] + 1];
    for (Index k = 0; k < count_; ++k) s.start[k + 1] += s.start[k];
    s.items.resize(std::size_t(s.start[count_]));
    s.next = s.start;
    for (Index i = 0; i < pool.items; ++i)
      if (lowest[i] >= 0) s.items[s.next[island_[lowest[i]]]++] = i;
  }

  Array<Index> parent_, island_, lowest_;
  std::vector<Sorted> sorted_;
  Index count_ = 0;
};

}  // namespace light
