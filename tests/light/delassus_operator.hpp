/// W = H A⁻¹ Hᵀ, as blocks or through the velocities of the bodies: one type, and a number that says which.
#pragma once

#include "pool.hpp"

#include <algorithm>

#include <limits>
#include <vector>

namespace light {

/// What W has of the rows of one pool. Blocks are stored by columns. The lists of blocks are room that is
/// kept from one step to the next: item i has blocks start[i] … start[i + 1] − 1 of them.
template <class T>
struct PoolBlocks {
  Array<T> diagonal, block, other_block, base;
  Array<Index> start, column, other_start;  ///< by item
  Array<OtherBlock> others;
  bool has_others() const { return other_start.back() > 0; }
};

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
  /// The free velocity of item i of pool p, any number of rows; and with the item's own share.
  void free(int p, Index i, T* u);
  void velocity(int p, Index i, T* u);
  /// λ of an item, counted through the pools, has changed.
  template <int R = 0>
  void changed(Index item, const T* change);
  /// λ is what the rows say now.
  void reset();

  /// w of a row: the mean diagonal of its item.
  T weight(Index row) const { return weight_[row]; }
  /// Each row yields by `share` of its w; the laws are to be prepared anew.
  void soften(T share);

  Span<T> span(int p, const Index* items, Index count);
  /// The base of a span, with what stands still while its pool is swept.
  void sum_others(int p, const Span<T>& span);

  bool keeps_velocities() const { return keeps_velocities_; }
  bool has_blocks(Index item) const { return !through_bodies_[item]; }
  /// R rows, if R is not zero.
  template <int R>
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
  void build_pool(int p);
  void build_row(int p, Index i);
  void lift(int p, Index i, const Array<T>& by);  ///< numbers of all rows, onto the diagonal
  void make_room(int p, Index item);
  T* block_at(int p, Index j);
  OtherBlocks<T> others(int p) const;

  const WorldView<T>* world_ = nullptr;
  Rows<T>* rows_ = nullptr;
  std::span<Pool<T>* const> pools_;
  std::vector<PoolBlocks<T>> blocks_;
  Array<char> through_bodies_;
  bool keeps_velocities_ = false;
  Array<T> y_, lift_, weight_;  ///< by velocity; by row
  // What building needs.
  Array<int> pool_of_;
  Array<T> columns_, softness_;
  Array<Column> solved_;
  Array<Meeting> meetings_;
  Array<Index> meeting_start_, next_, place_, opened_, partners_;
  Index own_count_ = 0, other_count_ = 0, other_size_ = 0;  ///< of the pool that is built
};

template <class T>
Span<T> Delassus<T>::span(int p, const Index* items, Index count) {
  PoolBlocks<T>& W = blocks_[p];
  const Index first = pools_[p]->first_row;
  return {.items = items,
          .count = count,
          .base = !W.has_others() ? rows_->d.data() + first : W.base.data(),
          .diagonal = W.diagonal.data(),
          .start = W.start.data(),
          .column = W.column.data(),
          .block = W.block.data(),
          .lambda = rows_->lambda.data() + first,
          .velocities = keeps_velocities_ ? this : nullptr};
}

template <class T>
OtherBlocks<T> Delassus<T>::others(int p) const {
  const PoolBlocks<T>& W = blocks_[p];
  return {.start = W.other_start.data(),
          .list = W.others.data(),
          .block = W.other_block.data(),
          .lambda = rows_->lambda.data()};
}

template <class T>
void Delassus<T>::sum_others(int p, const Span<T>& span) {
  if (!blocks_[p].has_others()) return;
  const T* const d = rows_->d.data() + pools_[p]->first_row;
  pools_[p]->sweeping->sum_others(span, d, others(p), blocks_[p].base.data());
}

template <class T>
void Delassus<T>::free(int p, Index i, T* u) {
  const PoolBlocks<T>& W = blocks_[p];
  const Pool<T>& pool = *pools_[p];
  const int R = rows_of(p);
  if (!has_blocks(pool.first_item + i)) return free_through_bodies<0>(pool.first_item + i, diagonal(p, i), u);
  const Span<T> alone = span(p, &i, 1);
  sum_others(p, alone);
  for (int k = 0; k < R; ++k) u[k] = alone.base[R * i + k];
  const T* w = W.block.data() + square(p) * std::size_t(W.start[i]);
  for (Index e = W.start[i]; e < W.start[i + 1]; ++e) {
    const T* const x = rows_->lambda.data() + pool.first_row + R * W.column[e];
    for (int c = 0; c < R; ++c, w += R)
      for (int k = 0; k < R; ++k) u[k] += w[k] * x[c];
  }
}

template <class T>
void Delassus<T>::velocity(int p, Index i, T* u) {
  const int R = rows_of(p);
  const T *own = diagonal(p, i), *const x = rows_->lambda.data() + pools_[p]->first_row + R * i;
  free(p, i, u);
  for (int c = 0; c < R; ++c, own += R)
    for (int k = 0; k < R; ++k) u[k] += own[k] * x[c];
}

/// d + H y without what the item itself has given to y.
template <class T>
template <int rows>
void Delassus<T>::free_through_bodies(Index item, const T* own, T* u) const {
  const Rows<T>& r = *rows_;
  const int R = rows ? rows : r.rows_of(item);
  const T *const d = r.d.data() + r.row[item], *const x = r.lambda.data() + r.row[item];
  const T* const lift = lift_.data() + r.row[item];
  for (int k = 0; k < R; ++k) u[k] = d[k] + lift[k] * x[k];
  for (Index e = r.entry[item]; e < r.entry[item + 1]; ++e) {
    const Entry& at = r.entries[e];
    const T *const H = r.H.data() + at.place, *const y = y_.data() + at.velocity;
    with_width(at.width, [&](auto width) {
      for (int j = 0; j < width; ++j)
        for (int k = 0; k < R; ++k) u[k] += H[k + R * j] * y[j];
    });
  }
  for (int c = 0; c < R; ++c, own += R)
    for (int k = 0; k < R; ++k) u[k] -= own[k] * x[c];
}

template <class T>
template <int rows>
void Delassus<T>::changed(Index item, const T* change) {
  if (!keeps_velocities_) return;
  const Rows<T>& r = *rows_;
  const int R = rows ? rows : r.rows_of(item);
  for (Index e = r.entry[item]; e < r.entry[item + 1]; ++e) {
    const Entry& at = r.entries[e];
    if (world_->sets[at.set].is_coupled) continue;  // nobody reads y there
    const T* const G = r.G.data() + at.place;
    T* const y = y_.data() + at.velocity;
    with_width(at.width, [&](auto width) {
      for (int k = 0; k < R; ++k)
        for (int j = 0; j < width; ++j) y[j] += G[j + width * k] * change[k];
    });
  }
}

template <class T>
void Delassus<T>::reset() {
  if (!keeps_velocities_) return;
  y_.assign(std::size_t(world_->velocities), T(0));
  for (Index i = 0; i < rows_->items(); ++i) changed(i, rows_->lambda.data() + rows_->row[i]);
}

template <class T>
void Delassus<T>::lift(int p, Index i, const Array<T>& by) {
  const int R = rows_of(p);
  const Index first = pools_[p]->first_row + R * i;
  T *const own = blocks_[p].diagonal.data() + square(p) * std::size_t(i), trace = 0;
  for (int k = 0; k < R; ++k) {
    own[k * (R + 1)] += by[first + k];
    lift_[first + k] += by[first + k];
    trace += own[k * (R + 1)];
  }
  for (int k = 0; k < R; ++k) weight_[first + k] = trace * (T(1) / T(R));
}

template <class T>
void Delassus<T>::soften(T share) {
  Array<T> by = weight_;
  for (T& x : by) x *= share;
  for (int p = 0; p < int(pools_.size()); ++p)
    for (Index i = 0; i < pools_[p]->items; ++i) lift(p, i, by);
}

}  // namespace light

#include "delassus_build.hpp"
