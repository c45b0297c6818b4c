/// The other table of a law: its derivative, for Newton's method.
#pragma once

#include "law_pool.hpp"

#include <cmath>

namespace light {

/// W is w_i 1 here, w_i the mean of the item's diagonal.
template <class Law, class T>
struct NewtonLoops : LawLoops<Law, T> {
  using Loops = LawLoops<Law, T>;
  using Loops::load, Loops::store, Loops::typed, Loops::weight;
  using typename Loops::Block, typename Loops::Row, typename Loops::Typed;
  static constexpr int R = Law::rows;

  static Local<R, T> local(const Span<T>& s, const T* u, Index i) {
    return {weight(s, i) * Block::Identity(), load(u, i), load(s.lambda, i)};
  }
  static Block slope_of(Typed& self, Index i, Local<R, T>& c) {
    const auto& law = self.source->law;
    const auto& item = self.source->item(i);
    if constexpr (requires { law.tangent(item, c); })
      return law.tangent(item, c);
    else
      return law.tangent(item, c, self.memory[i]);
  }

  static void tangent(Pool<T>& pool, const Span<T>& s, const T* u, T* lambda, T* slope) {
    for (Index n = 0; n < s.count; ++n) {
      const Index i = s.items[n];
      Local<R, T> c = local(s, u, i);
      Eigen::Map<Block>(slope + std::size_t(R * R) * i) = slope_of(typed(pool), i, c);
      store(c.lambda, lambda, i);
    }
  }

  static void convex_tangent(Pool<T>& pool, const Span<T>& s, const T* u, const T* before, T* lambda,
                             T* slope) {
    const auto& source = *typed(pool).source;
    if constexpr (requires(Local<R, T> & c) { source.law.convex_tangent(source.item(0), c, T(0)); }) {
      for (Index n = 0; n < s.count; ++n) {
        const Index i = s.items[n];
        const Row last = load(before, i);
        Local<R, T> c = local(s, u, i);
        Eigen::Map<Block>(slope + std::size_t(R * R) * i) =
            source.law.convex_tangent(source.item(i), c, std::sqrt(last[1] * last[1] + last[2] * last[2]));
        store(c.lambda, lambda, i);
      }
    } else {
      tangent(pool, s, u, lambda, slope);
    }
  }

  static constexpr NewtonTable<T> table{&tangent, &convex_tangent};
};

/// A law without a tangent has no such table, and its islands are swept.
template <class Law, class T>
void differentiate(LawPool<Law, T>& pool) {
  if constexpr (Differentiable<Law>) pool.newton = &NewtonLoops<Law, T>::table;
}

}  // namespace light
