/// One triangle of the fronts of a multifrontal factorization: the columns of its factor, and what each front
/// leaves its parent.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/linear/inner/dense_kernel.hpp>
#include <delassus/linear/inner/front_layout.hpp>
#include <delassus/linear/supernodes.hpp>
#include <delassus/math/long_vectors.hpp>

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

namespace delassus::inner {

/// What is known of the fronts before any number is: made once a pattern.
template <class Index>
struct BasicFrontPlan {
  SupernodalPattern pattern;
  LowerEntries entries;
  FrontLayout layout;

  /// All diagonal blocks, w numbers each way, and the pairs (i, j), i ≠ j, in any order, repeats allowed. See
  /// `NestedDissection::order`.
  void analyse(int w, Index blocks, std::span<const std::pair<Index, Index>> pairs,
               std::span<const Vec3> positions = {}) {
    Array<std::pair<Index, Index>> unique;
    for (auto [i, j] : pairs) unique.emplace_back(std::minmax(i, j));
    inner::sort(unique);
    inner::drop_repeats(unique);
    const NodeGraph graph(blocks, unique);
    pattern.analyse(graph, NestedDissection{}.order(graph, positions));
    entries.analyse(graph, pattern);
    layout.analyse(pattern, w);
  }
  Index blocks() const { return pattern.nodes(); }
  Index fronts() const { return Index(layout.fronts.size()); }
  const Supernode& supernode(Index s) const { return pattern.supernodes()[s]; }
};

using FrontPlan = BasicFrontPlan<Index>;

/// A front of m rows is its first columns, m high, and the part below them, which is the parent's to add: of
/// both only the lower triangle, with whole blocks on the diagonal, is meant.
template <int w, class T>
class FrontTriangle {
 public:
  void resize(const FrontPlan& plan) {
    factor_.resize(plan.layout.factor_size);
    stack_.resize(plan.layout.stack_size);
  }
  /// Without room for parts, which somebody else has.
  void resize_columns(const FrontPlan& plan) { factor_.resize(plan.layout.factor_size); }

  Columns<T> columns(const FrontPlan& plan, Index s) {
    return {&factor_[plan.layout.fronts[s].factor], w * plan.supernode(s).rows.size()};
  }
  Columns<const T> columns(const FrontPlan& plan, Index s) const {
    return {&factor_[plan.layout.fronts[s].factor], w * plan.supernode(s).rows.size()};
  }
  /// What a front leaves its parent, (w below) × (w below).
  Columns<T> part(const FrontPlan& plan, Index s) {
    return {stack_.data() + plan.layout.fronts[s].update, std::size_t(w) * plan.supernode(s).below()};
  }

  /// The columns of front s ← the matrix's own entries, diagonal(place) and below(entry) by blocks, and what
  /// its children left there.
  void open(const FrontPlan& plan, Index s, const auto& diagonal, const auto& below) {
    open_some(plan, s, 0, plan.supernode(s).width, columns(plan, s), diagonal, below,
              [&](Index child) { return part(plan, child); });
  }
  /// The part for the parent += what the children left there.
  void pass_on(const FrontPlan& plan, Index s) {
    pass_on_some(plan, s, 0, plan.supernode(s).below(), part(plan, s),
                 [&](Index child) { return part(plan, child); });
  }

  /// Opens front s, factors its columns, and leaves its part for the parent; false where a pivot is not
  /// positive. `part_of(s)`: where a front leaves it.
  bool factor_front(const FrontPlan& plan, Index s, const auto& diagonal, const auto& below,
                    const auto& part_of, DenseKernel<T>& kernel) {
    const Supernode& x = plan.supernode(s);
    const Index height = w * Index(x.rows.size()), width = w * x.width, rest = height - width;
    const Columns<T> L = columns(plan, s);
    open_some(plan, s, 0, x.width, L, diagonal, below, part_of);
    if (!kernel.factor(L, height, width)) return false;
    const Columns<const T> L21{L.at(width, 0), L.stride};
    kernel.negated_product(part_of(s), L21, L21, rest, rest, width, true);
    pass_on_some(plan, s, 0, x.below(), part_of(s), part_of);
    return true;
  }

  // --- the same of the columns of nodes first … last − 1 of the front or of its part, for several workers

  [[gnu::always_inline]] static void open_some(const FrontPlan& plan, Index s, Index first, Index last,
                                               Columns<T> L, const auto& diagonal, const auto& below,
                                               const auto& part_of) {
    const Supernode& x = plan.supernode(s);
    std::fill_n(L.at(0, w * first), L.stride * w * (last - first), T(0));
    for (Index c = first; c < last; ++c) {
      const Index j = x.first + c;
      put(L.from(w * c, w * c), diagonal(j));
      for (Index e = plan.entries.start[j], at = c; e < plan.entries.start[j + 1]; ++e) {
        while (x.rows[at] != plan.entries.row[e]) ++at;
        put(L.from(w * at, w * c), below(e));
      }
    }
    for (const Index child : x.children)
      add(plan, child, part_of(child), L.from(w * first, w * first), w * first, w * last);
  }
  [[gnu::always_inline]] static void pass_on_some(const FrontPlan& plan, Index s, Index first, Index last,
                                                  Columns<T> part, const auto& part_of) {
    const Supernode& x = plan.supernode(s);
    for (const Index child : x.children)
      add(plan, child, part_of(child), part.from(w * first, w * first), w * (x.width + first),
          w * (x.width + last));
  }

 private:
  static void put(Columns<T> to, const auto& block) {
    for (int c = 0; c < w; ++c) std::copy_n(block.data() + w * c, w, to.at(0, c));
  }

  /// The parent's columns first … last − 1 += what a child left; `to` begins with entry (first, first).
  static void add(const FrontPlan& plan, Index child, Columns<T> from, Columns<T> to, Index first,
                  Index last) {
    const auto& runs = plan.layout.fronts[child].runs;
    for (std::size_t b = 0; b < runs.size(); ++b)
      for (Index c = 0; c < w * runs[b].length; ++c) {
        const Index column = w * runs[b].to + c;
        if (column < first || column >= last) continue;
        const T* source = from.at(0, w * runs[b].from + c);
        T* target = to.at(0, column - first) - first;
        for (std::size_t a = b; a < runs.size(); ++a) {
          const Index skip = a == b ? c : 0, length = w * runs[a].length - skip;
          add_multiple<T>(1, source + w * runs[a].from + skip, target + w * runs[a].to + skip, length);
        }
      }
  }

  Array<T> factor_, stack_;
};

}  // namespace delassus::inner
