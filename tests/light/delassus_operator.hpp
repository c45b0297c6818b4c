/// W = H A⁻¹ Hᵀ, as blocks or through the velocities of the bodies: one type, and a number that says which.
#pragma once

#include "pool.hpp"

#include <limits>
#include <vector>

namespace light {

/// What W has of the rows of one pool. Blocks are stored by columns.
template <class T>
struct PoolBlocks {
  /// A block whose columns are another pool's item.
  struct Other {
    Index row;  ///< the first of the columns, in the flat λ
    int width;
    Index place;
  };
  Array<T> diagonal, block, other_block, base;
  Array<Index> start, column, other_start;  ///< by item
  Array<Other> others;
};

/// Σ_j a_j b_j from left to right.
template <class T>
T dot(const T* a, const T* b, int width) {
  T sum = a[0] * b[0];
  for (int j = 1; j < width; ++j) sum += a[j] * b[j];
  return sum;
}

/// The one primitive is the free velocity of an item, d_i + Σ_{j ≠ i} W_ij λ_j; the velocity of its rows
/// follows by adding W_ii λ_i. An item with at most `most_partners` others on its bodies has blocks; one with
/// more reads y = A⁻¹ Hᵀ λ, which `changed` keeps, if none of its bodies is coupled to others by A.
template <class T>
class Delassus {
 public:
  static constexpr Index all_blocks = std::numeric_limits<Index>::max();

  /// Pre: the rows, pools and sets stay where they are.
  void build(const WorldView<T>& world, std::span<Pool<T>* const> pools, Rows<T>& rows,
             Index most_partners = all_blocks);

  const T* diagonal(int p, Index i) const { return blocks_[p].diagonal.data() + square(p) * std::size_t(i); }
  /// The free velocity of item i of pool p, any number of rows.
  void free(int p, Index i, T* u) const;
  /// λ of an item, counted through the pools, has changed.
  void changed(Index item, const T* change);
  /// λ is what the rows say now.
  void reset();

  Span<T> span(int p, const Index* items, Index count);
  /// The base of a span, with what stands still while its pool is swept.
  void sum_others(int p, const Span<T>& span);

  /// Each row yields by `share` of its item's mean diagonal; the laws are to be prepared anew.
  void soften(T share);

  bool has_blocks(Index item) const { return !through_bodies_[item]; }
  void free_through_bodies(Index item, const T* own, T* u) const;

 private:
  struct Meeting {
    Index item, entry;
  };
  /// A⁻¹ H_itemᵀ over all blocks of a coupled set, from columns_[place] on.
  struct Column {
    int set;
    Index item, place;
  };

  int rows_of(int p) const { return pools_[std::size_t(p)]->sweeping->rows; }
  std::size_t square(int p) const { return std::size_t(rows_of(p)) * rows_of(p); }
  void apply_inverse();
  void find_meetings();
  void solve_columns(int s);
  void choose(Index most_partners);
  void build_row(int p, Index i);
  void add_own_block(Index item, T* own) const;
  void add_lift(int p, Index i);
  T* block_at(int p, Index j);
  void add_others(int p, Index i, T* u) const;
  void add_product(const Entry& e, int rows, const T* G, std::size_t line, int columns, T* to) const;

  const WorldView<T>* world_ = nullptr;
  Rows<T>* rows_ = nullptr;
  std::span<Pool<T>* const> pools_;
  std::vector<PoolBlocks<T>> blocks_;
  Array<int> pool_of_;
  Array<char> through_bodies_;
  bool keeps_velocities_ = false;
  Array<T> y_, lift_, columns_;
  Array<Index> meeting_start_, next_, place_, opened_;
  Array<Meeting> meetings_;
  Array<Column> solved_;
};

template <class T>
void Delassus<T>::build(const WorldView<T>& world, std::span<Pool<T>* const> pools, Rows<T>& rows,
                        Index most_partners) {
  world_ = &world;
  rows_ = &rows;
  pools_ = pools;
  blocks_.resize(pools.size());
  pool_of_.clear();
  for (std::size_t p = 0; p < pools.size(); ++p)
    pool_of_.resize(pool_of_.size() + std::size_t(pools[p]->items), int(p));
  apply_inverse();
  find_meetings();
  solved_.clear();
  columns_.clear();
  for (int s = 0; s < int(world.sets.size()); ++s)
    if (world.sets[s].is_coupled) solve_columns(s);
  choose(most_partners);
  place_.assign(std::size_t(rows.items()), -1);
  lift_.assign(std::size_t(rows.count()), T(0));
  for (int p = 0; p < int(pools.size()); ++p) {
    PoolBlocks<T>& W = blocks_[p];
    W.diagonal.assign(square(p) * std::size_t(pools[p]->items), T(0));
    for (auto* x : {&W.block, &W.other_block}) x->clear();
    for (auto* x : {&W.start, &W.other_start}) x->assign(1, 0);
    W.column.clear();
    W.others.clear();
    W.base.resize(std::size_t(rows_of(p)) * std::size_t(pools[p]->items));
    for (Index i = 0; i < pools[p]->items; ++i) build_row(p, i);
  }
  reset();
}

template <class T>
void Delassus<T>::apply_inverse() {
  Rows<T>& r = *rows_;
  r.G = r.H;
  for (Index i = 0; i < r.items(); ++i)
    for (Index e = r.entry[i]; e < r.entry[i + 1]; ++e) {
      const Entry& at = r.entries[e];
      const SetView<T>& s = world_->sets[at.set];
      if (s.is_coupled) continue;
      for (int k = 0; k < r.rows_of(i); ++k)
        s.table->solve_block(s.set, at.block - s.first_block, r.G.data() + at.place + k * at.width);
    }
}

/// Which entries act on a block, ascending.
template <class T>
void Delassus<T>::find_meetings() {
  const Rows<T>& r = *rows_;
  meeting_start_.assign(std::size_t(world_->blocks) + 1, 0);
  for (const Entry& e : r.entries) ++meeting_start_[e.block + 1];
  for (Index b = 0; b < world_->blocks; ++b) meeting_start_[b + 1] += meeting_start_[b];
  next_ = meeting_start_;
  meetings_.resize(r.entries.size());
  for (Index i = 0; i < r.items(); ++i)
    for (Index e = r.entry[i]; e < r.entry[i + 1]; ++e) meetings_[next_[r.entries[e].block]++] = {i, e};
}

/// One solve with A for each row on a set whose blocks A couples.
template <class T>
void Delassus<T>::solve_columns(int s) {
  const Rows<T>& r = *rows_;
  const SetView<T>& set = world_->sets[s];
  const std::size_t size = std::size_t(set.table->width) * set.table->blocks(set.set);
  Array<T> x(size);
  for (Index i = 0; i < r.items(); ++i) {
    bool is_on_set = false;
    for (Index e = r.entry[i]; e < r.entry[i + 1]; ++e) is_on_set = is_on_set || r.entries[e].set == s;
    if (!is_on_set) continue;
    solved_.push_back({s, i, Index(columns_.size())});
    for (int k = 0; k < r.rows_of(i); ++k) {
      x.assign(size, T(0));
      for (Index e = r.entry[i]; e < r.entry[i + 1]; ++e) {
        const Entry& at = r.entries[e];
        for (int j = 0; at.set == s && j < at.width; ++j)
          x[at.velocity - set.first_velocity + j] += r.H[at.place + k * at.width + j];
      }
      set.table->solve(set.set, x.data());
      columns_.append(x.begin(), x.end());
    }
  }
}

template <class T>
void Delassus<T>::choose(Index most_partners) {
  const Rows<T>& r = *rows_;
  through_bodies_.assign(std::size_t(r.items()), 0);
  keeps_velocities_ = false;
  for (Index i = 0; i < r.items(); ++i) {
    Index partners = 0;
    bool is_coupled = false;
    for (Index e = r.entry[i]; e < r.entry[i + 1]; ++e) {
      const Index b = r.entries[e].block;
      partners += meeting_start_[b + 1] - meeting_start_[b] - 1;
      is_coupled = is_coupled || world_->sets[r.entries[e].set].is_coupled;
    }
    through_bodies_[i] = !is_coupled && partners > most_partners;
    keeps_velocities_ = keeps_velocities_ || through_bodies_[i];
  }
}

/// Row i: every entry meets all entries on its body, or all items on a body that A couples to it.
template <class T>
void Delassus<T>::build_row(int p, Index i) {
  const Rows<T>& r = *rows_;
  PoolBlocks<T>& W = blocks_[p];
  const Index item = pools_[p]->first_item + i;
  T* const own = W.diagonal.data() + square(p) * std::size_t(i);
  if (!has_blocks(item)) add_own_block(item, own);
  for (Index e = r.entry[item]; has_blocks(item) && e < r.entry[item + 1]; ++e) {
    const Entry& at = r.entries[e];
    const SetView<T>& set = world_->sets[at.set];
    if (!set.is_coupled) {
      for (Index m = meeting_start_[at.block]; m < meeting_start_[at.block + 1]; ++m) {
        const auto [j, f] = meetings_[m];
        add_product(at, rows_of(p), r.G.data() + r.entries[f].place, std::size_t(at.width), r.rows_of(j),
                    j == item ? own : block_at(p, j));
      }
      continue;
    }
    const std::size_t line = std::size_t(at.width) * set.table->blocks(set.set);
    for (const Column& c : solved_)
      if (c.set == at.set)  // zero where the two act on bodies that A does not couple
        add_product(at, rows_of(p), columns_.data() + c.place + at.velocity - set.first_velocity, line,
                    r.rows_of(c.item), c.item == item ? own : block_at(p, c.item));
  }
  add_lift(p, i);
  for (const Index j : opened_) place_[j] = -1;
  opened_.clear();
  W.start.push_back(Index(W.column.size()));
  W.other_start.push_back(Index(W.others.size()));
}

/// W_ij, zero when it is the first time; `place_` says where it is among the blocks of its list.
template <class T>
T* Delassus<T>::block_at(int p, Index j) {
  PoolBlocks<T>& W = blocks_[p];
  const int q = pool_of_[j], width = rows_of(q);
  const std::size_t size = std::size_t(rows_of(p)) * width;
  auto& blocks = q == p ? W.block : W.other_block;
  if (place_[j] < 0) {
    opened_.push_back(j);
    place_[j] = Index(blocks.size());
    blocks.resize(blocks.size() + size, T(0));
    if (q == p)
      W.column.push_back(j - pools_[p]->first_item);
    else
      W.others.push_back({rows_->row[j], width, place_[j]});
  }
  return blocks.data() + place_[j];
}

/// to += H_e G, both given as a line of numbers for each row.
template <class T>
void Delassus<T>::add_product(const Entry& e, int rows, const T* G, std::size_t line, int columns,
                              T* to) const {
  const T* const H = rows_->H.data() + e.place;
  const auto add = [&](auto width) {
    for (int c = 0; c < columns; ++c)
      for (int k = 0; k < rows; ++k) to[k + rows * c] += dot(H + width * k, G + line * c, width);
  };
  if (e.width == 6)
    add(std::integral_constant<int, 6>{});
  else if (e.width == 3)
    add(std::integral_constant<int, 3>{});
  else
    add(e.width);
}

template <class T>
void Delassus<T>::add_own_block(Index item, T* own) const {
  const Rows<T>& r = *rows_;
  for (Index e = r.entry[item]; e < r.entry[item + 1]; ++e)
    for (Index f = r.entry[item]; f < r.entry[item + 1]; ++f)
      if (r.entries[e].block == r.entries[f].block)
        add_product(r.entries[e], r.rows_of(item), r.G.data() + r.entries[f].place,
                    std::size_t(r.entries[e].width), r.rows_of(item), own);
}

/// The rows' own compliance, on the diagonal.
template <class T>
void Delassus<T>::add_lift(int p, Index i) {
  const int R = rows_of(p);
  T* const own = blocks_[p].diagonal.data() + square(p) * std::size_t(i);
  const Index first = pools_[p]->first_row + R * i;
  for (int k = 0; k < R; ++k) {
    T& w = own[k * (R + 1)];
    lift_[first + k] = rows_->compliance[first + k] + rows_->softness[first + k] * w;
    w += lift_[first + k];
  }
}

template <class T>
void Delassus<T>::soften(T share) {
  for (int p = 0; p < int(pools_.size()); ++p)
    for (Index i = 0; i < pools_[p]->items; ++i) {
      const int R = rows_of(p);
      T *const own = blocks_[p].diagonal.data() + square(p) * std::size_t(i), trace = 0;
      for (int k = 0; k < R; ++k) trace += own[k * (R + 1)];
      for (int k = 0; k < R; ++k) {
        own[k * (R + 1)] += share * trace / T(R);
        lift_[pools_[p]->first_row + R * i + k] += share * trace / T(R);
      }
    }
}

template <class T>
Span<T> Delassus<T>::span(int p, const Index* items, Index count) {
  PoolBlocks<T>& W = blocks_[p];
  const Index first = pools_[p]->first_row;
  const T* const base = W.others.empty() ? rows_->d.data() + first : W.base.data();
  return {items,
          count,
          base,
          W.diagonal.data(),
          W.start.data(),
          W.column.data(),
          W.block.data(),
          rows_->lambda.data() + first,
          keeps_velocities_ ? this : nullptr};
}

template <class T>
void Delassus<T>::add_others(int p, Index i, T* u) const {
  const PoolBlocks<T>& W = blocks_[p];
  const int R = rows_of(p);
  for (Index e = W.other_start[i]; e < W.other_start[i + 1]; ++e) {
    const auto [row, width, place] = W.others[e];
    const T *w = W.other_block.data() + place, *x = rows_->lambda.data() + row;
    for (int c = 0; c < width; ++c, w += R)
      for (int k = 0; k < R; ++k) u[k] += w[k] * x[c];
  }
}

template <class T>
void Delassus<T>::sum_others(int p, const Span<T>& span) {
  if (blocks_[p].others.empty()) return;
  const int R = rows_of(p);
  const T* const d = rows_->d.data() + pools_[p]->first_row;
  T* const base = blocks_[p].base.data();
  for (Index n = 0; n < span.count; ++n) {
    const std::size_t at = std::size_t(R) * span.items[n];
    for (int k = 0; k < R; ++k) base[at + k] = d[at + k];
    add_others(p, span.items[n], base + at);
  }
}

template <class T>
void Delassus<T>::free(int p, Index i, T* u) const {
  const PoolBlocks<T>& W = blocks_[p];
  const Pool<T>& pool = *pools_[p];
  const int R = rows_of(p);
  if (!has_blocks(pool.first_item + i)) return free_through_bodies(pool.first_item + i, diagonal(p, i), u);
  for (int k = 0; k < R; ++k) u[k] = rows_->d[pool.first_row + R * i + k];
  add_others(p, i, u);
  const T* w = W.block.data() + square(p) * std::size_t(W.start[i]);
  for (Index e = W.start[i]; e < W.start[i + 1]; ++e) {
    const T* const x = rows_->lambda.data() + pool.first_row + R * W.column[e];
    for (int c = 0; c < R; ++c, w += R)
      for (int k = 0; k < R; ++k) u[k] += w[k] * x[c];
  }
}

/// d + H y without what the item itself has given to y.
template <class T>
void Delassus<T>::free_through_bodies(Index item, const T* own, T* u) const {
  const Rows<T>& r = *rows_;
  const int R = r.rows_of(item);
  const Index first = r.row[item];
  for (int k = 0; k < R; ++k) {
    u[k] = r.d[first + k] + lift_[first + k] * r.lambda[first + k];
    for (Index e = r.entry[item]; e < r.entry[item + 1]; ++e) {
      const Entry& at = r.entries[e];
      u[k] += dot(r.H.data() + at.place + k * at.width, y_.data() + at.velocity, at.width);
    }
  }
  for (int c = 0; c < R; ++c)
    for (int k = 0; k < R; ++k) u[k] -= own[k + R * c] * r.lambda[first + c];
}

template <class T>
void Delassus<T>::changed(Index item, const T* change) {
  if (!keeps_velocities_) return;
  const Rows<T>& r = *rows_;
  for (Index e = r.entry[item]; e < r.entry[item + 1]; ++e) {
    const Entry& at = r.entries[e];
    if (world_->sets[at.set].is_coupled) continue;  // nobody reads y there
    T* const y = y_.data() + at.velocity;
    for (int k = 0; k < r.rows_of(item); ++k)
      for (int j = 0; j < at.width; ++j) y[j] += r.G[at.place + k * at.width + j] * change[k];
  }
}

template <class T>
void Delassus<T>::reset() {
  y_.assign(std::size_t(world_->velocities), T(0));
  for (Index i = 0; i < rows_->items(); ++i) changed(i, rows_->lambda.data() + rows_->row[i]);
}

}  // namespace light
