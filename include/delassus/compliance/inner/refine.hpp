/// Refine: what an inexact W missed of the motion goes into d, and the rows are solved again.
#pragma once

#include <delassus/compliance/add_impulses.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/status.hpp>
#include <delassus/rows/rate.hpp>

#include <algorithm>

namespace delassus {

/// With Δv = A⁻¹ Hᵀ λ: d ← d₀ + H Δv − W̃ λ. True when that changed d by more than the operator allows, so
/// that λ is to be found again.
template <class Step>
bool correct_free_velocity(Step& step) {
  auto& world = step.world();
  auto& rows = step.rows;
  auto& W = step.W;
  using Rows = typename Step::Rows;
  using T = typename Rows::Scalar;
  world.each([&](auto& set, auto s) {
    for (auto& v : set.v_next) v.setZero();
    add_impulses(inner::inverse_of<s>(W, set, 1), s, ArraysOf(rows).all(), set.v_next, inner::part<s>(step.scratch));
  });
  if (W.renew(world, rows)) step.law_set.prepare(W, rows, step.h);
  double miss = 0;
  each_pool(rows, [&](auto p, auto& pool) {
    auto& missed = W.template missed<p>();
    for (Index i = 0; i < pool.items(); ++i) {
      const auto change = (inner::next_rate(pool, i, world) - inner::response<p>(W, rows, i) - missed[i]).eval();
      missed[i] += change;
      pool.d[i] += change;
      const T size = change.cwiseAbs().maxCoeff();
      if (!(double(size) <= miss)) miss = double(size);  // and what is not a number
    }
  });
  return W.goes_on(step.h * miss);
}

namespace inner {

/// What an operator that is no more than near W changes: its solves are repeated until they are near enough.
template <class Base>
struct RefinedStages : Base {
  static void free_motion(auto& step) {
    step.W.begin(step.compliance());
    Base::free_motion(step);
  }
  static void solve_islands(auto& step, auto& observer) {
    do Base::solve_islands(step, observer);
    while (correct_free_velocity(step));
    step.compliance().report = step.W.report();
    if (!step.W.is_settled()) step.summary.status = worse(step.summary.status, Status::max_iterations);
  }
};

}  // namespace inner
}  // namespace delassus
