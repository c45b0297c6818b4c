/// Warm start: every constraint begins with the impulse it had, scaled with the step.
#pragma once

#include <delassus/loop/stages/detect.hpp>

namespace delassus {

/// λ ← h/h_last · λ of the last step, by contact id or by item; contacts carry theirs as a world vector, brought back
/// into the cone of the new frame.
template <class Laws, class Rows>
void warm_start(const Laws& laws, Rows& rows, ContactBook& book, double step_ratio) {
  using T = typename Rows::Scalar;
  for_each_index<Laws::pool_count>([&](auto p) {
    const auto& pool = laws.template pool<p>();
    auto& lambda = rows.template pool<p>().lambda;
    for (Index i = 0; i < pool.count(); ++i) {
      if constexpr (requires { pool.impulse; }) {
        lambda[i] = (step_ratio * pool.impulse[pool.slots.active()[i]]).template cast<T>();
      } else {
        const auto& item = pool.item(i);
        const Vec3 impulse = step_ratio * book.remembered(item.record, 0.02);
        if (impulse.isZero(0)) continue;
        constexpr int R = Rows::template rows_of<p>;
        lambda[i] = (item.frame.template topRows<R>() * impulse).template cast<T>();
        if constexpr (requires { pool.law.clamp(item, lambda[i]); }) pool.law.clamp(item, lambda[i]);
      }
    }
  });
}

/// Hands the impulses back: to the items of the pools, and to the contacts as world vectors.
template <class Laws, class Rows>
void keep_impulses(Laws& laws, const Rows& rows, ContactBook& book) {
  for_each_index<Laws::pool_count>([&](auto p) {
    auto& pool = laws.template pool<p>();
    const auto& lambda = rows.template pool<p>().lambda;
    for (Index i = 0; i < pool.count(); ++i) {
      constexpr int R = Rows::template rows_of<p>;
      if constexpr (requires { pool.impulse; }) {
        pool.impulse[pool.slots.active()[i]] = lambda[i].template cast<double>();
      } else {
        const auto& item = pool.item(i);
        book.results[item.result].impulse =
            item.frame.template topRows<R>().transpose() * lambda[i].template cast<double>();
        if constexpr (requires { pool.law.is_sliding(item, lambda[i]); })
          book.results[item.result].is_sliding = pool.law.is_sliding(item, lambda[i]);
      }
    }
  });
  book.remember();
}

}  // namespace delassus
