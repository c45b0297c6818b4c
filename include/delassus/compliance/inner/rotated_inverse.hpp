/// A⁻¹ of one soft body by a factor of an earlier A, its nodes turned as they have turned since.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/linear/multifrontal_cholesky.hpp>
#include <delassus/math/rotation.hpp>
#include <delassus/rows/body_set.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>

namespace delassus::inner {

/// With F the factored matrix, y the nodes' places then, x those of now, and R_i the rotation next to
/// Σ_j (x_j − x_i)(y_j − y_i)ᵀ over the neighbours j of node i:
///
///   A⁻¹ ≈ R F⁻¹ Rᵀ,   R = diag(R_i),
///
/// which is A⁻¹ itself as long as the body has turned as a whole. `solve` takes it as the preconditioner of
/// conjugate gradients on A; `compliance` takes it as it is. S is the scalar of the factor. Warm calls with
/// as many nodes allocate nothing. Source: [CourtecuisseAllard2014].
template <class S, class T>
class RotatedInverse {
 public:
  using FactorScalar = S;
  using Velocity = Vec<3, T>;
  using NodeVectors = Array<Velocity>;

  Index nodes() const { return Index(slot_.size()); }
  /// There is no factor, or it is of other held nodes, or of another step or damping.
  bool is_of_another(const auto& body) const {
    return !is_factored_ || body.scale().mass != scale_.mass || body.scale().stiffness != scale_.stiffness ||
           !std::equal(is_held_.begin(), is_held_.end(), body.held().begin(), body.held().end());
  }

  /// The pattern of a body, whose places at rest make the order.
  void analyse(const auto& body) {
    factor_.analyse(Index(body.blocks().size()), body.pairs(), body.mesh().points);
    const std::size_t n = body.blocks().size();
    for (NodeVectors* list : {&r_, &z_, &p_, &q_, &then_}) list->assign(n, Velocity::Zero());
    for (auto& guess : guess_) guess.assign(n, Velocity::Zero());
    turned_.assign(n, Vec<3, S>::Zero());
    slot_.assign(n, -1);
    is_factored_ = false;
  }

  /// Factors the A that the body has now, at nodes at the places of `then`; not the pattern.
  bool factor(const auto& body, std::span<const Velocity> then) {
    body.enter(factor_);
    is_factored_ = factor_.factor();
    then_.assign(then.begin(), then.end());
    rotation_.assign(then_.size(), Eigen::Quaternion<T>::Identity());
    turn_.assign(then_.size(), Mat<3, 3, T>::Identity());
    is_held_.assign(body.held().begin(), body.held().end());
    scale_ = body.scale();
    forget();
    return is_factored_;
  }
  void forget() {
    for (const Index node : known_) slot_[node] = -1;
    known_.clear();
  }

  /// Finds how the nodes have turned, x the places of now by nodes. Each begins from the turn it had.
  void turn(const auto& body, std::span<const Velocity> x) {
    spread_.assign(x.size(), Mat<3, 3, T>::Zero());
    for (const auto& [i, j] : body.pairs()) {
      const Velocity now = x[j] - x[i], before = then_[j] - then_[i];
      const Mat<3, 3, T> edge = columns<T>(now * before[0], now * before[1], now * before[2]);
      spread_[i] += edge, spread_[j] += edge;
    }
    for (std::size_t k = 0; k < x.size(); ++k) turn_next_to(spread_[k], rotation_[k], turn_[k]);
  }

  /// x ← A⁻¹ x by nodes, from the answer that `guess` (0 or 1) had last, until |x − A y| ≤ tolerance |x|;
  /// returns the iterations, or −1 when `most` did not do.
  int solve(const auto& body, NodeVectors& x, double tolerance, int most, int guess) {
    NodeVectors& y = guess_[guess];
    const double goal = tolerance * tolerance * dot(x, x);
    if (!(goal > 0) || !is_factored_) {  // zero, or not a number: the answer is the same
      if (goal != 0)
        for (Velocity& v : x) v.setConstant(std::numeric_limits<T>::quiet_NaN());
      return 0;
    }
    body.multiply(y, q_);
    for (std::size_t k = 0; k < y.size(); ++k) r_[k] = x[k] - q_[k];
    if (!(dot(r_, r_) < dot(x, x))) {  // no better than nothing
      for (Velocity& v : y) v.setZero();
      r_ = x;
    }
    double before = 0;
    int n = 0;
    for (; dot(r_, r_) > goal && n < most; ++n) {
      precondition(r_, z_);
      const double now = dot(r_, z_);
      const T beta = n == 0 ? T(0) : T(now / before);
      for (std::size_t k = 0; k < y.size(); ++k) p_[k] = z_[k] + beta * p_[k];
      body.multiply(p_, q_);
      const T alpha = T(now / dot(p_, q_));
      for (std::size_t k = 0; k < y.size(); ++k) y[k] += alpha * p_[k], r_[k] -= alpha * q_[k];
      before = now;
    }
    const bool is_there = dot(r_, r_) <= goal;
    x = y;
    return is_there ? n : -1;
  }

  /// R F⁻¹ Rᵀ at some nodes, 3n × 3n by columns. The part F⁻¹ is kept from call to call for the nodes of the
  /// last one, with `keeps_all` for all that were ever asked for.
  void compliance(std::span<const Index> nodes, std::span<T> C, bool keeps_all) {
    if (std::any_of(nodes.begin(), nodes.end(), [&](Index i) { return slot_[i] < 0; }))
      know(nodes, keeps_all);
    const std::size_t rows = 3 * nodes.size(), all = 3 * known_.size();
    for (std::size_t b = 0; b < nodes.size(); ++b)
      for (std::size_t a = 0; a < nodes.size(); ++a) {
        const Index i = nodes[a], j = nodes[b];
        Mat<3, 3, T> block = Mat<3, 3, T>::Zero();
        if (!is_held_[i] && !is_held_[j]) {
          const S* from = &kept_[3 * std::size_t(slot_[i]) + 3 * std::size_t(slot_[j]) * all];
          for (int c = 0; c < 3; ++c)
            for (int r = 0; r < 3; ++r) block(r, c) = T(from[std::size_t(r) + std::size_t(c) * all]);
          block = turn_[i] * block * turn_[j].transpose();
        }
        for (int c = 0; c < 3; ++c)
          for (int r = 0; r < 3; ++r)
            C[3 * a + std::size_t(r) + (3 * b + std::size_t(c)) * rows] = block(r, c);
      }
  }

  /// The nodes and the numbers that `compliance` keeps: for a file.
  std::span<const Index> known() const { return known_; }
  std::span<const S> kept() const { return kept_; }
  void take(std::span<const Index> nodes, std::span<const S> numbers) {
    forget();
    known_.assign(nodes.begin(), nodes.end());
    kept_.assign(numbers.begin(), numbers.end());
    for (std::size_t k = 0; k < known_.size(); ++k) slot_[known_[k]] = Index(k);
  }
  /// F⁻¹ at these nodes, beside what is known or in its place.
  void know(std::span<const Index> nodes, bool beside) {
    if (!beside) forget();
    for (const Index i : nodes)
      if (slot_[i] < 0) slot_[i] = Index(known_.size()), known_.push_back(i);
    kept_.resize(9 * known_.size() * known_.size());
    factor_.compliance(known_, kept_);
  }

 private:
  static double dot(const NodeVectors& a, const NodeVectors& b) {
    const Eigen::Index n = 3 * Eigen::Index(a.size());
    using Flat = Eigen::Map<const Eigen::Matrix<T, Eigen::Dynamic, 1>>;
    return double(Flat(a[0].data(), n).dot(Flat(b[0].data(), n)));
  }

  /// z = R F⁻¹ Rᵀ r.
  void precondition(const NodeVectors& r, NodeVectors& z) {
    for (std::size_t k = 0; k < r.size(); ++k)
      turned_[k] = Velocity(turn_[k].transpose() * r[k]).template cast<S>();
    factor_.solve(turned_);
    for (std::size_t k = 0; k < r.size(); ++k) z[k] = turn_[k] * turned_[k].template cast<T>();
  }

  /// By Newton's method: with B = A Rᵀ, S its symmetric part and m twice the axis of the rest, a turn about
  /// (tr S − S)⁻¹ m brings R next to A; about m by atan2(|m|, tr S) where that is far.
  static void turn_next_to(const Mat<3, 3, T>& A, Eigen::Quaternion<T>& q, Mat<3, 3, T>& R) {
    for (int n = 0; n < 20; ++n) {
      const Mat<3, 3, T> B = A * R.transpose();
      const Velocity m(B(2, 1) - B(1, 2), B(0, 2) - B(2, 0), B(1, 0) - B(0, 1));
      const T trace = B(0, 0) + B(1, 1) + B(2, 2), size = m.norm();
      if (!(size > T(1e-6) * std::abs(trace)) || !std::isfinite(size)) return;
      Mat<3, 3, T> K;
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) K(r, c) = (r == c ? trace : T(0)) - T(0.5) * (B(r, c) + B(c, r));
      Velocity omega = inverse(K) * m;
      if (!(trace > T(0)) || !(omega.dot(omega) < T(0.25))) omega = std::atan2(size, trace) / size * m;
      q = unit(Eigen::Quaternion<T>(exponential<T>(omega) * q));
      R = rotation_matrix<T>(q);
    }
  }

  MultifrontalCholesky<3, S> factor_;
  bool is_factored_ = false;
  NodeVectors then_;  ///< where the nodes were
  Array<Eigen::Quaternion<T>> rotation_;
  Array<Mat<3, 3, T>> turn_, spread_;
  Array<char> is_held_;
  SystemScale scale_;
  Array<Index> known_, slot_;
  Array<S> kept_;
  NodeVectors r_, z_, p_, q_, guess_[2];
  Array<Vec<3, S>> turned_;
};

}  // namespace delassus::inner
