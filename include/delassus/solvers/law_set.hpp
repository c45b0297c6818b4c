/// The laws of all pools with what they remember between sweeps, as a solver sees them.
#pragma once

#include <delassus/constraints/constraints.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/pack.hpp>
#include <delassus/core/ranges.hpp>
#include <delassus/core/slice.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/rows/show_rows.hpp>
#include <delassus/solvers/inner/functions_of_w.hpp>
#include <delassus/solvers/inner/law_loops.hpp>
#include <delassus/solvers/law_table.hpp>

#include <concepts>
#include <tuple>
#include <type_traits>
#include <utility>

namespace delassus {

namespace inner {

/// `items` and `memory` by place, `places` of the items: null where these are all.
template <class Law, Needs needs, class T>
void show_law(const Law& law, const void* items, const Index* places, void* memory, PoolView<T>& view) {
  view.table = law_table<Law, T>();
  if constexpr (needs != Needs::sweeps && refines<Law>(refine::tangent)) view.tangent = &law_tangent<Law, T>;
  if constexpr (needs == Needs::convex_tangents && refines<Law>(refine::tangent)) view.convex_tangent = &convex_law_tangent<Law, T>;
  view.turns = turning_rows<Law>();
  view.law = &law;
  view.law_items = items;
  view.places = places;
  view.memory = memory;
}

}  // namespace inner

template <class Constraints, class T, Needs needs = Needs::tangents>
class LawSet;

/// Shows each pool with its law and its memory. `prepare` runs once a step, when W is built; the rows and W stay where they
/// are as long as the views are used.
template <class... Laws, class T, Needs needs>
class LawSet<Constraints<Laws...>, T, needs> {
  static constexpr int pools = int(sizeof...(Laws));
  using Memories = inner::Pack<ArrayOrVector<inner::memory_of_t<inner::innermost_t<Laws>, double>>...>;
  template <int p>
  using Law = std::tuple_element_t<p, std::tuple<Laws...>>;

 public:
  LawSet() = default;  ///< of nothing, before it is attached
  explicit LawSet(const Constraints<Laws...>& constraints) : constraints_(&constraints) {}

  /// The constraints may have moved with their loop.
  void attach(const Constraints<Laws...>& constraints) { constraints_ = &constraints; }

  /// Room for `items` of each law: `prepare` allocates nothing up to there.
  void reserve(std::size_t items) {
    memory_.each([items](auto& memory) { memory.reserve(items); });
  }

  /// Shows the rows and W, and lets each law prepare what it keeps of its own blocks of W.
  void prepare(auto& W, auto& rows, double h) {
    show(W, rows);
    for (const PoolView<T>& pool : views_) pool.table->prepare({&pool, nullptr, pool.items}, h);
  }
  /// The same where `ranges` says who does which items; `numbers` are 0, 1 … up to that of the last item.
  void prepare(auto& W, auto& rows, double h, const auto& ranges, const Index* numbers) {
    show(W, rows);
    for (const PoolView<T>& pool : views_)
      ranges(pool.items, 128, [&](inner::Range range) { pool.table->prepare({&pool, numbers + range.first, range.count()}, h); });
  }
  /// The same without what laws keep: for rows of other numbers.
  template <class Operator, class Rows>
  void show(Operator& W, Rows& rows) {
    sets_.resize(std::size_t(pools * Rows::set_count));
    for_each_index<pools>([&](auto p) __attribute__((always_inline)) { show_pool<p>(W, rows); });
  }
  const PoolView<T>& view(int pool) const { return views_[pool]; }
  inner::Slice<const PoolView<T>> views() const { return {views_, pools}; }

  /// |F_i| of item i of a pool, m/s, as `Measure` sums it: `length` is its island's.
  double natural_error(int pool, Index i, double length) const {
    const PoolView<T>& view = views_[pool];
    MeasureSums sums{.length = length};
    view.table->measure({&view, &i, 1}, sums);
    return std::sqrt(sums.residual);
  }

 private:
  template <int p, class Operator, class Rows>
  [[gnu::always_inline]] void show_pool(Operator& W, Rows& rows) {
    PoolView<T>& view = views_[p];
    auto& memory = inner::part<p>(memory_);
    const auto& pool = constraints_->template pool<p>();
    auto* sets = sets_.data() + p * Rows::set_count;
    inner::show_rows(rows.template pool<p>(), p, view, sets);
    memory.resize(std::size_t(view.items));
    const Index* places = nullptr;
    if constexpr (!ContactLaw<Law<p>>) places = pool.slots.active().data();
    inner::show_law<Law<p>, needs>(pool.law, pool.items.data(), places, memory.data(), view);
    inner::show_W<p>(W, rows, view, sets, &blocks_[p * pools], own_diagonals_[p]);
  }

  const Constraints<Laws...>* constraints_ = nullptr;
  Memories memory_;
  PoolView<T> views_[pools > 0 ? pools : 1];
  BlockRowsView<T> blocks_[pools > 0 ? pools * pools : 1];
  Array<SetBlocksView<T>> sets_;
  Array<T> own_diagonals_[pools > 0 ? pools : 1];  ///< of a W that shows no arrays
};

}  // namespace delassus
