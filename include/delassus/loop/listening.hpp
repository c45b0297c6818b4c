/// How a loop tells its listeners, and what it shows them.
#pragma once

#include <delassus/constraints/constraints.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/loop/checks.hpp>
#include <delassus/rows/local.hpp>
#include <delassus/solvers/island_problem.hpp>

#include <tuple>
#include <type_traits>
#include <utility>

namespace delassus::inner {

/// Every listener that hears this stage, in the order of the list.
template <class Stage, class Policies, class Loop>
void tell(Policies& policies, const Loop& loop) {
  const auto one = [&](auto& part) {
    using P = std::remove_reference_t<decltype(part)>;
    if constexpr (Plays<P, role::Listener>) {
      if constexpr (P::listens::template to<Stage>)
        if constexpr (hears<P, Loop, Stage>()) part.after(Stage{}, loop);
    }
  };
  std::apply([&](auto&... part) { (one(part), ...); }, policies);
}

/// f(observer): the first listener that wants every sweep, or one that wants nothing.
template <class... Policies, class F>
void with_observer(std::tuple<Policies...>& policies, F&& f) {
  if constexpr ((observes_sweeps<Policies> || ...)) {
    bool is_done = false;
    const auto one = [&](auto& part) {
      if constexpr (observes_sweeps<std::remove_reference_t<decltype(part)>>)
        if (!std::exchange(is_done, true)) f(part);
    };
    std::apply([&](auto&... part) { (one(part), ...); }, policies);
  } else {
    NoObserver nobody;
    f(nobody);
  }
}

/// f(pool, item, λ, |F_i|, h) for every constraint, in the order of the sweep.
template <class Work, class Laws, class F>
void each_constraint(const Work& work, const Laws& laws, double h, F&& f) {
  using Rows = typename Work::Rows;
  using T = typename Rows::Scalar;
  auto book = work.book;
  book.attach(laws);  // the loop may be a copy
  for_each_index<Rows::pool_count>([&](auto p) {
    const auto& pool = work.rows.template pool<p>();
    constexpr int R = Rows::template rows_of<p>;
    for (Index i = 0; i < pool.items(); ++i) {
      const Local<R, T> c{work.W.template diagonal<p>(i), work.W.template residual<p>(work.rows, i), pool.lambda[i]};
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
