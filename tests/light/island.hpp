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
      for (const Index i : items)
        for (int k = 0; k < pools[p]->sweeping->rows; ++k)
          order_.push_back(pools[p]->first_row + pools[p]->sweeping->rows * i + k);
    }
  }

  int row_count() const { return int(order_.size()); }
  const SolveControl& control() const { return control_; }
  const Array<Part>& parts() const { return parts_; }
  const Array<Index>& order() const { return order_; }  ///< the rows, as a sweep comes to them
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

  /// Flat impulses of all rows of the step, of which an island reads and writes its own.
  void save(Array<T>& to) const {
    to.resize(rows_.lambda.size());
    for (const Index r : order_) to[r] = rows_.lambda[r];
  }
  void load(const Array<T>& from) {
    save(last_);
    for (const Index r : order_) rows_.lambda[r] = from[r];
    tell_changes();
  }

  /// Σ w (y − z)·(z − x), z the present λ: whether a sweep from y to z turns back on the way from x.
  double curvature(const Array<T>& x, const Array<T>& y) const {
    double sum = 0;
    for (const Index r : order_)
      sum += double(W_.weight(r) * (y[r] - rows_.lambda[r]) * (rows_.lambda[r] - x[r]));
    return sum;
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
    for (const Index r : order_) to[at++] = std::sqrt(double(W_.weight(r))) * double(rows_.lambda[r]);
  }
  void scatter(const Array<double>& from) {
    save(last_);
    std::size_t at = 0;
    for (const Index r : order_) {
      const double root = std::sqrt(double(W_.weight(r))), x = from[at++];
      rows_.lambda[r] = root > 0 ? T(x / root) : T(0);
    }
    for (const Part& part : parts_) part.pool->sweeping->clamp(*part.pool, part.span);
    tell_changes();
  }

  /// u = d + W λ of the island's rows, into a flat array of all rows.
  void velocities(Array<T>& u) const {
    u.resize(rows_.lambda.size());
    for (const Part& part : parts_)
      for (Index n = 0; n < part.span.count; ++n)
        W_.velocity(part.number, part.span.items[n],
                    u.data() + part.pool->first_row + part.pool->sweeping->rows * part.span.items[n]);
  }

 private:
  /// Of all impulses that are no longer `last_`.
  void tell_changes() {
    if (!W_.keeps_velocities()) return;
    for (const Index r : order_) last_[r] = rows_.lambda[r] - last_[r];
    for (const Part& part : parts_)
      for (Index n = 0; n < part.span.count; ++n) {
        const Index item = part.pool->first_item + part.span.items[n];
        W_.changed(item, last_.data() + rows_.row[item]);
      }
    for (const Index r : order_) last_[r] = rows_.lambda[r] - last_[r];
  }

  Rows<T>& rows_;
  Delassus<T>& W_;
  SolveControl control_;
  Array<Part> parts_;
  Array<Index> order_, moved_;
  Array<T> last_;
  bool is_cut_ = false;
};

}  // namespace light
