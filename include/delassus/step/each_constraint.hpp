/// The constraints of a step, one by one.
#pragma once

#include <delassus/constraints/constraints.hpp>
#include <delassus/rows/local.hpp>
#include <delassus/rows/row_system.hpp>

#include <type_traits>

namespace delassus::inner {

/// f(pool, item, λ, |F_i|, h) for every constraint, in the order of the sweep.
template <class Step, class Laws, class F>
void each_constraint(const Step& step, const Laws& laws, double h, F&& f) {
  using Rows = typename Step::Rows;
  using T = typename Rows::Scalar;
  auto book = step.law_set;
  book.attach(laws);  // the loop may be a copy
  for_each_index<Rows::pool_count>([&](auto p) {
    const auto& pool = step.rows.template pool<p>();
    constexpr int R = Rows::template rows_of<p>;
    for (Index i = 0; i < pool.items(); ++i) {
      const Local<R, T> c{step.W.template diagonal<p>(i), step.W.template residual<p>(step.rows, i), pool.lambda[i]};
      f(int(p), i, pool.lambda[i], double(book.template natural_map<p>(i, c, c.W.trace() / T(R)).norm()), h);
    }
  });
}

/// f(a, b) for the anchors of every constraint that has two.
template <class Laws, class F>
void each_joint(const Laws& laws, F&& f) {
  for_each_index<Laws::pool_count>([&](auto p) {
    const auto& pool = laws.template pool<p>();
    for (Index i = 0; i < pool.count(); ++i) {
      const auto& item = pool.item(i);
      if constexpr (HasEnds<std::remove_cvref_t<decltype(item)>>) f(item.a, item.b);
    }
  });
}

}  // namespace delassus::inner
