/// An island whose bodies all answer alike, whatever their masses are.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/solvers/island.hpp>

#include <algorithm>
#include <cstddef>

namespace delassus::inner {

/// W′ = H A′⁻¹ Hᵀ, A′ = A of each body over a mass of its own, the least by which it answers to a constraint:
/// rows/tr(H A⁻¹ Hᵀ), rows in rad/s at the island's length. d is the same. Which velocities d + W λ can be
/// reached is no matter of masses, so W′ reaches those of W. Yet W′ has no numbers far apart where masses
/// are. It has λ of its own, zero at first; nothing of the island is changed. A row's compliance stays the
/// share of W_kk that it is.
template <class T>
class AlikeBodies {
 public:
  /// One a thread, which keeps its room: a step in which sweeps stall allocates nothing when warm.
  static AlikeBodies& of_this_thread() {
    static thread_local AlikeBodies room;
    return room;
  }

  [[gnu::always_inline]] AlikeBodies() {}
  AlikeBodies(const AlikeBodies&) = delete;
  AlikeBodies& operator=(const AlikeBodies&) = delete;
  [[gnu::always_inline]] ~AlikeBodies() {}

  /// False where W alone is known, or A couples bodies. `whole` stays where it is as long as `island` is
  /// used.
  bool take(const Island<T>& whole) {
    if (!count(whole)) return false;
    T* at = numbers_.data();
    double* y = answers_.data() + bodies_;
    for (std::size_t n = 0; n < pools_.size(); ++n) {
      PoolView<T>& pool = pools_[n];
      for (int s = 0; s < pool.sets; ++s) {
        SetBlocksView<T>& set = sets_[n * most_sets_ + std::size_t(s)] = pool.set[s];
        set.y = y + places_[std::size_t(s)];
        set.G = at;
        at += numbers_of(pool, set);
      }
      at = show(n, at);
    }
    return true;
  }
  [[gnu::always_inline]] Island<T> island(const Island<T>& whole) const {
    return whole.part(spans_.data(), int(spans_.size()));
  }

 private:
  [[gnu::always_inline]] static std::size_t numbers_of(const PoolView<T>& pool, const SetBlocksView<T>& set) {
    return std::size_t(pool.rows * set.width) * std::size_t(set.offset[pool.items]);
  }

  /// Room for all, and where the bodies of each set begin in it.
  [[gnu::always_inline]] bool count(const Island<T>& whole) {
    pools_.clear(), spans_.clear();
    most_sets_ = 0;
    for (const Span<T>& span : whole) {
      if (span.pool->form == FormOfW::functions) return false;
      most_sets_ = std::max(most_sets_, std::size_t(span.pool->sets));
      pools_.push_back(*span.pool);
      spans_.push_back(span);
    }
    sets_.resize(pools_.size() * most_sets_);
    places_.assign(most_sets_, 0);
    std::size_t numbers = 0;
    for (const Span<T>& span : whole) {
      const PoolView<T>& pool = *span.pool;
      numbers += std::size_t(pool.rows * (pool.rows + 2)) * std::size_t(pool.items);
      for (int s = 0; s < pool.sets; ++s) {
        const SetBlocksView<T>& set = pool.set[s];
        if (set.offset[pool.items] > 0 && !set.G) return false;
        numbers += numbers_of(pool, set);
        for (const Index i : span)
          for (Index e = set.offset[i]; e < set.offset[i + 1]; ++e)
            places_[std::size_t(s)] =
                std::max(places_[std::size_t(s)], Index(set.width) * (set.block[e] + 1));
      }
    }
    bodies_ = 0;
    for (Index& place : places_) {
      const Index room = place;
      place = bodies_, bodies_ += room;
    }
    answers_.assign(2 * std::size_t(bodies_), 0);
    numbers_.resize_for_overwrite(numbers);
    for (const Span<T>& span : whole)
      for (int s = 0; s < span.pool->sets; ++s) weigh(span, s, whole.length() * whole.length());
    return most_sets_ > 0;
  }

  /// The largest answer of each body of a set.
  [[gnu::always_inline]] void weigh(const Span<T>& span, int s, double square) {
    const SetBlocksView<T>& set = span.pool->set[s];
    const int R = span.pool->rows, width = set.width;
    for (const Index i : span)
      for (Index e = set.offset[i]; e < set.offset[i + 1]; ++e) {
        const T *H = set.H + std::ptrdiff_t(R * width) * e, *G = set.G + std::ptrdiff_t(R * width) * e;
        double trace = 0;
        for (int k = 0; k < R; ++k)
          for (int j = 0; j < width; ++j)
            trace += (span.pool->turn(k) ? square : 1) * double(H[k + R * j]) * double(G[j + width * k]);
        double& answer = answers_[std::size_t(places_[std::size_t(s)] + Index(width) * set.block[e])];
        answer = std::max(answer, trace / R);
      }
  }

  /// Pool n with W′; `room` is for its λ, W′_ii and compliance. Returns what is left of it.
  [[gnu::always_inline]] T* show(std::size_t n, T* room) {
    PoolView<T>& pool = pools_[n];
    SetBlocksView<T>* const sets = &sets_[n * most_sets_];
    const int R = pool.rows;
    const std::ptrdiff_t rows = std::ptrdiff_t(R) * pool.items;
    T *const lambda = room, *const yields = lambda + rows, *const diagonal = yields + rows;
    for (const Index i : spans_[n]) {
      T* const own = diagonal + std::ptrdiff_t(R * R) * i;
      for (int k = 0; k < R * R; ++k) own[k] = T(0);
      for (int s = 0; s < pool.sets; ++s) add_answers(pool, s, sets[s], i, own);
      for (int k = 0; k < R; ++k) {
        const std::ptrdiff_t row = std::ptrdiff_t(R) * i + k;
        const T whole = pool.own_block(i)[k * (R + 1)],
                rigid = (whole - pool.compliance[row]) / (1 + pool.relative_compliance[row]);
        lambda[row] = T(0);
        yields[row] = rigid > T(0) ? own[k * (R + 1)] * (whole / rigid - 1) : T(0);
        own[k * (R + 1)] += yields[row];
      }
    }
    pool.form = FormOfW::bodies;
    pool.lambda = lambda;
    pool.set = sets;
    pool.diagonal = pool.own_diagonal = diagonal;
    pool.on_diagonal = yields;
    spans_[n].pool = &pool;
    return diagonal + R * rows;
  }

  /// G of item i in W′, and what it adds to W′_ii.
  [[gnu::always_inline]] void add_answers(const PoolView<T>& pool, int s, const SetBlocksView<T>& set,
                                          Index i, T* own) {
    const int R = pool.rows, width = set.width;
    const SetBlocksView<T>& from = pool.set[s];
    for (Index e = set.offset[i]; e < set.offset[i + 1]; ++e) {
      const std::ptrdiff_t at = std::ptrdiff_t(R * width) * e;
      const double answer = answers_[std::size_t(places_[std::size_t(s)] + Index(width) * set.block[e])];
      T* const G = numbers_.data() + (set.G - numbers_.data()) + at;
      for (int k = 0; k < R * width; ++k) G[k] = answer > 0 ? T(double(from.G[at + k]) / answer) : T(0);
      for (int k = 0; k < R; ++k)
        for (int l = 0; l < R; ++l)
          for (int j = 0; j < width; ++j) own[k + R * l] += set.H[at + k + R * j] * G[j + width * l];
    }
  }

  Array<PoolView<T>> pools_;
  Array<Span<T>> spans_;
  Array<SetBlocksView<T>> sets_;  ///< of each pool
  Array<Index> places_;           ///< by set: where its bodies begin
  Array<double> answers_;  ///< by set and block: the largest answer, at the first of a body's numbers; behind
                           ///< them its velocity
  Array<T> numbers_;       ///< G of all sets, λ, W′_ii and compliance
  std::size_t most_sets_ = 0;
  Index bodies_ = 0;
};

}  // namespace delassus::inner
