/// Whether what a solved motion brings together is worth solving the step once more.
#pragma once

#include <delassus/collision/inner/margins.hpp>
#include <delassus/core/index.hpp>
#include <delassus/rows/anchor.hpp>
#include <delassus/rows/islands.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <algorithm>
#include <limits>
#include <type_traits>

namespace delassus::inner {

/// Islands of more rows, those of sixteen joints, are not solved twice for an overlap of less than this share of a body's size:
/// in a pile that moves something is always about to meet. The next step pushes it apart.
inline constexpr Index small_island = 6 * 16;
inline constexpr double shallow_share = 5e-2;

/// The rows of the islands of both, as they were solved; `first_block[s]` is the number of the first block of set s.
template <class T>
Index rows_about(const Islands<T>& islands, AllRows<T> rows, const Index* first_block, const Anchor& a, const Anchor& b) {
  const Index of_a = islands.island_of(first_block[a.set] + a.block), of_b = islands.island_of(first_block[b.set] + b.block);
  Index count = 0;
  for (int p = 0; p < int(rows.size()); ++p) {
    if (of_a >= 0) count += Index(islands.items(p, of_a).size()) * rows[std::size_t(p)].rows;
    if (of_b >= 0 && of_b != of_a) count += Index(islands.items(p, of_b).size()) * rows[std::size_t(p)].rows;
  }
  return count;
}

/// A motion that was not found to the tolerance is not worth a second solve for what overlaps by less than the least margin.
bool is_worth_solving_again(auto& step) {
  using World = std::remove_cvref_t<decltype(step.world())>;
  const bool is_found = step.summary.status < Status::max_iterations;
  Index first[World::set_count + 1] = {};
  step.world().each([&](const auto& set, auto s) { first[s + 1] = first[s] + set.blocks(); });
  return step.contact_cache.is_any_missed_deeper(step.h, [&](const Anchor& a, const Anchor& b) {
    if (rows_about(step.islands, step.arrays.all(), first, a, b) > small_island) return shallow_share;
    return is_found ? std::numeric_limits<double>::lowest() : margin_share;
  });
}

}  // namespace delassus::inner
