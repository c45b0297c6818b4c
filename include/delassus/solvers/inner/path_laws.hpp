/// The laws of one island as smoothed rows, with the Newton step and the tangent of their path in body space.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/solvers/inner/path_item.hpp>
#include <delassus/solvers/inner/path_systems.hpp>
#include <delassus/solvers/inner/rows_alone.hpp>
#include <delassus/solvers/island.hpp>

#include <algorithm>

namespace delassus::inner {

/// The constraints of an island with their unknowns x, r(x, τ) and the two directions that `PathNewton` goes
/// in.
template <class T, class System>
class PathLaws {
  using Constraint = NewtonConstraint<T>;

 public:
  using Rows = PathRows<double>;

  /// Begins at x = 0; false where a law has no such form, or Newton's method cannot act.
  bool gather(Island<T>& island) {
    bool is_known = true;
    for (const Span<T>& span : island)
      is_known = is_known && (span.pool->table->friction || has_rows_alone(island.kinds(span), span.pool->rows));
    if (!is_known || !system_.gather(island)) return false;
    count_ = island.row_count();
    rows.resize(std::size_t(count_), system_.slope.size());
    weight_.resize(system_.constraints().size());
    for (const Constraint& c : system_.constraints()) {
      const int R = c.rows;
      const PoolView<T>& pool = *c.span->pool;
      const T nothing[most_rows] = {};
      island.assign(*c.span, c.item, nothing);
      const T* own = pool.own_block(c.item);
      double& weight = weight_[std::size_t(c.number)];
      weight = 0;
      for (int k = 0; k < R; ++k) {
        double& shape = rows.shape[c.at + k];
        shape = is_cone(c) && k > 0 ? pool.table->friction(pool, c.item) : pool.turn(k) ? island.length() : 1;
        weight += double(own[k * (R + 1)]) * shape * shape / R;
      }
      is_known = is_known && weight > 0;
      for (int k = 0; k < R; ++k) rows.scale[c.at + k] = rows.shape[c.at + k] / weight;
    }
    double square = 0;
    T d[most_rows];
    for (const Constraint& c : system_.constraints()) {
      island.velocity(*c.span, c.item, d);
      for (int k = 0; k < c.rows; ++k) square += std::pow(rows.shape[c.at + k] * double(d[k]), 2);
    }
    scale_ = std::sqrt(square / count_);
    return is_known && scale_ > 0 && std::isfinite(scale_);
  }

  /// The root of the mean square of d: with τ its square, all rows are at once.
  double scale() const { return scale_; }
  int row_count() const { return count_; }
  /// The largest velocity that an impulse of the last evaluation stands for, a, or `scale`: what r is rounded
  /// by.
  double reach() const { return reach_; }
  bool is_negative() const { return system_.is_negative(); }

  /// |r| at x + t δ + s dx/ds; λ is handed over to the island.
  double evaluate(Island<T>& island, double tau, double t = 0, double s = 0) {
    reach_ = scale_;
    T numbers[most_rows];
    for (const Constraint& c : system_.constraints()) {
      for (Index k = c.at; k < c.at + c.rows; ++k) rows.ahead[k] = rows.x[k] + t * rows.direction[k] + s * rows.tangent[k];
      smooth(is_cone(c), c.rows, island.kinds(*c.span), &rows.ahead[c.at], tau, System::largest_ratio, &rows.a[c.at], &rows.z[c.at],
             &rows.E[c.slope], &rows.inverse[c.slope]);
      for (int k = 0; k < c.rows; ++k) {
        reach_ = std::max(reach_, std::abs(rows.a[c.at + k]));
        numbers[k] = T(rows.scale[c.at + k] * rows.a[c.at + k]);
      }
      island.assign(*c.span, c.item, numbers);
    }
    double square = 0;
    for (const Constraint& c : system_.constraints()) {
      island.velocity(*c.span, c.item, numbers);
      for (int k = 0; k < c.rows; ++k)
        rows.residual[c.at + k] = rows.z[c.at + k] - rows.shape[c.at + k] * double(numbers[k]);
      if (is_cone(c)) rows.residual[c.at] -= lag(c, tau);
      for (int k = 0; k < c.rows; ++k) square += rows.residual[c.at + k] * rows.residual[c.at + k];
    }
    return std::sqrt(square);
  }
  /// x ← where the last evaluation was.
  void advance() { rows.x = rows.ahead; }

  /// Factors −∂r/∂x where the last evaluation was; false when it is singular.
  bool factor(double tau) {
    for (const Constraint& c : system_.constraints()) {
      double* B = &rows.B[c.slope];
      for (int k = 0; k < c.rows * c.rows; ++k) B[k] = k % (c.rows + 1) == 0 ? 1 : 0;
      for (int k = 1; k < c.rows && is_cone(c); ++k) B[c.rows * k] = -rows.z[c.at + k] / slip(c, tau);
    }
    return system_.factor(rows, weight_);
  }

  /// (−∂r/∂x)⁻¹ r, by row.
  const Array<double>& find_direction() {
    rows.side = rows.residual;
    system_.solve(rows);
    return system_.lambda;
  }
  /// rate ← (−∂r/∂x)⁻¹ ∂r/∂log τ: what x does along the path as log τ grows.
  void find_rate(double tau) {
    // In the algebra ∂a/∂log τ = ∂z/∂log τ = τ (a + z)⁻¹, since a ∘ z = τ and a − z = x.
    for (const Constraint& c : system_.constraints()) {
      double* change = &rows.side[c.at];
      find_growth(c, tau, change);
      for (int k = 0; k < c.rows; ++k) rows.error[c.at + k] = rows.scale[c.at + k] * change[k];  // ∂λ/∂log τ
      if (!is_cone(c)) continue;
      const double s = slip(c, tau);
      for (int k = 1; k < c.rows; ++k) change[0] -= rows.z[c.at + k] / s * change[k];
      change[0] += 0.5 * std::sqrt(tau) * lag(c, tau) / s;
    }
    system_.answer(rows);
    for (int k = 0; k < count_; ++k) rows.side[k] -= rows.shape[k] * system_.velocity[k];
    system_.solve(rows);
    rows.rate = system_.lambda;
  }

  /// Σ f g of two directions, by row, in the lengths of the path: at each constraint beside |x_i|² + 4 τ.
  double product(double tau, const Array<double>& f, const Array<double>& g) const {
    double sum = 0;
    for (const Constraint& c : system_.constraints()) {
      double dot = 0, square = 0;
      for (Index k = c.at; k < c.at + c.rows; ++k) dot += f[k] * g[k], square += rows.x[k] * rows.x[k];
      sum += dot / (square + 4 * tau);
    }
    return sum / count_;
  }

  Rows rows;

 private:
  static bool is_cone(const Constraint& c) { return c.span->pool->table->friction; }

  /// √(|z_t|² + τ).
  double slip(const Constraint& c, double tau) const { return std::hypot(rows.z[c.at + 1], rows.z[c.at + 2], std::sqrt(tau)); }

  /// √(|z_t|² + τ) − √τ, without their difference.
  double lag(const Constraint& c, double tau) const {
    const double* z = &rows.z[c.at];
    return (z[1] * z[1] + z[2] * z[2]) / (slip(c, tau) + std::sqrt(tau));
  }

  /// out ← τ (a + z)⁻¹.
  void find_growth(const Constraint& c, double tau, double* out) const {
    for (int k = 0; k < c.rows; ++k) out[k] = rows.a[c.at + k] + rows.z[c.at + k];
    if (is_cone(c)) {
      const double length = std::hypot(out[1], out[2]), determinant = (out[0] - length) * (out[0] + length);
      for (int k = 0; k < c.rows; ++k) out[k] *= k == 0 ? tau / determinant : -tau / determinant;
    } else {
      const RowKind* kinds = Island<T>::kinds(*c.span);
      for (int k = 0; k < c.rows; ++k) out[k] = kinds[k] == RowKind::equality ? 0 : tau / out[k];
    }
  }

  System system_;
  Array<double> weight_;  ///< tr(P W_ii P)/rows, a constraint
  double scale_ = 0, reach_ = 0;
  int count_ = 0;
};

}  // namespace delassus::inner
