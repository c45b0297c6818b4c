/// Whether what a solved motion brings together is worth solving the step once more.
#pragma once

#include <delassus/collision/collider.hpp>
#include <delassus/collision/inner/margins.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/constraints/contact/materials.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/slice.hpp>
#include <delassus/rows/anchor.hpp>
#include <delassus/rows/islands.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <algorithm>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

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

/// The number of the first block of each set, as `rows_about` wants it.
template <class World>
void find_first_blocks(const World& world, Index (&first)[World::set_count + 1]) {
  first[0] = 0;
  world.each([&](const auto& set, auto s) { first[s + 1] = first[s] + set.blocks(); });
}

/// Asks which impacts that were foreseen pushed, see `ForeseenImpacts`; none of a large island, in which a second solve for each grain that
/// falls on others would cost as much as the first.
void weigh_foreseen(auto& step, double share) {
  using World = std::remove_cvref_t<decltype(step.world())>;
  Index first[World::set_count + 1];
  find_first_blocks(step.world(), first);
  const auto is_asked = [&](const Anchor& a, const Anchor& b) {
    return rows_about(step.islands, step.arrays.all(), first, a, b) <= small_island;
  };
  step.contact_cache.weigh_foreseen(std::as_const(step).world(), step.h, share, is_asked, [&](const auto& f) { step.each_joint(f); });
}

/// Whether some contact law has an e.
template <class Laws>
inline constexpr bool some_bounce = false;
template <class... L>
inline constexpr bool some_bounce<Constraints<L...>> = ((ContactLaw<L> && (refinements_of<L> & refine::restitution) != 0) || ...);

/// e between two materials, of the law that takes them.
double restitution_between(auto& step, Index a, Index b) {
  double e = 0;
  each_contact_pool(step.laws(), [&](auto, auto& pool) {
    using Law = std::remove_cvref_t<decltype(pool.law)>;
    if constexpr ((refinements_of<Law> & refine::restitution) != 0) {
      if (!pool.law.takes(a, b)) return;
      auto parameters = pool.law.law.parameters();
      if (!step.material_pairs.empty())
        if (Material pair; step.material_pairs.between(a, b, pair)) pool.law.set_pair(parameters, pair);
      e = std::max(e, double(parameters.restitution));
    }
  });
  return e;
}

/// What bounces is left to the next step, which sees with what speed it meets: in this one it would have e times the speed that it
/// had before it was pushed. Not what would overlap by more than a contact may.
void leave_what_bounces(auto& step) {
  if constexpr (some_bounce<typename std::remove_cvref_t<decltype(step)>::Laws>) {
    auto& book = step.contact_cache;
    std::erase_if(book.missed, [&](const ContactPoint& p) {
      return book.overlap_of(p, step.h) <= margin_limit && restitution_between(step, book.material_of(p.a), book.material_of(p.b)) > 0;
    });
  }
}

/// A motion that was not found to the tolerance is not worth a second solve for what overlaps by less than the least margin.
bool is_worth_solving_again(auto& step) {
  using World = std::remove_cvref_t<decltype(step.world())>;
  const bool is_found = step.summary.status < Status::max_iterations;
  const auto& book = step.contact_cache;
  Index first[World::set_count + 1];
  find_first_blocks(step.world(), first);
  for (const ContactPoint& p : Slice<const ContactPoint>(book.missed)) {
    const bool is_large = rows_about(step.islands, step.arrays.all(), first, book.anchor_of(p.a), book.anchor_of(p.b)) > small_island;
    if (is_found && !is_large) return true;
    if (book.overlap_of(p, step.h) > (is_large ? shallow_share : margin_share)) return true;
  }
  return false;
}

}  // namespace delassus::inner
