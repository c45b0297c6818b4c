/// Rows and cones with their corners rounded off, and the matrix of a Newton step for them.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/linear/dense_lu.hpp>
#include <delassus/math/linear.hpp>

#include <Eigen/Core>

#include <cmath>
#include <cstdint>
#include <vector>

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
class SmoothedRows {
 public:
  enum class Kind : std::uint8_t {
    equality,
    lower,
    cone,
    of_cone
  };  ///< a cone is three rows: cone, of_cone twice

  Eigen::VectorXd x, direction, residual;
  Eigen::VectorXd shape, weight;  ///< P and w, row by row
  Eigen::MatrixXd W;              ///< P W P/w
  std::vector<Kind> kind;

  Index size() const { return Index(x.size()); }
  void resize(Index n) {
    for (auto* v : {&x, &direction, &residual, &shape, &weight, &a_, &z_}) v->setZero(n);
    slope_.setZero(3, n);
    kind.assign(n, Kind::equality);
    W.resize(n, n);
  }

  /// a, z and D at y.
  void round(const Eigen::VectorXd& y, double tau) {
    root_ = std::sqrt(tau);
    for (Index row = 0; row < size(); ++row)
      if (kind[row] == Kind::cone)
        round_cone(y, row, tau);
      else if (kind[row] != Kind::of_cone)
        round_row(y, row, tau);
  }
  double lambda(Index row) const { return shape[row] * a_[row] / weight[row]; }

  /// |r|, where `residual` holds P (d + W λ) of what `round` made.
  double finish_residual() {
    residual = z_ - residual;
    for (Index row = 0; row < size(); ++row)
      if (kind[row] == Kind::cone) residual[row] -= slip(row) - root_;
    return residual.norm();
  }

  /// −∂r/∂x δ = r, with `shift` D added to the matrix; false when δ is no number.
  bool find_direction(double shift) {
    matrix_ = W;
    for (Index row = 0, R = 0; row < size(); row += R) {
      R = kind[row] == Kind::cone ? 3 : 1;
      const Eigen::MatrixXd D = slope_.block(0, row, R, R);
      Eigen::MatrixXd B = Eigen::MatrixXd::Identity(R, R);
      if (R == 3) B.block<1, 2>(0, 1) = -z_.segment<2>(row + 1).transpose() / slip(row);
      matrix_.middleCols(row, R) = (W.middleCols(row, R) * D).eval();
      matrix_.block(row, row, R, R) += B * (Eigen::MatrixXd::Identity(R, R) - D) + shift * D;
    }
    direction = solve_dense(matrix_, residual);
    return direction.allFinite();
  }

 private:
  /// √(|z_t|² + τ).
  double slip(Index row) const { return std::hypot(z_.segment<2>(row + 1).norm(), root_); }

  /// p(ξ), and its derivative, without a difference of nearly equal numbers.
  static double round(double xi, double tau) {
    const double root = std::sqrt(xi * xi + 4 * tau);
    return xi >= 0 ? 0.5 * (xi + root) : 2 * tau / (root - xi);
  }
  static double round_slope(double xi, double tau) { return round(xi, tau) / std::sqrt(xi * xi + 4 * tau); }

  void round_row(const Eigen::VectorXd& y, Index row, double tau) {
    const bool is_equality = kind[row] == Kind::equality;
    a_[row] = is_equality ? y[row] : round(y[row], tau);
    z_[row] = is_equality ? 0 : round(-y[row], tau);
    slope_(0, row) = is_equality ? 1 : round_slope(y[row], tau);
  }

  void round_cone(const Eigen::VectorXd& y, Index row, double tau) {
    const double length = y.segment<2>(row + 1).norm();
    const Vec<2> t = length > 0 ? Vec<2>(y.segment<2>(row + 1) / length) : Vec<2>(1, 0);
    const double low = y[row] - length, high = y[row] + length;
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
    D.block<2, 2>(1, 1) = across * Mat<2, 2>::Identity() + (mean - across) * t * t.transpose();
  }

  Eigen::VectorXd a_, z_;
  Eigen::MatrixXd matrix_;  ///< −∂r/∂x
  Eigen::Matrix<double, 3, Eigen::Dynamic>
      slope_;  ///< D of a cone in three columns, of a row in its first entry
  double root_ = 0;
};

}  // namespace delassus::inner
