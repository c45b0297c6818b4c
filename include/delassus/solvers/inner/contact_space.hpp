/// The laws of an island as equations for its impulses alone, and the matrix of a Newton step for them.
#pragma once

#include <delassus/constraints/contact/cone.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/index.hpp>
#include <delassus/linear/dense_elimination.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/solvers/inner/rows_alone.hpp>
#include <delassus/solvers/island.hpp>

#include <cstddef>

namespace delassus::inner {

/// With u = d + W λ + ε w (λ − λ̂), ũ = u + μ |u_t| e_n in a contact and u elsewhere, w = tr(W_ii)/rows,
///
///   F_i(λ) = w λ − P_K(w λ − ũ),     K a cone, λ ≥ 0, or all impulses,
///   J_i = (1 − G) w + G Q (W + ε w)_i,  G = dP_K,  Q = dũ/du.
///
/// Where G = 0 (a contact that is open) F_i is w λ_i, so that only the rows of the others meet in the matrix.
/// Source: [AlartCurnier1991], [AcaryBremondHuber2018].
template <class T>
class ContactSpace {
  struct Item {
    Index first;  ///< its first row
    int rows;
    bool is_cone, is_active = false;
    double friction, w;
    Mat3 slope, turned;  ///< G, and G Q, of a cone; their first entries, of a row
  };

 public:
  /// Whether a law has such a form.
  static bool knows(const PoolView<T>& pool) {
    return pool.table->friction || (pool.rows == 1 && has_rows_alone(pool.table->kinds, 1));
  }

  /// False where a law has no such form.
  bool gather(Island<T>& island) {
    items_.clear();
    bool is_known = true;
    Index row = 0;
    for (const Span<T>& span : island)
      for (const Index i : span) {
        const PoolView<T>& pool = *span.pool;
        Item item{row, pool.rows, pool.table->friction != nullptr, false, 0, pool.weight(i), zero<Mat3>(), zero<Mat3>()};
        if (item.is_cone) item.friction = pool.table->friction(pool, i);
        if (pool.table->kinds[0] == RowKind::equality) item.friction = -1;
        is_known = is_known && knows(pool) && item.w > 0;
        items_.push_back(item);
        row += pool.rows;
      }
    if (!is_known) return false;
    const std::size_t n = std::size_t(row);
    for (auto* v : {&lambda, &centre_, &d_, &u_, &F_, &direction_, &trial_}) v->assign(n, 0);
    W_.assign(n * n, 0);
    read_W(island);
    return true;
  }

  /// λ̂ ← λ ← what the island has.
  void take(const Island<T>& island) {
    std::size_t at = 0;
    for (const Span<T>& span : island)
      for (const Index i : span)
        for (int k = 0; k < span.pool->rows; ++k) lambda[at++] = double(island.impulse(span, i)[k]);
    centre_ = lambda;
  }
  /// The island takes λ, each brought into its law's cone.
  void give(Island<T>& island) const {
    std::size_t at = 0;
    T next[most_rows];
    for (const Span<T>& span : island)
      for (const Index i : span) {
        for (int k = 0; k < span.pool->rows; ++k) next[k] = T(lambda[at++]);
        island.clamp(span, i, next);
        island.assign(span, i, next);
      }
  }

  /// |F| at λ + t δ.
  double evaluate(double epsilon, double t = 0) {
    for (std::size_t i = 0; i < lambda.size(); ++i)
      trial_[i] = t == 0 ? lambda[i] : lambda[i] + t * direction_[i];
    multiply(trial_);
    double sum = 0;
    for (Item& item : items_) sum += evaluate_item(item, epsilon);
    return std::sqrt(sum);
  }
  void advance(double t) {
    for (std::size_t i = 0; i < lambda.size(); ++i) lambda[i] += t * direction_[i];
  }

  /// J δ = −F of the last `evaluate`; false when J is singular.
  bool find_direction(double epsilon) {
    active_.clear();
    for (const Item& item : items_) {
      if (item.is_active)
        for (int k = 0; k < item.rows; ++k) active_.push_back(item.first + k);
      else
        for (int k = 0; k < item.rows; ++k) direction_[item.first + k] = -F_[item.first + k] / item.w;
    }
    matrix_.resize(Index(active_.size()));
    right_.assign(active_.size(), 0);
    Index row = 0;
    for (const Item& item : items_)
      if (item.is_active) {
        fill(item, row, epsilon);
        row += item.rows;
      }
    if (!matrix_.factor()) return false;
    matrix_.solve(right_);
    for (std::size_t k = 0; k < active_.size(); ++k) {
      if (!std::isfinite(right_[k])) return false;
      direction_[active_[k]] = right_[k];
    }
    return true;
  }

  Array<double> lambda;

 private:
  /// W column by column, from the answer to an impulse on each row; d with it.
  void read_W(Island<T>& island) {
    const std::size_t n = lambda.size();
    island.save(was_);
    island.clear();
    read(island, d_.data());
    double scale = 0;
    for (const double x : d_) scale = std::max(scale, std::abs(x));
    if (scale == 0) scale = 1;
    std::size_t column = 0;
    for (const Span<T>& span : island)
      for (const Index i : span) {
        const double size = 1e3 * scale / span.pool->weight(i);
        T impulse[most_rows] = {};
        for (int k = 0; k < span.pool->rows; ++k, ++column) {
          impulse[k] = T(size);
          island.assign(span, i, impulse);
          impulse[k] = T(0);
          read(island, &W_[column * n]);
          for (std::size_t row = 0; row < n; ++row)
            W_[column * n + row] = (W_[column * n + row] - d_[row]) / size;
        }
        island.assign(span, i, impulse);
      }
    island.load(was_);
  }
  static void read(const Island<T>& island, double* to) {
    T u[most_rows];
    for (const Span<T>& span : island)
      for (const Index i : span) {
        island.velocity(span, i, u);
        for (int k = 0; k < span.pool->rows; ++k) *to++ = double(u[k]);
      }
  }

  /// u ← d + W x.
  void multiply(const Array<double>& x) {
    const std::size_t n = x.size();
    u_ = d_;
    for (std::size_t j = 0; j < n; ++j) {
      if (x[j] == 0) continue;
      const double* const w = &W_[j * n];
      for (std::size_t i = 0; i < n; ++i) u_[i] += w[i] * x[j];
    }
  }

  /// Sets F, G and Q of one constraint; returns |F_i|².
  double evaluate_item(Item& item, double epsilon) {
    const Index at = item.first;
    for (int k = 0; k < item.rows; ++k) u_[at + k] += epsilon * item.w * (trial_[at + k] - centre_[at + k]);
    if (!item.is_cone) {
      const double x = item.w * trial_[at] - u_[at];
      item.is_active = item.friction < 0 || x > 0;
      F_[at] = item.is_active ? u_[at] : item.w * trial_[at];
      return F_[at] * F_[at];
    }
    const Vec<3> scaled(item.w * trial_[at], item.w * trial_[at + 1], item.w * trial_[at + 2]);
    const double slip = length(u_[at + 1], u_[at + 2]);
    const Vec<3> x(scaled[0] - u_[at] - item.friction * slip, scaled[1] - u_[at + 1], scaled[2] - u_[at + 2]);
    item.slope = project_on_cone_slope(x, item.friction);
    item.turned = item.slope;
    item.is_active = item.slope(0, 0) > 0;
    if (slip > 0)
      for (int row = 0; row < 3; ++row)
        for (int k = 1; k < 3; ++k)
          item.turned(row, k) += item.slope(row, 0) * item.friction * u_[at + k] / slip;
    const Vec<3> projected = project_on_cone(x, item.friction);
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
      F_[at + k] = scaled[k] - projected[k];
      sum += F_[at + k] * F_[at + k];
    }
    return sum;
  }

  /// The rows of one active constraint, on the active columns and, known, the others.
  void fill(const Item& item, Index row, double epsilon) {
    const std::size_t n = lambda.size();
    const auto turned = [&](int k, int l) { return item.is_cone ? item.turned(k, l) : 1.0; };
    const auto times = [&](int k, std::size_t column) {  // (G Q W)_k, column
      double sum = 0;
      for (int l = 0; l < item.rows; ++l) sum += turned(k, l) * W_[column * n + std::size_t(item.first + l)];
      return sum;
    };
    for (int k = 0; k < item.rows; ++k) {
      double right = -F_[item.first + k];
      for (const Item& other : items_)
        if (!other.is_active)
          for (int l = 0; l < other.rows; ++l)
            if (const double x = direction_[other.first + l]; x != 0)
              right -= times(k, std::size_t(other.first + l)) * x;
      right_[row + k] = right;
      for (Index j = 0; j < Index(active_.size()); ++j)
        matrix_.at(row + k, j) = times(k, std::size_t(active_[j]));
      for (int l = 0; l < item.rows; ++l)
        matrix_.at(row + k, row + l) +=
            item.w * ((k == l ? 1 : 0) - (item.is_cone ? item.slope(k, l) : 1.0) + epsilon * turned(k, l));
    }
  }

  Array<Item> items_;
  Array<double> centre_, d_, u_, F_, direction_, trial_, right_, W_;  ///< W column by column
  Array<Index> active_;
  DenseElimination matrix_;
  Array<T> was_;
};

}  // namespace delassus::inner
