/// Rows of W from the compliance of touched nodes: for a set whose A couples the nodes of a body.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/rows/row_system.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace delassus {

/// A coupled set that knows the part C of A⁻¹ that chosen blocks have: (width n) × (width n) numbers by columns for n
/// blocks of one body, each named once; zero where a block does not move.
template <class S>
concept NodeCompliantSet = requires(const S set, Index b, std::span<const Index> blocks,
                                    std::span<typename S::Scalar> C) {
  { set.body_of(b) } -> std::same_as<Index>;  // A couples only blocks of one body
  { set.node_compliance(blocks, C) } -> std::same_as<void>;
};

namespace inner {

template <class Rows>
class NodalRows;

/// W_ij = Σ_e Σ_f H_e C_ef H_fᵀ, e and f the entries of items i and j on one body: first V = C Σ_e H_eᵀ at
/// all touched nodes of the body, then V_fᵀ H_fᵀ for every item on it. C depends on the nodes alone, not on
/// the directions of the rows.
template <class T, int... w, int... R>
class NodalRows<RowSystem<T, Widths<w...>, R...>> {
 public:
  using Rows = RowSystem<T, Widths<w...>, R...>;
  static constexpr int pools = int(sizeof...(R));

  /// Finds the touched nodes of set s, body by body, and asks for their C.
  template <int s, class Set>
  void prepare(const Set& set, const Rows& rows) {
    constexpr int width = Rows::template width_of<s>;
    Touched& t = touched_[s];
    t.nodes.clear();
    t.slot.assign(set.blocks(), -1);
    for_each_index<pools>([&](auto p) {
      for (const Index b : std::get<s>(rows.template pool<p>().sets).block)
        if (std::exchange(t.slot[b], 0) < 0) t.nodes.emplace_back(set.body_of(b), b);
    });
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
      size += std::size_t(width * body.count) * (width * body.count);
    }
    t.C.resize(size);
    for (const Body& body : t.bodies)
      set.node_compliance(
          std::span<const Index>(t.blocks).subspan(body.first, body.count),
          std::span<T>(t.C).subspan(body.C, std::size_t(width * body.count) * (width * body.count)));
    for_each_index<pools>(
        [&](auto p) { find_items(std::get<s>(rows.template pool<p>().sets), t, t.items[p]); });
  }

  /// f(b, j, W_ij) for all items j of all pools b that share a body of set s with item i of pool a; twice
  /// when they share two.
  template <int s, int a, class F>
  void each(const Rows& rows, Index i, F&& f) {
    constexpr int width = Rows::template width_of<s>, Ra = Rows::template rows_of<a>;
    const Touched& t = touched_[s];
    const auto& mine = std::get<s>(rows.template pool<a>().sets);
    for (Index e = mine.offset[i]; e < mine.offset[i + 1]; ++e) {
      const Index owner = t.owner[t.slot[mine.block[e]]];
      if (is_repeated(mine, t, i, e)) continue;
      const Body& body = t.bodies[owner];
      const std::size_t length = width * body.count;
      V_.assign(Ra * length, T(0));
      for (Index g = e; g < mine.offset[i + 1]; ++g) {
        const Index slot = t.slot[mine.block[g]];
        if (t.owner[slot] != owner) continue;
        const T* C = &t.C[body.C + width * (slot - body.first) * length];
        for (int r = 0; r < Ra; ++r)
          for (int c = 0; c < width; ++c) add_times(&V_[r * length], mine.H[g](r, c), C + c * length, length);
      }
      for_each_index<pools>([&](auto b) {
        const auto& theirs = std::get<s>(rows.template pool<b>().sets);
        for (auto x = first_of(t.items[b], owner); x != t.items[b].end() && x->first == owner; ++x)
          f(b, x->second, block<Ra, width>(theirs, t, *x, length));
      });
    }
  }

 private:
  struct Body {
    Index first, count;  ///< its nodes among the touched ones
    std::size_t C;       ///< where its compliance begins
  };
  struct Touched {
    Array<std::pair<Index, Index>> nodes;  ///< (body, block), ascending
    Array<Index> blocks, slot, owner;  ///< block of a node; node of a block; number of a node's body
    std::vector<Body> bodies;
    Array<T> C;
    std::array<Array<std::pair<Index, Index>>, pools>
        items;  ///< by pool: (body's number, item), ascending
  };

  /// An entry before e of the same item is on the same body.
  static bool is_repeated(const auto& blocks, const Touched& t, Index i, Index e) {
    for (Index g = blocks.offset[i]; g < e; ++g)
      if (t.owner[t.slot[blocks.block[g]]] == t.owner[t.slot[blocks.block[e]]]) return true;
    return false;
  }

  static void find_items(const auto& blocks, const Touched& t,
                         Array<std::pair<Index, Index>>& items) {
    items.clear();
    for (Index i = 0; i + 1 < Index(blocks.offset.size()); ++i)
      for (Index e = blocks.offset[i]; e < blocks.offset[i + 1]; ++e)
        if (!is_repeated(blocks, t, i, e)) items.emplace_back(t.owner[t.slot[blocks.block[e]]], i);
    inner::sort(items);
  }
  static auto first_of(const Array<std::pair<Index, Index>>& items, Index owner) {
    return inner::lower_bound(items.data(), items.data() + items.size(), std::pair<Index, Index>(owner, -1));
  }

  /// Σ_f V_fᵀ H_fᵀ over the entries f of an item on one body.
  template <int Ra, int width, int Rb>
  Mat<Ra, Rb, T> block(const SetBlocks<Rb, width, T>& theirs, const Touched& t, std::pair<Index, Index> item,
                       std::size_t length) const {
    Mat<Ra, Rb, T> W = Mat<Ra, Rb, T>::Zero();
    for (Index f = theirs.offset[item.second]; f < theirs.offset[item.second + 1]; ++f) {
      const Index slot = t.slot[theirs.block[f]];
      if (t.owner[slot] != item.first) continue;
      const T* V = &V_[width * (slot - t.bodies[item.first].first)];
      for (int q = 0; q < Rb; ++q)
        for (int c = 0; c < width; ++c) {
          const T h = theirs.H[f](q, c);
          for (int r = 0; r < Ra; ++r) W(r, q) += V[r * length + c] * h;
        }
    }
    return W;
  }

  /// y += a x.
  static void add_times(T* y, T a, const T* x, std::size_t length) {
    Eigen::Map<Eigen::Array<T, Eigen::Dynamic, 1>>(y, length) +=
        a * Eigen::Map<const Eigen::Array<T, Eigen::Dynamic, 1>>(x, length);
  }

  std::array<Touched, sizeof...(w)> touched_;
  Array<T> V_;
};

}  // namespace inner
}  // namespace delassus
