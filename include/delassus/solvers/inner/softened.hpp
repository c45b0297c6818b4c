/// An island whose rows yield by a share of their own W.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/solvers/island.hpp>

#include <cstddef>

namespace delassus::inner {

/// The island on W + ε diag(w), w the weights of the rows, begun from λ = 0, with the time of the whole; nobody hears of its
/// sweeps. Where rows contradict each other λ is bounded on it, by |d|/ε w, not ten times
/// what stops one of them, and the velocities differ by ε/(1 + ε) of theirs, not a tenth, from those that miss the rows
/// least. Less ε would trade the first for the second, and take more sweeps, √(1/ε) with momentum.
template <class T>
class Softened {
  static constexpr T share = T(0.105);

 public:
  explicit Softened(Island<T>& whole) : whole_(whole), island_(whole) {
    std::size_t numbers = 0;
    for (const Span<T>& span : whole) {
      spans_.push_back(span);
      pools_.push_back(*span.pool);
      numbers += squares(*span.pool);
    }
    diagonal_.resize(numbers);
    T* to = diagonal_.data();
    for (std::size_t k = 0; k < pools_.size(); ++k) {
      PoolView<T>& pool = pools_[k];
      spans_[k].pool = &pool;
      const Span<T>& span = spans_[k];
      for (const Index i : span) lift(pool, i, to + std::ptrdiff_t(pool.rows * pool.rows) * i);
      pool.diagonal = to;
      to += squares(pool);
      pool.table->prepare(span, whole.h());
    }
    island_ = whole.part(spans_.data(), int(spans_.size()));
    island_.clear();
  }
  Softened(const Softened&) = delete;
  Softened& operator=(const Softened&) = delete;

  Island<T>& island() { return island_; }

  /// The laws' memories as they were.
  void restore() {
    for (const Span<T>& span : whole_) span.pool->table->prepare(span, whole_.h());
  }

 private:
  static std::size_t squares(const PoolView<T>& pool) { return std::size_t(pool.rows * pool.rows) * std::size_t(pool.items); }
  static void lift(const PoolView<T>& pool, Index i, T* to) {
    const T* own = pool.own_block(i);
    double w[most_rows];
    pool.weights(i, w);
    for (int k = 0; k < pool.rows * pool.rows; ++k) to[k] = own[k] + (k % (pool.rows + 1) == 0 ? share * T(w[k % pool.rows]) : T(0));
  }

  Island<T>& whole_;
  Island<T> island_;
  Array<PoolView<T>> pools_;
  Array<Span<T>> spans_;
  Array<T> diagonal_;
};

}  // namespace delassus::inner
