/// Corrective motion: the impulses act on the bodies.
#pragma once

#include <delassus/compliance/add_impulses.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/slice.hpp>
#include <delassus/rows/islands.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>

namespace delassus {

namespace inner {

/// What is left of v_free + A⁻¹ Hᵀ λ below the rounding of its terms is no velocity: a body whose impulses cancel its
/// motion stands still to the last bit, wherever it is. Component by component, each against the largest of v_free.
template <class V>
void drop_rounding(V& v_next, const V& v_free) {
  using T = typename V::Scalar;
  constexpr T rounding = T(64) * std::numeric_limits<T>::epsilon();
  const T least = rounding * std::max(std::max(std::abs(v_free[0]), std::abs(v_free[1])), std::abs(v_free[2]));
  for (int k = 0; k < 3; ++k)
    if (std::abs(v_next[k]) <= least) v_next[k] = T(0);
}

}  // namespace inner

namespace inner {

/// v_next of set number s, whose first block is `first`; `inverse` answers with its A⁻¹.
template <class Set, class Inverse, class T>
void correct_set(Set& set, const Inverse& inverse, int s, Index first, AllRows<T> rows, Array<typename Set::Velocity>& scratch,
                 const Islands<T>& islands, Array<char>& is_nonfinite) {
  for (const Index b : set.active()) assign(set.v_next[b], set.v_free[b]);
  add_impulses(inverse, s, rows, set.v_next, scratch);
  for (const Index b : set.active()) {
    const Index island = islands.island_of(first + b);
    if (island < 0) continue;
    if (is_finite(set.v_next[b])) drop_rounding(set.v_next[b], set.v_free[b]);
    else is_nonfinite[island] = 1;
  }
}
/// No velocity for the bodies of those islands.
template <class Set, class T>
void void_set(Set& set, Index first, const Islands<T>& islands, const Array<char>& is_nonfinite) {
  for (const Index b : set.active()) {
    const Index island = islands.island_of(first + b);
    if (island >= 0 && is_nonfinite[island]) set_all(set.v_next[b], std::numeric_limits<T>::quiet_NaN());
  }
}

}  // namespace inner

/// v_next = v_free + A⁻¹ Hᵀ λ. The velocities of an island with one that is not finite, or whose solver met what is no
/// number, are all made so: `advance` leaves such bodies where they were, and no other island notices.
template <class World, class T, class Operator, class Scratch>
void correct(World& world, AllRows<T> rows, Operator& W, Scratch& scratch, const Islands<T>& islands,
             inner::Slice<const SolveReport> reports, Array<char>& is_nonfinite) {
  is_nonfinite.assign(islands.count(), 0);
  Index first = 0;
  for (std::size_t k = 0; k < std::min(reports.size(), is_nonfinite.size()); ++k)
    is_nonfinite[k] = reports[k].status == Status::quarantined;
  world.each([&](auto& set, auto s) __attribute__((always_inline)) {
    inner::correct_set(set, inner::inverse_of<s>(W, set, 1), s, first, rows, inner::part<s>(scratch), islands, is_nonfinite);
    first += set.blocks();
  });
  bool are_finite = true;
  for (const char is : is_nonfinite) are_finite = are_finite && !is;
  if (are_finite) return;
  first = 0;
  world.each([&](auto& set, auto) __attribute__((always_inline)) {
    inner::void_set(set, first, islands, is_nonfinite);
    first += set.blocks();
  });
}

}  // namespace delassus
