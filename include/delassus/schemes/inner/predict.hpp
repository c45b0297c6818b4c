/// Predict: the impulses of the last step act before the solve, which then finds what is to be changed.
#pragma once

#include <delassus/compliance/add_impulses.hpp>
#include <delassus/rows/impulses.hpp>
#include <delassus/rows/rate.hpp>

#include <tuple>

namespace delassus {

/// With λ₀ the warm start, p = A⁻¹ Hᵀ λ₀ and W̃ what the builder made of W:
///
///   v_free ← v_free + p,   d ← d + H p − W̃ λ₀,
///
/// so that the solve of d + W̃ λ finds the total λ, and W̃ has a say in the change λ − λ₀ only. `predicted` takes λ₀.
template <class World, class Rows, class Operator, class Scratch, class Kept>
void predict(World& world, Rows& rows, Operator& W, Scratch& scratch, Kept& predicted) {
  W.reset(rows);
  predicted.resize_like(rows);
  for_each_index<Rows::pool_count>([&](auto p) {
    for (Index i = 0; i < rows.template pool<p>().items(); ++i)
      inner::part<p>(predicted.pools)[i] = inner::response<p>(W, rows, i);
  });
  world.each([&](auto& set, auto s) {
    for (auto& v : set.v_next) set_zero(v);
    add_impulses(inner::inverse_of<s>(W, set, 1), s, ArraysOf(rows).all(), set.v_next, inner::part<s>(scratch));
    for (std::size_t b = 0; b < set.v_free.size(); ++b) set.v_free[b] += set.v_next[b];
  });
  each_pool(rows, [&](auto p, auto& pool) {
    for (Index i = 0; i < pool.items(); ++i) {
      auto& response = inner::part<p>(predicted.pools)[i];
      pool.d[i] += inner::next_rate(pool, i, world) - response;
      response = pool.lambda[i];
    }
  });
}

/// λ ← λ − λ₀ for the corrective motion; `predicted` keeps the total.
template <class Rows, class Kept>
void subtract_predicted(Rows& rows, Kept& predicted) {
  each_pool(rows, [&](auto p, auto& pool) {
    auto& kept = inner::part<p>(predicted.pools);
    pool.lambda.swap(kept);  // λ₀ in λ, the total kept
    for (Index i = 0; i < pool.items(); ++i) pool.lambda[i] = kept[i] - pool.lambda[i];
  });
}

namespace inner {

template <class P>
struct PredictedState {
  Impulses<typename P::Rows> predicted;
};

template <class Base>
struct PredictiveStages : Base {
  static void solve(auto& step) {
    predict(step.world(), step.rows, step.W, step.scratch, predicted(step));
    Base::solve(step);
  }
  static void correct(auto& step) {
    subtract_predicted(step.rows, predicted(step));
    Base::correct(step);
    predicted(step).give_to(step.rows);  // the total again
  }

 private:
  static auto& predicted(auto& step) { return step.template state<role::Scheme>().predicted; }
};

}  // namespace inner
}  // namespace delassus
