/// Which contacts and limits push, from step to step: what makes an arc smooth where it stays the same.
#pragma once

#include <delassus/constraints/constraints.hpp>
#include <delassus/constraints/law.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/row_system.hpp>

#include <algorithm>
#include <cstdint>
#include <type_traits>

namespace delassus::inner {

/// The pairs of bodies and the stops that push in a step, by name, each with its force.
class PushingRows {
 public:
  struct Entry {
    int pool;
    std::uint64_t name;  ///< the pair of a contact; the place of an item
    double force;        ///< N or N·m, the sum of the pair's normal ones
    double slipping;     ///< N, of it where friction is at its bound
    std::uint32_t points;  ///< a sum of names of the points that push
    double gap;          ///< (1 + e) times the largest at which it pushed, in sizes of the smaller body
    friend bool operator<(const Entry& x, const Entry& y) { return x.pool != y.pool ? x.pool < y.pool : x.name < y.name; }
  };

  const Array<Entry>& entries() const { return entries_; }
  bool are_none() const { return entries_.empty(); }
  void memory(auto& archive) { archive(entries_); }

  /// Those of the rows that were solved last, in a step of h (s).
  template <class Step, class Lengths>
  const PushingRows& take(Step& step, const Lengths& lengths, double h) {
    entries_.clear();
    if constexpr (Step::has_constraints && Step::has_problem) {
      for_each_index<Step::Laws::pool_count>([&](auto p) {
        auto& pool = step.laws().template pool<p>();
        using Law = std::remove_cvref_t<decltype(pool.law)>;
        constexpr auto kinds = row_kinds<Law>();
        constexpr bool is_one_sided = (kinds[0] == RowKind::lower) || (kinds[0] == RowKind::upper);
        if constexpr (is_one_sided) {
          const auto& rows = step.rows.template pool<p>();
          for (Index i = 0; i < rows.items(); ++i) {
            double push = 0, gap = 0, slipping = 0;
            std::uint32_t points = 0;
            for (int k = 0; k < Law::rows; ++k) {
              if (kinds[k] != RowKind::lower && kinds[k] != RowKind::upper) continue;
              const double lambda = std::abs(double(rows.lambda[i][k]));
              if (!(lambda > 0)) continue;
              push += lambda;
              gap = std::max(gap, kinds[k] == RowKind::upper ? -double(rows.phi[i][k]) : double(rows.phi[i][k]));
            }
            if (!(push > 0)) continue;
            std::uint64_t name = std::uint64_t(i);
            double size = 1, e = 0;
            if constexpr (ContactLaw<Law>) {
              const auto& result = step.contact_cache.results[pool.item(i).result];
              const auto& record = result.record;
              name = record.pair;
              points = std::uint32_t(record.feature) * 2654435761u + 1;
              if (result.is_sliding) slipping = push / h;
              size = std::min(lengths.of(record.a.set, record.a.block), lengths.of(record.b.set, record.b.block));
            } else {
              name = std::uint64_t(pool.slots.active()[i]);
            }
            if constexpr (requires { who_refines<refine::restitution>(pool.law).restitution(pool.item(i)); })
              e = double(who_refines<refine::restitution>(pool.law).restitution(pool.item(i)));
            entries_.push_back({int(p), name, push / h, slipping, points, (1 + e) * gap / size});
          }
        }
      });
      merge();
    }
    return *this;
  }

 private:
  void merge() {
    if (!is_sorted(entries_.data(), entries_.data() + entries_.size(), [](const Entry& x, const Entry& y) { return x < y; }))
      sort(entries_, [](const Entry& x, const Entry& y) { return x < y; });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      if (kept > 0 && !(entries_[kept - 1] < entries_[i])) {
        entries_[kept - 1].force += entries_[i].force;
        entries_[kept - 1].slipping += entries_[i].slipping;
        entries_[kept - 1].points += entries_[i].points;
        entries_[kept - 1].gap = std::max(entries_[kept - 1].gap, entries_[i].gap);
      } else {
        entries_[kept++] = entries_[i];
      }
    }
    entries_.resize(kept);
  }
  Array<Entry> entries_;
};

/// What changes within a step: what pushes in one part of it and not in another, forces below 1 % of its largest aside.
struct PushChange {
  bool is_any = false;     ///< of whatever kind
  bool is_impact = false;  ///< something pushes that did not before
  bool is_shift = false;   ///< a pair slips in one part and sticks in another, or pushes at other points
  double gap = 0;          ///< the largest at which it does, times 1 + e, in sizes of bodies
};

/// `before`: at the end of the last step. `parts`: those of this one, the coarse one among them; gaps are taken of `fine`.
template <std::size_t n>
PushChange change_of(const PushingRows& before, const PushingRows* const (&parts)[n], std::size_t fine) {
  PushChange change;
  std::size_t at[n + 1] = {};
  const PushingRows* all[n + 1] = {&before};
  for (std::size_t k = 0; k < n; ++k) all[k + 1] = parts[k];
  for (;;) {
    const PushingRows::Entry* least = nullptr;
    for (std::size_t k = 0; k <= n; ++k)
      if (at[k] < all[k]->entries().size()) {
        const auto& e = all[k]->entries()[at[k]];
        if (!least || e < *least) least = &e;
      }
    if (!least) return change;
    const PushingRows::Entry name = *least;
    double force[n + 1] = {}, gap[n + 1] = {}, most = 0;
    bool slips[n + 1] = {};
    std::uint32_t points[n + 1] = {};
    for (std::size_t k = 0; k <= n; ++k) {
      if (at[k] >= all[k]->entries().size()) continue;
      const auto& e = all[k]->entries()[at[k]];
      if (name < e || e < name) continue;
      force[k] = e.force, gap[k] = e.gap, slips[k] = e.slipping > 0.5 * e.force, points[k] = e.points, ++at[k];
      most = std::max(most, e.force);
    }
    bool some = false, none = false;
    for (std::size_t k = 0; k <= n; ++k) (force[k] > 1e-2 * most ? some : none) = true;
    for (std::size_t k = 1; k <= n; ++k) change.is_shift = change.is_shift || slips[k] != slips[0] || points[k] != points[0];
    if (!(some && none)) continue;
    change.is_any = true;
    if (force[0] > 1e-2 * most) continue;
    change.is_impact = true;
    for (std::size_t k = 1; k <= fine; ++k)
      if (force[k] > 1e-2 * most) change.gap = std::max(change.gap, gap[k]);
  }
}

}  // namespace delassus::inner
