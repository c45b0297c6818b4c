/// The laws of one island as smoothed rows.
#pragma once

#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/solvers/inner/rows_alone.hpp>
#include <delassus/solvers/inner/smoothed_rows.hpp>
#include <delassus/solvers/island_problem.hpp>

#include <algorithm>
#include <cmath>

namespace delassus::inner {

/// Fills `SmoothedRows` from an island, and hands λ over to it.
template <class Rows>
class SmoothedLaws {
  using T = typename Rows::Scalar;
  using Kind = SmoothedRows::Kind;

 public:
  /// Takes P W P/w over, column by column, and begins at x = 0; false where a law has no such form.
  template <class Problem>
  bool gather(Problem& problem) {
    bool is_known = true;
    problem.each(
        [&](auto p, Index) { is_known = is_known && (is_cone<Problem, p> || has_rows_alone<Problem, p>()); });
    if (!is_known) return false;
    rows_.resize(problem.row_count());
    for_all(problem, [&](auto p, Index i, Index row) {
      constexpr int R = Rows::template rows_of<p>;
      constexpr auto kinds = Problem::BookType::template kinds<p>();
      const auto W = problem.template local<p>(i).W;
      double sum = 0;
      for (int k = 0; k < R; ++k) {
        rows_.kind[row + k] = kinds[k] == RowKind::equality ? Kind::equality : Kind::lower;
        rows_.shape[row + k] = 1;
        if constexpr (is_cone<Problem, p>) {
          rows_.kind[row + k] = k == 0 ? Kind::cone : Kind::of_cone;
          if (k > 0) rows_.shape[row + k] = problem.book().template friction<p>(i);
        }
        sum += double(W(k, k)) * rows_.shape[row + k] * rows_.shape[row + k];
      }
      for (int k = 0; k < R; ++k) rows_.weight[row + k] = sum / R;
      problem.template assign<p>(i, Vec<R, T>::Zero());
    });
    return rows_.weight.minCoeff() > 0 && read_W(problem);
  }

  /// τ at which all rows are at once: the mean square of d.
  double start() const { return scale_ * scale_; }

  /// |r| at x; λ is handed over to the problem.
  template <class Problem>
  double evaluate(Problem& problem, double tau) {
    return evaluate_at(problem, rows_.x, tau);
  }
  template <class Problem>
  double evaluate_ahead(Problem& problem, double tau, double t) {
    return evaluate_at(problem, rows_.x + t * rows_.direction, tau);
  }
  bool find_direction(double shift) { return rows_.find_direction(shift); }
  void advance(double t) { rows_.x += t * rows_.direction; }

  template <class Problem>
  void keep(const Problem& problem) {
    best_.resize_like(problem.rows());
    problem.save(best_);
  }
  template <class Problem>
  void restore(Problem& problem) const {
    problem.load(best_);
  }

 private:
  template <class Problem, int p>
  static constexpr bool is_cone = Problem::BookType::template has_cone<p>();

  /// f(p, i, its first row) for every constraint.
  template <class Problem, class F>
  static void for_all(Problem& problem, F&& f) {
    Index row = 0;
    problem.each([&](auto p, Index i) {
      f(p, i, row);
      row += Rows::template rows_of<p>;
    });
  }

  template <class Problem>
  void read_velocities(Problem& problem, Eigen::VectorXd& u) const {
    for_all(problem, [&](auto p, Index i, Index row) {
      const auto velocity = problem.template local<p>(i).d;
      for (int k = 0; k < Rows::template rows_of<p>; ++k)
        u[row + k] = rows_.shape[row + k] * double(velocity[k]);
    });
  }

  /// The answer to an impulse on each row, so large that nothing is lost beside d.
  template <class Problem>
  bool read_W(Problem& problem) {
    Eigen::VectorXd free = rows_.x, moved = rows_.x;
    read_velocities(problem, free);
    scale_ = free.norm() / std::sqrt(double(rows_.size()));
    const double size = 1e3 * std::max(scale_, 1.0);
    for_all(problem, [&](auto p, Index i, Index row) {
      constexpr int R = Rows::template rows_of<p>;
      for (int k = 0; k < R; ++k) {
        Vec<R, T> impulse = Vec<R, T>::Zero();
        impulse[k] = T(size / rows_.weight[row]);
        problem.template assign<p>(i, impulse);
        read_velocities(problem, moved);
        rows_.W.col(row + k) = (moved - free) * (rows_.shape[row + k] / size);
      }
      problem.template assign<p>(i, Vec<R, T>::Zero());
    });
    return scale_ > 0 && rows_.W.allFinite();
  }

  template <class Problem>
  double evaluate_at(Problem& problem, const Eigen::VectorXd& x, double tau) {
    rows_.round(x, tau);
    for_all(problem, [&](auto p, Index i, Index row) {
      constexpr int R = Rows::template rows_of<p>;
      Vec<R, T> lambda;
      for (int k = 0; k < R; ++k) lambda[k] = T(rows_.lambda(row + k));
      problem.template assign<p>(i, lambda);
    });
    read_velocities(problem, rows_.residual);
    return rows_.finish_residual();
  }

  SmoothedRows rows_;
  Impulses<Rows> best_;
  double scale_ = 0;
};

}  // namespace delassus::inner
