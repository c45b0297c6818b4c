/// How W is built: row by row, from the entries that meet on a body, or from solves where A couples bodies.
#pragma once

#include "delassus_operator.hpp"

namespace light {

template <class T>
void Delassus<T>::build(const WorldView<T>& world, std::span<Pool<T>* const> pools, Rows<T>& rows,
                        Index most_partners) {
  world_ = &world;
  rows_ = &rows;
  pools_ = pools;
  apply_inverse();
  find_meetings();
  solved_.clear();
  columns_.clear();
  for (int s = 0; s < int(world.sets.size()); ++s)
    if (world.sets[s].is_coupled) solve_columns(s);
  choose(most_partners);
  pool_of_.clear();
  for (int p = 0; p < int(pools.size()); ++p)
    pool_of_.resize(pool_of_.size() + std::size_t(pools[p]->items), p);
  place_.assign(std::size_t(rows.items()), -1);
  for (auto* x : {&lift_, &weight_, &softness_}) x->assign(std::size_t(rows.count()), T(0));
  blocks_.resize(pools.size());
  for (int p = 0; p < int(pools.size()); ++p) build_pool(p);
  reset();
}

/// G = A⁻¹ Hᵀ where A is block-diagonal.
template <class T>
void Delassus<T>::apply_inverse() {
  Rows<T>& r = *rows_;
  r.G.resize(r.H.size());
  for (Index i = 0; i < r.items(); ++i)
    for (Index e = r.entry[i]; e < r.entry[i + 1]; ++e) {
      const Entry& at = r.entries[e];
      const SetView<T>& s = world_->sets[at.set];
      if (s.is_coupled) continue;
      const int R = r.rows_of(i);
      const T* const H = r.H.data() + at.place;
      T* const G = r.G.data() + at.place;
      for (int k = 0; k < R; ++k)
        for (int j = 0; j < at.width; ++j) G[j + at.width * k] = H[k + R * j];
      s.table->solve_block(s.set, at.block - s.first_block, R, G);
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
  Array<T> x;
  for (Index i = 0; i < r.items(); ++i) {
    const auto is_on_set = [&](const Entry& e) { return e.set == s; };
    if (std::none_of(&r.entries[r.entry[i]], &r.entries[r.entry[i + 1]], is_on_set)) continue;
    solved_.push_back({s, i, Index(columns_.size())});
    for (int k = 0; k < r.rows_of(i); ++k) {
      x.assign(size, T(0));
      for (Index e = r.entry[i]; e < r.entry[i + 1]; ++e) {
        const Entry& at = r.entries[e];
        for (int j = 0; at.set == s && j < at.width; ++j)
          x[at.velocity - set.first_velocity + j] += r.H[at.place + k + r.rows_of(i) * j];
      }
      set.table->solve(set.set, x.data());
      columns_.append(x.begin(), x.end());
    }
  }
}

/// Which items are met through the bodies.
template <class T>
void Delassus<T>::choose(Index most_partners) {
  const Rows<T>& r = *rows_;
  through_bodies_.assign(std::size_t(r.items()), 0);
  partners_.assign(std::size_t(r.items()), 0);
  keeps_velocities_ = false;
  for (Index i = 0; i < r.items(); ++i) {
    Index& partners = partners_[i];
    bool is_coupled = false;
    for (Index e = r.entry[i]; e < r.entry[i + 1]; ++e) {
      const Index b = r.entries[e].block;
      partners += meeting_start_[b + 1] - meeting_start_[b] - 1;
      is_coupled = is_coupled || world_->sets[r.entries[e].set].is_coupled;
    }
    through_bodies_[i] = !is_coupled && partners > most_partners;
    keeps_velocities_ = keeps_velocities_ || through_bodies_[i];
    if (is_coupled) partners += Index(solved_.size());
    if (through_bodies_[i]) partners = 0;
  }
}

template <class T>
void Delassus<T>::build_pool(int p) {
  PoolBlocks<T>& W = blocks_[p];
  const std::size_t items = std::size_t(pools_[p]->items);
  const int R = rows_of(p);
  W.diagonal.assign(square(p) * items, T(0));
  for (auto* x : {&W.start, &W.other_start}) x->assign(1, 0);
  own_count_ = other_count_ = other_size_ = 0;
  W.base.resize(R * items);
  for (Index i = 0; i < Index(items); ++i) {
    build_row(p, i);
    for (int k = 0; k < R; ++k) {
      const Index r = pools_[p]->first_row + R * i + k;
      softness_[r] = rows_->compliance[r] + rows_->relative_compliance[r] * diagonal(p, i)[k * (R + 1)];
    }
    lift(p, i, softness_);
  }
}

/// Every entry of item i meets all entries on its body, or all items on a body that A couples to it.
template <class T>
void Delassus<T>::build_row(int p, Index i) {
  const Rows<T>& r = *rows_;
  PoolBlocks<T>& W = blocks_[p];
  const Index item = pools_[p]->first_item + i;
  const auto add = pools_[p]->sweeping->add_block;
  T* const own = W.diagonal.data() + square(p) * std::size_t(i);
  make_room(p, item);
  for (Index e = r.entry[item]; e < r.entry[item + 1]; ++e) {
    const Entry& at = r.entries[e];
    const SetView<T>& set = world_->sets[at.set];
    if (!set.is_coupled) {
      for (Index m = meeting_start_[at.block]; m < meeting_start_[at.block + 1]; ++m) {
        const auto [j, f] = meetings_[m];
        if (j != item && !has_blocks(item)) continue;
        add(r.H.data() + at.place, r.G.data() + r.entries[f].place, at.width, at.width, r.rows_of(j),
            j == item ? own : block_at(p, j));
      }
      continue;
    }
    const Index line = at.width * set.table->blocks(set.set);
    for (const Column& c : solved_)
      if (c.set == at.set)  // zero where the two act on bodies that A does not couple
        add(r.H.data() + at.place, columns_.data() + c.place + at.velocity - set.first_velocity, at.width,
            line, r.rows_of(c.item), c.item == item ? own : block_at(p, c.item));
  }
  for (const Index j : opened_) place_[j] = -1;
  opened_.clear();
  W.start.push_back(own_count_);
  W.other_start.push_back(other_count_);
}

/// For as many blocks as an item can have, in each list.
template <class T>
void Delassus<T>::make_room(int p, Index item) {
  constexpr int most_rows = 6;
  PoolBlocks<T>& W = blocks_[p];
  const std::size_t more = std::size_t(partners_[item]), own = own_count_ + more,
                    others = other_count_ + more;
  if (W.column.size() < own) {
    W.column.resize(2 * own);
    W.block.resize(2 * own * square(p));
  }
  if (W.others.size() < others) W.others.resize(2 * others);
  const std::size_t size = other_size_ + more * most_rows * rows_of(p);
  if (W.other_block.size() < size) W.other_block.resize(2 * size);
}

/// W_ij, zero when it is the first time; `place_` says where it is among the blocks of its list.
template <class T>
T* Delassus<T>::block_at(int p, Index j) {
  PoolBlocks<T>& W = blocks_[p];
  const int q = pool_of_[j], width = rows_of(q);
  const std::size_t size = std::size_t(rows_of(p)) * width;
  T* const blocks = q == p ? W.block.data() : W.other_block.data();
  Index& place = place_[j];
  if (place >= 0) return blocks + place;
  opened_.push_back(j);
  if (q == p) {
    place = Index(size) * own_count_;
    W.column[own_count_++] = j - pools_[p]->first_item;
  } else {
    place = other_size_;
    other_size_ += Index(size);
    W.others[other_count_++] = {rows_->row[j], width, place};
  }
  std::fill_n(blocks + place, size, T(0));
  return blocks + place;
}

}  // namespace light
