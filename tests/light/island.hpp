/// One island as a solver meets it: spans of pools, a table each, and flat impulses.
#pragma once

#include "delassus_operator.hpp"
#include "islands.hpp"
#include "solve_control.hpp"

#include <algorithm>
#include <cmath>

namespace light {

template <class T>
class Island {
 public:
  struct Part {
    Pool<T>* pool;
    int number;  ///< of the pool
    Span<T> span;
  };

  Island(std::span<Pool<T>* const> pools, Rows<T>& rows, Delassus<T>& W, const Islands<T>& islands,
         Index island, const SolveControl& control = {})
      : rows_(rows), W_(W), control_(control) {
    for (int p = 0; p < int(pools.size()); ++p) {
      const auto items = islands.items(p, island);
      if (items.empty()) continue;
      parts_.push_back({pools[p], p, W.span(p, items.data(), Index(items.size()))});
      row_count_ += pools[p]->sweeping->rows * int(items.size());
    }
  }

  int row_count() const { return row_count_; }
  const SolveControl& control() const { return control_; }
  const Array<Part>& parts() const { return parts_; }
  Rows<T>& rows() { return rows_; }
  Delassus<T>& compliance() { return W_; }

  void prepare(double h) {
    for (const Part& part : parts_) part.pool->sweeping->prepare(*part.pool, part.span, h);
  }

  /// Every item meets its law in turn; Σ w |Δλ|². A late one is cut between two spans if it may be.
  T sweep(T relaxation = 1, bool may_be_cut = false) {
    T energy = 0;
    for (const Part& part : parts_) {
      W_.sum_others(part.number, part.span);
      Span<T> piece = part.span;
      for (Index left = part.span.count; left > 0; left -= piece.count, piece.items += piece.count) {
        if (may_be_cut && control_.is_late()) return is_cut_ = true, energy;
        piece.count = std::min(left, control_.longest_span());
        energy += part.pool->sweeping->sweep(*part.pool, piece, relaxation);
      }
    }
    return energy;
  }
  bool is_cut() const { return is_cut_; }

  Measure measure() {
    MeasureSums sums;
    for (const Part& part : parts_) {
      W_.sum_others(part.number, part.span);
      part.pool->sweeping->measure(*part.pool, part.span, rows_.d.data() + part.pool->first_row, sums);
    }
    return sums.finish(double(std::numeric_limits<T>::epsilon()));
  }

  /// f(part, item of the pool, its first row) in the order of the sweep.
  template <class F>
  void each(const F& f) const {
    for (const Part& part : parts_)
      for (Index n = 0; n < part.span.count; ++n) {
        const Index i = part.span.items[n];
        f(part, i, part.pool->first_row + part.pool->sweeping->rows * i);
      }
  }

  /// Flat impulses of all rows of the step, of which an island reads and writes its own.
  void save(Array<T>& to) const {
    to.resize(rows_.lambda.size());
    each([&](const Part& part, Index, Index row) {
      for (int k = 0; k < part.pool->sweeping->rows; ++k) to[row + k] = rows_.lambda[row + k];
    });
  }
  void load(const Array<T>& from) {
    each([&](const Part& part, Index i, Index row) { assign(part, i, from.data() + row, row); });
  }

  /// Σ w (y − z)·(z − x), z the present λ: whether a sweep from y to z turns back on the way from x.
  double curvature(const Array<T>& x, const Array<T>& y) const {
    T sum = 0;
    each([&](const Part& part, Index i, Index row) {
      T along = 0;
      for (int k = 0; k < part.pool->sweeping->rows; ++k) {
        const T z = rows_.lambda[row + k];
        along += (y[row + k] - z) * (z - x[row + k]);
      }
      sum += weight(part, i) * along;
    });
    return double(sum);
  }

  /// λ ← λ + β (λ − before), each that has moved brought back into its law's cone; `before` takes the λ that
  /// was.
  void extrapolate(Array<T>& before, double beta) {
    save(last_);
    for (const Part& part : parts_) {
      const int R = part.pool->sweeping->rows;
      moved_.clear();
      for (Index n = 0; n < part.span.count; ++n) {
        const Index i = part.span.items[n], row = part.pool->first_row + R * i;
        T *const x = rows_.lambda.data() + row, *const from = before.data() + row;
        if (std::equal(x, x + R, from)) continue;  // an open contact, most of all
        moved_.push_back(i);
        for (int k = 0; k < R; ++k) x[k] += T(beta) * (x[k] - from[k]);
      }
      Span<T> span = part.span;
      span.items = moved_.data();
      span.count = Index(moved_.size());
      part.pool->sweeping->clamp(*part.pool, span);
    }
    tell_changes();
    before.swap(last_);
  }

  /// √w λ of all rows in order, so that their products are energies; and the way back, into the laws' cones.
  void gather(Array<double>& to) const {
    std::size_t at = 0;
    each([&](const Part& part, Index i, Index row) {
      const double root = root_of_weight(part, i);
      for (int k = 0; k < part.pool->sweeping->rows; ++k) to[at++] = root * double(rows_.lambda[row + k]);
    });
  }
  void scatter(const Array<double>& from) {
    save(last_);
    std::size_t at = 0;
    each([&](const Part& part, Index i, Index row) {
      const double root = root_of_weight(part, i);
      for (int k = 0; k < part.pool->sweeping->rows; ++k, ++at)
        rows_.lambda[row + k] = root > 0 ? T(from[at] / root) : T(0);
    });
    for (const Part& part : parts_) part.pool->sweeping->clamp(*part.pool, part.span);
    tell_changes();
  }

  /// u = d + W λ of the island's rows, into a flat array of all rows.
  void velocities(Array<T>& u) const {
    u.resize(rows_.lambda.size());
    each([&](const Part& part, Index i, Index row) {
      const int R = part.pool->sweeping->rows;
      const T* const own = W_.diagonal(part.number, i);
      W_.free(part.number, i, u.data() + row);
      for (int c = 0; c < R; ++c)
        for (int k = 0; k < R; ++k) u[row + k] += own[k + R * c] * rows_.lambda[row + c];
    });
  }
  double root_of_weight(const Part& part, Index i) const { return std::sqrt(double(weight(part, i))); }
  T weight(const Part& part, Index i) const {
    const int R = part.pool->sweeping->rows;
    T trace = 0;
    for (int k = 0; k < R; ++k) trace += W_.diagonal(part.number, i)[k * (R + 1)];
    return trace / T(R);
  }

 private:
  void assign(const Part& part, Index i, const T* next, Index row) {
    T change[6];
    for (int k = 0; k < part.pool->sweeping->rows; ++k) {
      change[k] = next[k] - rows_.lambda[row + k];
      rows_.lambda[row + k] = next[k];
    }
    W_.changed(part.pool->first_item + i, change);
  }
  void tell_changes() {
    each([&](const Part& part, Index i, Index row) {
      T change[6];
      for (int k = 0; k < part.pool->sweeping->rows; ++k) change[k] = rows_.lambda[row + k] - last_[row + k];
      W_.changed(part.pool->first_item + i, change);
    });
  }

  Rows<T>& rows_;
  Delassus<T>& W_;
  SolveControl control_;
  Array<Part> parts_;
  Array<T> last_;
  Array<Index> moved_;
  int row_count_ = 0;
  bool is_cut_ = false;
};

}  // namespace light
