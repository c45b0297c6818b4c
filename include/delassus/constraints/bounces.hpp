/// Restitution of the rows of a step: which of them bounce, land and part, and what is remembered of them.
#pragma once

#include <delassus/constraints/rebound.hpp>
#include <delassus/constraints/row_past.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/owning_array.hpp>
#include <delassus/rows/islands.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/world_view.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace delassus {

/// What restitution does to the rows of a step, and what it remembers for the next one. Lists by pool and row.
template <class T>
struct Bounces {
  OwningArray<Array<T>> added;     ///< to the bias, m/s
  OwningArray<Array<T>> returned;  ///< to the bodies, of what they lost as they landed, J; empty: nothing in this pool
  RowPasts pasts;                  ///< rows of the last step
  OwningArray<Array<std::uint32_t>> generations;  ///< of the bodies whose velocities these are, by set
  OwningArray<Array<T>> velocities[2];  ///< of the bodies by set, at the start of the last step and of the one before; NaN: not there
  Array<std::size_t> rows;  ///< of `pasts.now()`, in their pools
  Array<Index> blocks;      ///< of each island; empty: nobody asked
  Array<Together> choices;  ///< of each island with one body

  template <class AllRows>
  void begin(const AllRows& all, double h, const std::size_t* counts, int sets) {
    for (auto& list : velocities) make_room(list, counts, std::size_t(sets));
    std::size_t items = 0;
    for (auto* list : {&added, &returned}) list->clear(), list->resize(all.size());
    for (std::size_t p = 0; p < all.size(); ++p) {
      items += std::size_t(all[p].items());
      returned[p].reserve(all[p].phi->capacity());  // now, and not when a row lands
    }
    blocks.reserve(items);
    choices.reserve(items);
    pasts.begin(h);
    rows.clear();
    blocks.clear();
    choices.clear();
  }
  /// The step is over; v is that of its start.
  void end(const T* const* v) {
    pasts.end();
    velocities[1].swap(velocities[0]);
    for (std::size_t s = 0; s < velocities[0].size(); ++s)
      for (std::size_t k = 0; k < velocities[0][s].size(); ++k) velocities[0][s][k] = v[s][k];
  }
  /// Who took the place of a removed body was not there before. Sets come in their order.
  void look_at(const auto& set, std::size_t s) {
    if (s >= generations.size()) generations.resize(s + 1);
    constexpr std::size_t width = std::remove_cvref_t<decltype(set)>::width;
    auto& known = generations[s];
    const std::size_t before = known.size();
    known.resize(std::size_t(set.blocks()));
    for (std::size_t b = 0; b < known.size(); ++b) {
      const std::uint32_t now = set.handle(Index(b)).generation;
      if (b < before && now != known[b])
        for (auto& list : velocities) std::fill_n(list[s].data() + width * b, width, std::numeric_limits<T>::quiet_NaN());
      known[b] = now;
    }
  }
  void memory(auto& archive) { archive(pasts, generations, velocities[0], velocities[1]); }
  /// What the rows of the item's island do, where nothing else that moves is in it; else null.
  Together* choice_of(const Islands<T>& islands, int p, Index i) {
    if (blocks.empty()) islands.count_blocks(blocks), choices.assign(blocks.size(), Together::undecided);
    const Index island = islands.island_of(p, i);
    return island >= 0 && blocks[island] == 1 ? &choices[island] : nullptr;
  }

 private:
  static void make_room(OwningArray<Array<T>>& list, const std::size_t* counts, std::size_t sets) {
    list.resize(sets);
    for (std::size_t s = 0; s < sets; ++s) {
      const std::size_t there = list[s].size();
      list[s].resize_for_overwrite(counts[s]);
      for (std::size_t k = there; k < counts[s]; ++k) list[s][k] = std::numeric_limits<T>::quiet_NaN();
    }
  }
};

namespace inner {

/// A row with e > 0 in this step and in the last one, opening positive.
struct BouncingRow {
  double gap, velocity, free;     ///< free: the velocity without impulses
  double last_velocity, earlier;  ///< H v of the last step and of the one before
  double h, last_h, earlier_h, theta;
  const RowPast* past;  ///< null: it was not there

  /// Of joints and neighbours the free motion knows nothing, the last velocities of the bodies do. Of two accelerations the smaller
  /// one holds: an impact elsewhere, or a host who sets a velocity, is in one of them alone. Where they differ, or one is not known,
  /// both may have one, and the free motion holds if it is smaller still. Where the row pushed, this is what it
  /// was before.
  double acceleration() const {
    if (was_held()) return past->acceleration;
    const double last = (velocity - last_velocity) / last_h, before = (last_velocity - earlier) / earlier_h;
    const double falling = (free - velocity) / h;
    if (!std::isfinite(last)) return falling;
    const double smaller = std::abs(before) < std::abs(last) ? before : last;
    const bool was_hit = !std::isfinite(before) || std::abs(last - before) > 0.5 * std::max(std::abs(last), std::abs(before));
    if (was_hit && std::abs(last - falling) <= 1e-3 * std::abs(falling)) return falling;  // it falls, and was hit before
    return was_hit && std::abs(falling) < std::abs(smaller) ? falling : smaller;
  }
  bool was_held() const { return past && past->impulse > 0; }
  /// For θ = 1, v is the velocity of the middle of the last step, and moves the row. For θ = ½ it is that of the end, and the mean
  /// with u moves the row. Steps that grow shorter must not make who rests bounce. So a row that was held counts as if it had been for
  /// no longer than this step, and one that left the surface in a longer step and was held in the next comes back no faster than it left.
  double now(double acceleration) const {
    const bool hopped = was_held() && last_velocity > 0 && last_h < earlier_h;
    return (hopped ? std::max(velocity, -last_velocity) : velocity) + (theta - 0.5) * (was_held() ? std::min(h, last_h) : last_h) * acceleration;
  }
  double height(double acceleration) const { return gap + (1 - theta) * (h * velocity + 0.25 * h * h * acceleration); }
  /// Or comes to the surface at the end of the step: which side of it is rounding, and another one for each corner of a face.
  bool closes(double acceleration) const { return velocity < 0 && gap + h * (velocity + h * acceleration) < -1e-9 * h * velocity; }
  /// The free motion does not bring it to the surface, by more than what corners of one face differ.
  bool stays_away() const { return gap > 0 && gap + h * free > 1e-2 * h * std::abs(free); }
  Closing closing(double acceleration, bool may_land) const {
    const double a = std::min(0.0, acceleration), fall = std::max(std::max(0.0, velocity - free), -h * a);
    return {.gap = gap, .velocity = now(a), .acceleration = a, .height = height(a), .least = 0.5 * fall, .h = h, .may_land = may_land};
  }
  /// The energy that its impulse took from the bodies as it landed, J.
  double taken() const { return std::max(0.0, -0.5 * past->impulse * (last_velocity + velocity)); }
  /// It fell into an overlap and does not bounce: it comes back to the surface, with no more than falling for a step gives.
  double comes_back(double acceleration) const {
    return !was_held() && gap < 0 ? std::min(-gap / h, -h * std::min(0.0, acceleration)) : 0;
  }
};

}  // namespace inner

/// `counts` are the numbers of v by set. A row with a bound (`RowKind::lower` or `upper`) that closes within the step gets the stronger of what `rebound` says and the
/// push-out speed, never their sum. Rows may land where one body is alone in its island and moves by u (θ = 1). In a tower a
/// landing is an impact of its own, which throws the boxes out of line.
template <class Laws, class Rows, class T>
void add_restitution(const WorldView<T>& world, Laws laws, Rows rows, const Islands<T>& islands, const T* const* v_free,
                     const T* const* v, const std::size_t* counts, int sets, double h, double theta,
                     Bounces<T>& bounces) {
  bounces.begin(rows, h, counts, sets);
  for (std::size_t p = 0; p < rows.size(); ++p) {
    const auto& pool = rows[p];
    const auto& law = *laws[p].law;
    Array<T>&added = bounces.added[p], &returned = bounces.returned[p];
    added.assign_zeros(pool.phi->size());
    if (!law.restitution) continue;
    T free[most_rows], start[most_rows], last[most_rows], earlier[most_rows];
    for (Index i = 0; i < pool.items(); ++i) {
      const double restitution = law.restitution(laws[p].pool, i);
      if (!(restitution > 0)) continue;
      const ItemName name = law.name(laws[p].pool, world, i);
      for (int k = 0; k < pool.rows; ++k) free[k] = start[k] = last[k] = earlier[k] = T(0);
      for (int s = 0; s < pool.sets; ++s) {
        pool.set[s].products->rate(pool.set[s], i, v_free[s], free, free);
        pool.set[s].products->rate(pool.set[s], i, v[s], start, start);
        pool.set[s].products->rate(pool.set[s], i, bounces.velocities[0][std::size_t(s)].data(), last, last);
        pool.set[s].products->rate(pool.set[s], i, bounces.velocities[1][std::size_t(s)].data(), earlier, earlier);
      }
      for (int k = 0; k < pool.rows; ++k) {
        const std::size_t row = std::size_t(i) * std::size_t(pool.rows) + std::size_t(k);
        if (law.kinds[k] != RowKind::lower && law.kinds[k] != RowKind::upper) continue;
        if (pool.is_soft(row)) continue;
        const double sign = law.kinds[k] == RowKind::lower ? 1 : -1, phi = sign * double((*pool.phi)[row]);
        const double plain = sign * double((*pool.bias)[row]);
        const std::uint32_t place = std::uint32_t(most_rows) * std::uint32_t(p) + std::uint32_t(k);
        const RowPast* const past = bounces.pasts.find(name, place);
        const inner::BouncingRow is{phi,  sign * double(start[k]), sign * double(free[k]), sign * double(last[k]), sign * double(earlier[k]),
                                     h,    bounces.pasts.last_h(),  bounces.pasts.earlier_h(), theta,  past};
        RowPast& now = bounces.pasts.add(name, place);
        bounces.rows.push_back(row);
        now.acceleration = is.acceleration();
        double leaves = 0;
        if (past && past->parts > 0 && is.was_held()) {
          leaves = past->parts + 0.5 * h * std::min(0.0, past->acceleration);
          if (!(leaves > 0)) continue;
          if (returned.empty()) returned.assign_zeros(pool.phi->size());
          returned[row] = T(is.taken());
        } else if (is.closes(now.acceleration)) {
          Together* const choice = theta == 1 ? bounces.choice_of(islands, int(p), i) : nullptr;
          Closing closing = is.closing(now.acceleration, choice);
          if (choice) closing.others = *choice;
          const Rebound does = rebound(closing, restitution);
          if (choice && *choice == Together::undecided)
            *choice = does.leaves > 0 ? Together::leave_at_once : does.parts > 0 ? Together::land : Together::undecided;
          now.parts = does.parts;
          leaves = does.leaves > 0 || does.parts > 0 ? does.leaves : is.comes_back(now.acceleration);
        } else if (theta == 1 && is.stays_away() && bounces.choice_of(islands, int(p), i)) {
          // What bounces beside it may drive it into the surface. It bounces from there in the next step, where it would have lost its speed.
          (*pool.bias)[row] = T(sign * (plain + 2 * phi / h));
          (*pool.d)[row] = free[k] + (*pool.bias)[row];
          continue;
        }
        if (!(leaves > 0)) continue;
        const double bias = std::min(phi < 0 ? plain : 0.0, -leaves);
        added[row] = T(sign * (bias - plain));
        (*pool.bias)[row] = T(sign * bias);
        (*pool.d)[row] = free[k] + (*pool.bias)[row];
      }
    }
  }
}

/// After the solve.
template <class Rows, class T>
void remember_impulses(Rows rows, Bounces<T>& bounces) {
  for (std::size_t i = 0; i < bounces.rows.size(); ++i) {
    RowPast& row = bounces.pasts.now()[i];
    row.impulse = std::abs(double((*rows[row.row / most_rows].lambda)[bounces.rows[i]]));
  }
}

}  // namespace delassus
