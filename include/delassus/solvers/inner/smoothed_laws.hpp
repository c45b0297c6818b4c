/// The laws of one island with their corners rounded off, and the matrix of a Newton step for them.
#pragma once

#include <delassus/linear/dense_lu.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/solvers/island_problem.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace delassus::inner {

/// Every constraint has an unknown x in units of velocity, which holds both its sides. With P = diag(1, μ, μ)
/// in a contact, 1 elsewhere, and w = tr(P W_ii P)/rows,
///
///   λ = P a/w,   a = p(x),   z = p(−x),   a − z = x,   a ∘ z = τ e,
///
/// where p is ½ (ξ + √(ξ² + 4τ)) on the eigenvalues ξ = x_n ∓ |x_t| that x has in the algebra of the cone, on
/// x itself for a row φ ≥ 0, and a = x, z = 0 for an equality. For τ → 0, p is the projection on the cone.
/// Solved is
///
///   r(x) = z − s e_n − P (d + W λ) = 0,   s = √(|z_t|² + τ) − √τ, De Saxcé's term,
///   −∂r/∂x = B (1 − D) + P W P D/w,   D = ∂p/∂x,   B = 1 − e_n (∂s/∂z)ᵀ.
template <class Rows>
class SmoothedLaws {
  using T = typename Rows::Scalar;

 public:
  /// Takes P W P/w over, column by column, and begins at x = 0; false where a law has no such form.
  template <class Problem>
  bool gather(Problem& problem) {
    bool is_known = true;
    problem.each(
        [&](auto p, Index) { is_known = is_known && (is_cone<Problem, p> || has_rows_alone<Problem, p>()); });
    if (!is_known) return false;
    const int n = problem.row_count();
    for (auto* v : {&x_, &direction_, &a_, &z_, &shape_, &weight_, &residual_}) v->setZero(n);
    slope_.setZero(3, n);
    is_cone_at_.assign(n, false);
    for_all(problem, [&](auto p, Index i, Index row) {
      constexpr int R = Rows::template rows_of<p>;
      shape_.segment<R>(row).setOnes();
      if constexpr (is_cone<Problem, p>)
        shape_.template segment<2>(row + 1).setConstant(problem.book().template friction<p>(i));
      const auto W = problem.template local<p>(i).W;
      double sum = 0;
      for (int k = 0; k < R; ++k) sum += double(W(k, k)) * shape_[row + k] * shape_[row + k];
      weight_.segment<R>(row).setConstant(sum / R);
      problem.template assign<p>(i, Vec<R, T>::Zero());
    });
    return weight_.minCoeff() > 0 && read_W(problem);
  }

  /// τ at which all rows are at once: the mean square of d.
  double start() const { return scale_ * scale_; }

  /// |r| at x; λ is handed over to the problem, and D and z are kept for `find_direction`.
  template <class Problem>
  double evaluate(Problem& problem, double tau) {
    return evaluate_at(problem, x_, tau);
  }
  template <class Problem>
  double evaluate_ahead(Problem& problem, double tau, double t) {
    return evaluate_at(problem, x_ + t * direction_, tau);
  }

  /// −∂r/∂x δ = r, with `shift` D added to the matrix; false when δ is no number.
  bool find_direction(double shift) {
    matrix_ = W_;
    for (Index row = 0, R = 0; row < Index(x_.size()); row += R) {
      R = is_cone_at_[row] ? 3 : 1;
      const Eigen::MatrixXd D = slope_.block(0, row, R, R);
      Eigen::MatrixXd B = Eigen::MatrixXd::Identity(R, R);
      if (R == 3)
        B.block<1, 2>(0, 1) =
            -z_.segment<2>(row + 1).transpose() / std::hypot(z_.segment<2>(row + 1).norm(), root_);
      matrix_.middleCols(row, R) = (W_.middleCols(row, R) * D).eval();
      matrix_.block(row, row, R, R) += B * (Eigen::MatrixXd::Identity(R, R) - D) + shift * D;
    }
    direction_ = solve_dense(matrix_, residual_);
    return direction_.allFinite();
  }
  void advance(double t) { x_ += t * direction_; }

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

  template <class Problem, int p>
  static constexpr bool has_rows_alone() {
    for (const RowKind kind : Problem::BookType::template kinds<p>())
      if (kind != RowKind::equality && kind != RowKind::lower) return false;
    return true;
  }

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
      u.segment<Rows::template rows_of<p>>(row) = problem.template local<p>(i).d.template cast<double>();
    });
    u.array() *= shape_.array();
  }

  /// The answer to an impulse on each row, so large that nothing is lost beside d.
  template <class Problem>
  bool read_W(Problem& problem) {
    const Index n = Index(x_.size());
    Eigen::VectorXd free = x_, moved = x_;
    read_velocities(problem, free);
    scale_ = free.norm() / std::sqrt(double(n));
    const double size = 1e3 * std::max(scale_, 1.0);
    W_.resize(n, n);
    for_all(problem, [&](auto p, Index i, Index row) {
      constexpr int R = Rows::template rows_of<p>;
      for (int k = 0; k < R; ++k) {
        Vec<R, T> impulse = Vec<R, T>::Zero();
        impulse[k] = T(size / weight_[row]);
        problem.template assign<p>(i, impulse);
        read_velocities(problem, moved);
        W_.col(row + k) = (moved - free) * (shape_[row + k] / size);
      }
      problem.template assign<p>(i, Vec<R, T>::Zero());
    });
    return scale_ > 0 && W_.allFinite();
  }

  template <class Problem>
  double evaluate_at(Problem& problem, const Eigen::VectorXd& x, double tau) {
    root_ = std::sqrt(tau);
    for_all(problem, [&](auto p, Index i, Index row) {
      constexpr int R = Rows::template rows_of<p>;
      if constexpr (is_cone<Problem, p>) {
        round_cone(x, row, tau);
      } else {
        constexpr auto kinds = Problem::BookType::template kinds<p>();
        for (int k = 0; k < R; ++k) round_row(x, row + k, kinds[k] == RowKind::equality, tau);
      }
      Vec<R, T> lambda;
      for (int k = 0; k < R; ++k) lambda[k] = T(shape_[row + k] * a_[row + k] / weight_[row]);
      problem.template assign<p>(i, lambda);
    });
    read_velocities(problem, residual_);
    residual_ = z_ - residual_;
    for (Index row = 0; row < Index(x.size()); ++row)
      if (is_cone_at_[row]) residual_[row] -= std::hypot(z_.segment<2>(row + 1).norm(), root_) - root_;
    return residual_.norm();
  }

  /// p(ξ), and its derivative, without a difference of nearly equal numbers.
  static double round(double xi, double tau) {
    const double root = std::sqrt(xi * xi + 4 * tau);
    return xi >= 0 ? 0.5 * (xi + root) : 2 * tau / (root - xi);
  }
  static double round_slope(double xi, double tau) { return round(xi, tau) / std::sqrt(xi * xi + 4 * tau); }

  void round_row(const Eigen::VectorXd& x, Index row, bool is_equality, double tau) {
    is_cone_at_[row] = false;
    a_[row] = is_equality ? x[row] : round(x[row], tau);
    z_[row] = is_equality ? 0 : round(-x[row], tau);
    slope_(0, row) = is_equality ? 1 : round_slope(x[row], tau);
  }

  void round_cone(const Eigen::VectorXd& x, Index row, double tau) {
    for (int k = 0; k < 3; ++k) is_cone_at_[row + k] = k == 0;
    const double length = x.segment<2>(row + 1).norm();
    const Vec2 t = length > 0 ? Vec2(x.segment<2>(row + 1) / length) : Vec2(1, 0);
    const double low = x[row] - length, high = x[row] + length;
    const auto place = [&](double at_low, double at_high, Eigen::VectorXd& out) {
      out[row] = 0.5 * (at_low + at_high);
      out.segment<2>(row + 1) = 0.5 * (at_high - at_low) * t;
    };
    const double a_low = round(low, tau), a_high = round(high, tau);
    place(a_low, a_high, a_);
    place(round(-low, tau), round(-high, tau), z_);
    const double slope_low = round_slope(low, tau), slope_high = round_slope(high, tau);
    const double mean = 0.5 * (slope_low + slope_high), half = 0.5 * (slope_high - slope_low);
    const double across = length > 0 ? (a_high - a_low) / (2 * length) : mean;
    auto D = slope_.block<3, 3>(0, row);
    D(0, 0) = mean;
    D.block<2, 1>(1, 0) = half * t;
    D.block<1, 2>(0, 1) = half * t.transpose();
    D.block<2, 2>(1, 1) = across * Mat2::Identity() + (mean - across) * t * t.transpose();
  }

  using Vec2 = Vec<2>;
  using Mat2 = Mat<2, 2>;

  Eigen::VectorXd x_, direction_, a_, z_, residual_;
  Eigen::VectorXd shape_, weight_;  ///< P and w, row by row
  Eigen::MatrixXd W_, matrix_;      ///< P W P/w, and −∂r/∂x
  Eigen::Matrix<double, 3, Eigen::Dynamic>
      slope_;  ///< D of a cone in three columns, of a row in its first entry
  std::vector<char> is_cone_at_;
  Impulses<Rows> best_;
  double scale_ = 0, root_ = 0;
};

}  // namespace delassus::inner
