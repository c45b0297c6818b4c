/// Refine: what an inexact W missed of the motion goes into d, and the rows are solved again.
#pragma once

#include <delassus/loop/stages/bias.hpp>
#include <delassus/loop/stages/correct.hpp>

#include <algorithm>
#include <cmath>

namespace delassus {

/// An operator that is no more than near W, and knows when it is near enough.
template <class W>
concept RefinedOperator = requires(W op, double miss) {
  { op.goes_on(miss) } -> std::same_as<bool>;
};

/// With Δv = A⁻¹ Hᵀ λ: d ← d₀ + H Δv − W̃ λ. True when that changed d by more than the operator allows, so
/// that λ is to be found again.
template <class World, class Work, class Scratch>
bool refine(World& world, Work& work, Scratch& scratch, double h) {
  auto& rows = work.rows;
  using T = typename Work::Rows::Scalar;
  world.each([&](auto& set, auto s) {
    for (auto& v : set.v_next) v.setZero();
    add_impulses<s>(inner::inverse_of<s>(work.W, set, 1), rows, set.v_next, std::get<s>(scratch));
  });
  if (work.W.renew(world, rows)) work.book.prepare(work.W, rows, h);
  double miss = 0;
  for_each_index<Work::Rows::pool_count>([&](auto p) {
    auto& pool = rows.template pool<p>();
    auto& missed = work.W.template missed<p>();
    for (Index i = 0; i < pool.items(); ++i) {
      const auto whole = inner::rate(
          pool, i, world, [](const auto& set) -> const auto& { return set.v_next; });
      const auto change = (whole - inner::response<p>(work.W, rows, i) - missed[i]).eval();
      missed[i] += change;
      pool.d[i] += change;
      const T size = change.cwiseAbs().maxCoeff();
      if (!(double(size) <= miss)) miss = double(size);  // and what is not a number
    }
  });
  return work.W.goes_on(h * miss);
}

}  // namespace delassus
