/// One island as a system of equations for the velocities of its bodies.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/solvers/inner/newton_system.hpp>
#include <delassus/solvers/measure.hpp>

#include <cstddef>
#include <limits>

namespace delassus::inner {

/// The unknown y is the change of velocity of the island's moving blocks that impulses λ instead of λ̂ make:
///
///   F(y) = y − G (λ(u) − λ̂),   u = d + W λ̂ + H y,   J = 1 + G S H,
///
/// λ(u) the impulses that meet the laws with W = diag(R + ε w) at velocity u around λ̂: the proximal point. `Laws` says which
/// laws these are: tangent(constraint, w, d, λ, S), all by row.
template <class T, class System, class Laws>
class BodySpace : public System {
 public:
  using Constraint = typename System::Constraint;
  using System::best, System::centre, System::compliance, System::lambda, System::slope, System::velocity, System::weight;
  using System::width;

  Laws laws;

  /// Takes the island over with its present λ as λ̂ and best; false where Newton's method cannot act.
  bool gather(Island<T>& island) {
    if (!System::gather(island)) return false;
    for (auto* array : {&y_, &change_, &residual_}) array->assign(this->blocks(), zero<Velocity>());
    for (auto* rows : {&trial, &error, &move, &change}) rows->assign(lambda.size(), 0.0);
    return true;
  }

  /// λ(u) and F one step of length `fraction` further along δ. Returns √Σ (H F)²/w: the velocities the rows
  /// see, in units of energy.
  double evaluate(Island<T>& island, double epsilon, double fraction) {
    for (std::size_t b = 0; b < residual_.size(); ++b)
      for (int k = 0; k < width; ++k) residual_[b][k] = y_[b][k] + fraction * change_[b][k];
    for (std::size_t k = 0; k < trial.size(); ++k) trial[k] = velocity[k] + fraction * move[k];
    lambda = centre;
    for (const Constraint& c : this->constraints_) {
      if (island.is_cut_off(1)) break;
      find_slope(c, epsilon, &trial[c.at], &lambda[c.at]);
    }
    for (std::size_t k = 0; k < change.size(); ++k) change[k] = lambda[k] - centre[k];
    for (const Constraint& c : this->constraints_) this->add_answers(c, &change[c.at], -1, residual_);
    error.assign(error.size(), 0.0);
    double square = 0;
    for (const Constraint& c : this->constraints_) {
      if (island.is_cut_off(1)) break;
      this->add_rates(c, residual_, &error[c.at]);
      square += over_weights(c, &error[c.at]);
    }
    return std::sqrt(square);
  }

  /// S again, with bounds closer by a thousandth of the error: rows that just touch count as closed. In a
  /// stack that starts to fall as a whole each row is else found closed by a factorization of its own.
  void close_what_touches(Island<T>& island, double epsilon, double closer) {
    double d[most_rows], ignored[most_rows];
    for (const Constraint& c : this->constraints_) {
      if (island.is_cut_off(1)) break;
      const RowKind* kinds = Island<T>::kinds(*c.span);
      if (kinds[0] == RowKind::equality) continue;
      for (int k = 0; k < c.rows; ++k) {
        d[k] = trial[c.at + k];
        const double nearer = 1e-3 * closer / (c.span->pool->turn(k) ? island.length() : 1);
        if (kinds[k] == RowKind::lower || kinds[k] == RowKind::upper) d[k] += kinds[k] == RowKind::lower ? -nearer : nearer;
      }
      for (int k = 0; k < c.rows; ++k) ignored[k] = centre[c.at + k];
      find_slope(c, epsilon, d, ignored);
    }
  }

  /// J δ = −F; false when J is singular to working precision.
  bool find_direction(Island<T>& island) {
    if (!this->factor(&island)) return false;
    for (std::size_t b = 0; b < change_.size(); ++b)
      for (int k = 0; k < width; ++k) change_[b][k] = -residual_[b][k];
    this->solve(change_, &island);
    for (const Constraint& c : this->constraints_) {
      if (island.is_cut_off(1)) break;
      for (int k = 0; k < c.rows; ++k) move[c.at + k] = 0;
      this->add_rates(c, change_, &move[c.at]);
    }
    return true;
  }

  /// Goes where the last evaluation was.
  void advance(double fraction) {
    for (std::size_t b = 0; b < y_.size(); ++b)
      for (int k = 0; k < width; ++k) y_[b][k] += fraction * change_[b][k], change_[b][k] = 0;
    velocity = trial;
    move.assign(move.size(), 0.0);
  }

  /// √Σ|F_i(w_i)|² of the last measure, m/s: unlike the residual it is not small beside a velocity that has
  /// grown without bound.
  double last_error() const { return error_; }

  /// The measure of λ(u), whose own velocity is d + W λ = u − H F + R (λ − λ̂).
  Measure measure(Island<T>& island) {
    MeasureSums sums{.length = island.length()};
    T u[most_rows], x[most_rows];
    for (const Constraint& c : this->constraints_) {
      if (island.is_cut_off(1)) break;
      for (int k = 0; k < c.rows; ++k) u[k] = T(own_velocity(c.at + k)), x[k] = T(lambda[c.at + k]);
      c.span->pool->table->add_share(*c.span->pool, c.item, u, x, sums);
    }
    error_ = std::sqrt(sums.residual);
    return sums.finish(double(std::numeric_limits<T>::epsilon()));
  }

  /// λ̂ ← λ(u).
  void recentre() {
    for (std::size_t k = 0; k < lambda.size(); ++k) {
      velocity[k] = own_velocity(Index(k));
      centre[k] = lambda[k];
    }
    for (Velocity& y : y_) set_all(y, 0.0);
  }

  /// λ̂ ← what the rows have now, its velocity by W; `best` stays. False when that is not finite.
  bool restart(Island<T>& island) {
    bool is_finite = true;
    T u[most_rows];
    for (const Constraint& c : this->constraints_) {
      if (island.is_cut_off(1)) break;
      Island<T>::velocity(*c.span, c.item, u);
      const T* x = Island<T>::impulse(*c.span, c.item);
      for (int k = 0; k < c.rows; ++k) {
        centre[c.at + k] = lambda[c.at + k] = double(x[k]);
        velocity[c.at + k] = double(u[k]);
        error[c.at + k] = 0;
        is_finite = is_finite && std::isfinite(double(u[k]));
      }
    }
    for (auto* array : {&y_, &change_})
      for (Velocity& x : *array) set_all(x, 0.0);
    return is_finite;
  }

  /// best ← λ(u).
  void keep() { best = lambda; }

  /// The rows take impulses kept here, by row.
  void hand_over(Island<T>& island, const Array<double>& which) const {
    T x[most_rows];
    for (const Constraint& c : this->constraints_) {
      if (island.is_cut_off(1)) break;
      for (int k = 0; k < c.rows; ++k) x[k] = T(which[c.at + k]);
      Island<T>::assign(*c.span, c.item, x);
    }
  }

 protected:
  /// Σ x²/w over the rows of a constraint.
  double over_weights(const Constraint& c, const double* x) const {
    double sum = 0;
    for (int k = 0; k < c.rows; ++k) sum += x[k] * x[k] / weight[c.at + k];
    return sum;
  }

  Array<double> trial;  ///< by row: u one step further
  Array<double> error;  ///< by row: H F
  Array<double> move;   ///< by row: H δ
  Array<double> change;  ///< by row: λ(u) − λ̂

 private:
  using Velocity = typename System::Velocity;

  /// S and the impulse that meets the law of diag(R + ε w) at velocity d around λ̂, which `answer` has before.
  void find_slope(const Constraint& c, double epsilon, const double* d, double* answer) {
    double w[most_rows];
    for (int k = 0; k < c.rows; ++k) w[k] = compliance[c.at + k] + epsilon * weight[c.at + k];
    laws.tangent(c, w, d, answer, &slope[c.slope]);
  }
  double own_velocity(Index k) const { return velocity[k] - error[k] + compliance[k] * (lambda[k] - centre[k]); }

  double error_ = 0;
  typename System::Velocities y_, change_, residual_;
};

/// The laws as they are.
template <class T>
struct LawsAsTheyAre {
  static void tangent(const NewtonConstraint<T>& c, const double* w, const double* d, double* lambda, double* slope) {
    c.span->pool->tangent(*c.span->pool, c.item, w, d, lambda, slope);
  }
};

}  // namespace delassus::inner
