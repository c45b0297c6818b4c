/// Warm start: every constraint begins with the impulse it had, scaled with the step.
#pragma once

#include <delassus/constraints/constraints.hpp>
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/core/slice.hpp>
#include <delassus/rows/islands.hpp>
#include <delassus/solvers/solve_report.hpp>
#include <delassus/step/contact_cache.hpp>

#include <algorithm>
#include <limits>

namespace delassus {

/// λ ← h/h_last · λ of the last step, by contact id or by item; contacts carry theirs as a world vector, brought back
/// into the cone of the new frame. h and h_last are this step and the last one, s.
template <class Laws, class Rows>
void warm_start(const Laws& laws, Rows& rows, ContactCache& book, double h, double last_h) {
  const double step_ratio = h / last_h;
  using T = typename Rows::Scalar;
  each_kept_pool(laws, [&](auto p, const auto& pool) {
    auto& lambda = rows.template pool<p>().lambda;
    for (Index i = 0; i < pool.count(); ++i) {
      const Index place = pool.slots.active()[i];
      if (pool.starts_cold[place]) set_all(lambda[i], T(0));
      else lambda[i] = (step_ratio * pool.impulse[place]).template cast<T>();
    }
  });
  each_contact_pool(laws, [&](auto p, const auto& pool) {
    auto& lambda = rows.template pool<p>().lambda;
    for (Index i = 0; i < pool.count(); ++i) {
      const auto& item = pool.item(i);
      const Vec3 impulse = step_ratio * book.remembered(item.result, h);
      if (is_zero(impulse)) continue;
      constexpr int along = inner::rows_along<Rows::template rows_of<p>>;
      const Vec3 own = item.frame * impulse;
      for (int k = 0; k < along; ++k) lambda[i][k] = T(own[k]);
      inner::clamp(pool.law, item, lambda[i], inner::NoMemory{});
    }
  });
}

/// Hands the impulses back: to the items of the pools, and to the contacts as world vectors.
template <class Laws, class Rows>
void keep_impulses(Laws& laws, const Rows& rows, ContactCache& book) {
  each_kept_pool(laws, [&](auto p, auto& pool) {
    const auto& lambda = rows.template pool<p>().lambda;
    for (Index i = 0; i < pool.count(); ++i) {
      const Index place = pool.slots.active()[i];
      pool.impulse[place] = lambda[i].template cast<double>();
      pool.starts_cold[place] = !is_finite(lambda[i]);
    }
  });
  each_contact_pool(laws, [&](auto p, const auto& pool) {
    const auto& lambda = rows.template pool<p>().lambda;
    for (Index i = 0; i < pool.count(); ++i) {
      const auto& item = pool.item(i);
      ContactResult& result = book.results[item.result];
      result.impulse = inner::world_impulse<Rows::template rows_of<p>>(item.frame, lambda[i]);
      result.starts_cold = !is_finite(lambda[i]);
      result.is_sliding = inner::who_refines<refine::is_sliding>(pool.law).is_sliding(inner::given<std::remove_cvref_t<decltype(pool.law)>>(item), lambda[i]);
    }
  });
}

namespace inner {

/// Impulses beyond every load are no start for the next step: those of constraints that contradict each other would grow
/// from step to step without bound. A chain of n constraints between bodies whose compliances span r = max w/min w carries
///
///   w_i |λ_i| ≤ n r max |d|,   w = tr(W_ii)/rows,
///
/// at most.
struct ImpulseLoads {
  double least = std::numeric_limits<double>::infinity(), most = 0, load = 0, response = 0;
  long count = 0;

  void add(double w, const auto& d, const auto& lambda) {
    least = std::min(least, w);
    most = std::max(most, w);
    load = std::max(load, double(norm(d)));
    response = std::max(response, w * double(norm(lambda)));
    ++count;
  }
  bool are_exceeded() const { return !(response * least <= double(count) * most * load); }
};

}  // namespace inner

/// An island whose solve ended far from its laws and with impulses beyond every load starts from zero.
template <class Laws, class Rows, class Operator, int pools>
void forget_lost_islands(Laws& laws, const Rows& rows, const Operator& W, ContactCache& book, const Islands<pools>& islands,
                         inner::Slice<const SolveReport> reports) {
  constexpr double far = 0.05;  // of the largest velocity of the island
  for (Index k = 0; k < islands.count(); ++k) {
    if (reports[k].status < Status::max_iterations || reports[k].measure.residual <= far) continue;
    inner::ImpulseLoads loads;
    each_pool(rows, [&](auto p, const auto& pool) {
      for (const Index i : islands.items(p, k))
        loads.add(double(trace(W.template diagonal<p>(i))) / Rows::template rows_of<p>, pool.d[i], pool.lambda[i]);
    });
    if (!loads.are_exceeded()) continue;
    each_kept_pool(laws, [&](auto p, auto& pool) {
      for (const Index i : islands.items(p, k)) pool.starts_cold[pool.slots.active()[i]] = 1;
    });
    each_contact_pool(laws, [&](auto p, const auto& pool) {
      for (const Index i : islands.items(p, k)) book.results[pool.item(i).result].starts_cold = true;
    });
  }
}

}  // namespace delassus
