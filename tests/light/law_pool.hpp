/// What makes a law a table: its functions of one item, inlined in loops over spans.
#pragma once

#include "delassus_operator.hpp"

#include <delassus/compliance/inner/block_row.hpp>
#include <delassus/constraints/law.hpp>
#include <delassus/constraints/pool.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/solvers/inner/share_of_measure.hpp>

namespace light {

/// The typed part of a pool: the law's items, and what it keeps of each between sweeps.
template <class Law, class T>
struct LawPool : Pool<T> {
  const delassus::Pool<Law>* source;
  Array<inner::memory_of_t<Law, T>> memory;

  explicit LawPool(const delassus::Pool<Law>& constraints);
};

/// The loops of one law. It is a law of the library, unchanged.
template <class Law, class T>
struct LawLoops {
  static constexpr int R = Law::rows;
  using Typed = LawPool<Law, T>;
  using Row = Vec<R, T>;
  using Block = Mat<R, R, T>;

  /// λ = 0 is right while the first row opens.
  static constexpr bool opens = [] {
    constexpr auto kinds = row_kinds<Law>();
    return kinds.size() == 3 && kinds[0] == RowKind::lower && kinds[R - 1] == RowKind::friction;
  }();
  static void clamp_one(Typed& self, Index i, Row& x) {
    const auto& law = self.source->law;
    if constexpr (requires { law.clamp(self.source->item(i), x, self.memory[i]); })
      law.clamp(self.source->item(i), x, self.memory[i]);
    else if constexpr (requires { law.clamp(self.source->item(i), x); })
      law.clamp(self.source->item(i), x);
  }

  static Typed& typed(Pool<T>& pool) { return static_cast<Typed&>(pool); }
  // Loops and not Eigen's maps, which are types of their own for each R.
  static Row load(const T* x, Index i) {
    Row row;
    for (int k = 0; k < R; ++k) row.data()[k] = x[std::size_t(R) * i + k];
    return row;
  }
  static Block block_at(const T* x, Index i) {
    Block block;
    for (int k = 0; k < R * R; ++k) block.data()[k] = x[std::size_t(R * R) * i + k];
    return block;
  }
  static void store(const Row& from, T* x, Index i) {
    for (int k = 0; k < R; ++k) x[std::size_t(R) * i + k] = from.data()[k];
  }

  static void linearize(const Pool<T>& pool, const WorldView<T>& world, Rows<T>& rows) {
    const auto& source = *static_cast<const Typed&>(pool).source;
    for (Index i = 0; i < pool.items; ++i) {
      rows.open(R);
      source.law.linearize(source.item(i), world, RowWriter<R, T>(world, rows));
      rows.close();
    }
  }

  static void prepare(Pool<T>& pool, const Span<T>& s, double h) {
    Typed& self = typed(pool);
    self.memory.resize(std::size_t(pool.items));
    const Law& law = self.source->law;
    for (Index n = 0; n < s.count; ++n) {
      const Index i = s.items[n];
      const Block own = block_at(s.diagonal, i);
      auto& memory = self.memory[i];
      if constexpr (requires { law.prepare(self.source->item(i), own, h, memory); })
        law.prepare(self.source->item(i), own, h, memory);
      else
        inner::prepare(law, own, memory);
    }
  }

  /// d_i + Σ_{j ≠ i} W_ij λ_j.
  [[gnu::always_inline]] static Row free_velocity(const Pool<T>& pool, const Span<T>& s, Index i) {
    if (s.velocities && !s.velocities->has_blocks(pool.first_item + i)) [[unlikely]] {
      Row u;
      s.velocities->template free_through_bodies<R>(pool.first_item + i, s.diagonal + std::size_t(R * R) * i,
                                                    u.data());
      return u;
    }
    Row u = load(s.base, i);
    add_row(u, s, s.start[i], s.start[i + 1]);
    return u;
  }
  [[gnu::always_inline]] static void add_row(Row& u, const Span<T>& s, Index first, Index end) {
    const T* w = s.block + std::size_t(R * R) * first;
    if constexpr (is_of_contacts) {
      inner::add_row(u, end - first, reinterpret_cast<const Mat3*>(w), s.column + first,
                     reinterpret_cast<const Vec3*>(s.lambda));
    } else {
      for (Index e = first; e < end; ++e) {
        const T* const x = s.lambda + std::size_t(R) * s.column[e];
        for (int c = 0; c < R; ++c, w += R)
          for (int k = 0; k < R; ++k) u.data()[k] += w[k] * x[c];
      }
    }
  }
  /// Of three rows in double there is a kernel of its own.
  static constexpr bool is_of_contacts = R == 3 && std::is_same_v<T, double>;

  [[gnu::always_inline]] static bool stays_open(const Span<T>& s, Index i, const Row& lambda) {
    if constexpr (opens && is_of_contacts) {
      if (s.velocities || !is_zero(lambda)) return false;
      const Index first = s.start[i];
      const auto* w = reinterpret_cast<const Mat3*>(s.block) + first;
      return s.base[R * std::size_t(i)] + inner::first_of_row(s.start[i + 1] - first, w, s.column + first,
                                                              reinterpret_cast<const Vec3*>(s.lambda)) >=
             T(0);
    }
    return false;
  }

  /// What meets the law while the others stand still.
  [[gnu::always_inline]] static Row answer(Typed& self, Index i, const Row& free, const Row& lambda,
                                           const T* diagonal) {
    const auto& law = self.source->law;
    const auto& item = self.source->item(i);
    auto& memory = self.memory[i];
    if constexpr (requires { law.solve_local(item, free, memory); }) {
      return law.solve_local(item, free, memory);
    } else {
      Local<R, T> c{block_at(diagonal, i), free, lambda};
      c.d += c.W * lambda;
      inner::project(law, item, c, memory);
      return c.lambda;
    }
  }

  /// The inner loop: law and W in one piece, no call but of what is met through the bodies.
  static T sweep(Pool<T>& pool, const Span<T>& s, T relaxation) {
    Typed& self = typed(pool);
    T energy = 0;
    for (const Index *at = s.items, *end = at + s.count; at != end; ++at) {
      const Index i = *at;
      const Row lambda = load(s.lambda, i);
      if (stays_open(s, i, lambda)) continue;
      Row next = answer(self, i, free_velocity(pool, s, i), lambda, s.diagonal);
      if (relaxation != T(1)) {
        next = lambda + relaxation * (next - lambda);
        clamp_one(self, i, next);
      }
      T change[R], square = 0;
      for (int k = 0; k < R; ++k) {
        change[k] = next.data()[k] - lambda.data()[k];
        square += change[k] * change[k];
      }
      store(next, s.lambda, i);
      if (s.velocities) s.velocities->template changed<R>(pool.first_item + i, change);
      energy += weight(s, i) * square;
    }
    return energy;
  }
  static T weight(const Span<T>& s, Index i) {
    T trace = 0;
    for (int k = 0; k < R; ++k) trace += s.diagonal[std::size_t(R * R) * i + k * (R + 1)];
    return trace * (T(1) / T(R));
  }

  static Row map_of(Typed& self, Index i, const Local<R, T>& c, T scale) {
    const auto& law = self.source->law;
    const auto& item = self.source->item(i);
    if constexpr (requires { law.natural_map(item, c.lambda, c.d, scale); }) {
      return law.natural_map(item, c.lambda, c.d, scale);
    } else {
      Local<R, T> trial = c;
      auto memory = self.memory[i];
      inner::project(law, item, trial, memory);
      const Row change = c.lambda - trial.lambda;
      return (scale * T(R) / c.W.trace()) * (c.W * change);
    }
  }

  static void measure(Pool<T>& pool, const Span<T>& s, const T* d, MeasureSums& sums) {
    const Asked asked{typed(pool)};
    MeasureSums here = sums;
    for (Index n = 0; n < s.count; ++n) {
      const Index i = s.items[n];
      Local<R, T> c{block_at(s.diagonal, i), free_velocity(pool, s, i), load(s.lambda, i)};
      c.d += c.W * c.lambda;
      inner::add_share<0>(asked, i, c, load(d, i), here);
    }
    sums = here;
  }
  /// The law as the library's measure asks it.
  struct Asked {
    Typed& self;
    template <int>
    Row natural_map(Index i, const Local<R, T>& c, T scale) const {
      return map_of(self, i, c, scale);
    }
    template <int, class L = Law>
    requires requires(const L& law, const typename L::Item& item, const Row& x) {
      law.natural_squares(item, x, x, T(1));
    }
    Vec<2, T> natural_squares(Index i, const Local<R, T>& c, T scale) const {
      return self.source->law.natural_squares(self.source->item(i), c.lambda, c.d, scale);
    }
  };

  static void clamp(Pool<T>& pool, const Span<T>& s) {
    for (Index n = 0; n < s.count; ++n) {
      Row lambda = load(s.lambda, s.items[n]);
      clamp_one(typed(pool), s.items[n], lambda);
      store(lambda, s.lambda, s.items[n]);
    }
  }

  static void natural_map(Pool<T>& pool, const Span<T>& s, const T* u, T* out) {
    for (Index n = 0; n < s.count; ++n) {
      const Index i = s.items[n];
      const Local<R, T> c{block_at(s.diagonal, i), load(u, i), load(s.lambda, i)};
      store(map_of(typed(pool), i, c, weight(s, i)), out, i);
    }
  }

  static constexpr SweepTable<T> table{R,      &linearize,   &prepare,          &sweep,          &measure,
                                       &clamp, &natural_map, &sum_others<R, T>, &add_block<R, T>};
};

template <class Law, class T>
LawPool<Law, T>::LawPool(const delassus::Pool<Law>& constraints)
    : Pool<T>(LawLoops<Law, T>::table), source(&constraints) {
  this->items = constraints.count();
}

}  // namespace light
