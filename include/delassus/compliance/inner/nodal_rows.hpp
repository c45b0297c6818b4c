/// Rows of W from the compliance of touched nodes: for a set whose A couples the nodes of a body.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/owning_array.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/math/long_vectors.hpp>
#include <delassus/rows/asked_nodes.hpp>
#include <delassus/rows/row_view.hpp>

#include <concepts>
#include <cstddef>
#include <span>
#include <utility>

namespace delassus {

/// A coupled set that knows the part C of A⁻¹ that chosen blocks have: (width n) × (width n) numbers by
/// columns for n blocks of one body, each named once; zero where a block does not move.
template <class S>
concept NodeCompliantSet = requires(const S set, Index b, std::span<const Index> blocks,
                                    std::span<typename S::Scalar> C) {
  { set.body_of(b) } -> std::same_as<Index>;  // A couples only blocks of one body
  { set.node_compliance(blocks, C) } -> std::same_as<void>;
};

namespace inner {

/// W_ij = Σ_e Σ_f H_e C_ef H_fᵀ, e and f the entries of items i and j on one body: first V = C Σ_e H_eᵀ at
/// all touched nodes of the body, then V_fᵀ H_fᵀ for every item on it. C depends on the nodes alone, not on
/// the directions of the rows.
template <class T>
class NodalRows {
 public:
  /// Finds the touched nodes of set s, body by body, and asks for their C. `by`: what several workers keep of
  /// the set, and the execution.
  template <class Set, class... By>
  void prepare(const Set& set, const RowView<T>* pools, int count, int s, By&... by) {
    constexpr int width = Set::width;
    if (touched_.size() <= std::size_t(s)) touched_.resize(std::size_t(s) + 1);
    Touched& t = touched_[std::size_t(s)];
    t.nodes.clear();
    t.slot.assign(std::size_t(set.blocks()), -1);
    for (int p = 0; p < count; ++p) {
      const SetBlocksView<T>& H = pools[p].set[s];
      for (Index e = 0; e < H.offset[pools[p].items]; ++e)
        if (std::exchange(t.slot[std::size_t(H.block[e])], 0) < 0)
          t.nodes.emplace_back(set.body_of(H.block[e]), H.block[e]);
    }
    inner::sort(t.nodes);
    t.bodies.clear();
    t.blocks.clear();
    t.owner.clear();
    std::size_t size = 0;
    for (Index k = 0; k < Index(t.nodes.size()); ++k) {
      if (k == 0 || t.nodes[k].first != t.nodes[k - 1].first) t.bodies.push_back({k, 0, 0});
      t.slot[t.nodes[k].second] = k;
      t.owner.push_back(Index(t.bodies.size()) - 1);
      t.blocks.push_back(t.nodes[k].second);
      ++t.bodies.back().count;
    }
    for (Body& body : t.bodies) {
      body.C = size;
      size += body.size(width);
    }
    t.C.resize(size);
    find_compliance(set, t, by...);
    t.items.resize(std::size_t(count));
    for (int p = 0; p < count; ++p) find_items(pools[p], s, t, t.items[std::size_t(p)]);
  }

  /// f(b, j, W_ij) for all items j of all pools b that share a body of set s with item i of pool a, W_ij by
  /// columns; twice when they share two. V and W are room at work.
  template <class F>
  void each(const RowView<T>* pools, int s, int a, Index i, Array<T>& V, Array<T>& W, const F& f) const {
    const Touched& t = touched_[std::size_t(s)];
    const RowView<T>& pool = pools[a];
    const SetBlocksView<T>& mine = pool.set[s];
    const int Ra = pool.rows, width = mine.width;
    for (Index e = mine.offset[i]; e < mine.offset[i + 1]; ++e) {
      const Index owner = t.owner[t.slot[mine.block[e]]];
      if (is_repeated(mine, t, i, e)) continue;
      const Body& body = t.bodies[owner];
      const std::size_t length = width * body.count;
      V.assign(Ra * length, T(0));
      for (Index g = e; g < mine.offset[i + 1]; ++g) {
        const Index slot = t.slot[mine.block[g]];
        if (t.owner[slot] != owner) continue;
        const T* C = &t.C[body.C + width * (slot - body.first) * length];
        const T* H = mine.H + std::ptrdiff_t(Ra * width) * g;
        for (int r = 0; r < Ra; ++r)
          for (int c = 0; c < width; ++c)
            add_multiple(H[r + Ra * c], C + c * length, &V[r * length], Index(length));
      }
      for (std::size_t b = 0; b < t.items.size(); ++b) {
        const ItemsOnBodies& items = t.items[b];
        for (auto x = first_of(items, owner); x != items.end() && x->first == owner; ++x) {
          W.assign(std::size_t(Ra * pools[b].rows), T(0));
          add_block(pools[b], s, t, *x, V.data(), length, Ra, W.data());
          f(int(b), x->second, W.data());
        }
      }
    }
  }

 private:
  using ItemsOnBodies = Array<std::pair<Index, Index>>;  ///< (body's number, item), ascending
  using Body = AskedNodes;                               ///< among the touched ones
  struct Touched {
    Array<std::pair<Index, Index>> nodes;  ///< (body, block), ascending
    Array<Index> blocks, slot, owner;      ///< block of a node; node of a block; number of a node's body
    Array<Body> bodies;
    Array<T> C;
    OwningArray<ItemsOnBodies> items;  ///< by pool
  };

  template <class Set>
  static void find_compliance(const Set& set, Touched& t) {
    for (const Body& body : t.bodies)
      set.node_compliance(std::span<const Index>(t.blocks).subspan(body.first, body.count),
                          std::span<T>(t.C).subspan(body.C, body.size(Set::width)));
  }
  template <class Set>
  static void find_compliance(const Set& set, Touched& t, auto& by, const auto& execution) {
    set.node_compliances(t.blocks, t.bodies, t.C.data(), by, execution);
  }

  /// An entry before e of the same item is on the same body.
  static bool is_repeated(const SetBlocksView<T>& blocks, const Touched& t, Index i, Index e) {
    for (Index g = blocks.offset[i]; g < e; ++g)
      if (t.owner[t.slot[blocks.block[g]]] == t.owner[t.slot[blocks.block[e]]]) return true;
    return false;
  }

  static void find_items(const RowView<T>& pool, int s, const Touched& t, ItemsOnBodies& items) {
    const SetBlocksView<T>& blocks = pool.set[s];
    items.clear();
    for (Index i = 0; i < pool.items; ++i)
      for (Index e = blocks.offset[i]; e < blocks.offset[i + 1]; ++e)
        if (!is_repeated(blocks, t, i, e)) items.emplace_back(t.owner[t.slot[blocks.block[e]]], i);
    inner::sort(items);
  }
  static const std::pair<Index, Index>* first_of(const ItemsOnBodies& items, Index owner) {
    return inner::lower_bound(items.begin(), items.end(), std::pair<Index, Index>(owner, -1));
  }

  /// W += Σ_f V_fᵀ H_fᵀ over the entries f of an item on one body.
  static void add_block(const RowView<T>& pool, int s, const Touched& t, std::pair<Index, Index> item,
                        const T* along, std::size_t length, int Ra, T* W) {
    const SetBlocksView<T>& theirs = pool.set[s];
    const int Rb = pool.rows, width = theirs.width;
    for (Index f = theirs.offset[item.second]; f < theirs.offset[item.second + 1]; ++f) {
      const Index slot = t.slot[theirs.block[f]];
      if (t.owner[slot] != item.first) continue;
      const T* V = &along[width * (slot - t.bodies[item.first].first)];
      const T* H = theirs.H + std::ptrdiff_t(Rb * width) * f;
      for (int q = 0; q < Rb; ++q)
        for (int c = 0; c < width; ++c) {
          const T h = H[q + Rb * c];
          for (int r = 0; r < Ra; ++r) W[r + Ra * q] += V[r * length + c] * h;
        }
    }
  }

  OwningArray<Touched> touched_;
};

}  // namespace inner
}  // namespace delassus
