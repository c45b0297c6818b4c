/// One island as a system of equations for the velocities of its bodies.
#pragma once

#include <delassus/math/small_products.hpp>
#include <delassus/rows/local.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/solvers/inner/newton_system.hpp>
#include <delassus/solvers/measure.hpp>

#include <cmath>
#include <limits>

namespace delassus::inner {

/// The unknown y is the change of velocity of the island's moving blocks that impulses λ instead of λ̂ make:
///
///   F(y) = y − G (λ(u) − λ̂),   u = d + W λ̂ + H y,   J = 1 + G S H,
///
/// λ(u) the impulses that meet the laws with W = diag(R + ε w) at velocity u around λ̂: the proximal point.
template <class Rows, class System = NewtonSystem<NewtonItem, Rows>>
class BodySpace : public System {
 public:
  using T = typename Rows::Scalar;

  /// Takes the island over with its present λ as λ̂ and best; false where Newton's method cannot act.
  bool gather(auto& problem) {
    if (!System::gather(problem)) return false;
    for (auto* array : {&y_, &change_, &residual_}) array->assign(this->blocks(), zero<Velocity>());
    return true;
  }

  /// λ(u) and F one step of length `fraction` further along δ. Returns √Σ |H F|²/w: the velocities the rows
  /// see, in units of energy.
  double evaluate(auto& problem, double epsilon, double fraction) {
    for (std::size_t b = 0; b < residual_.size(); ++b)
      for (int k = 0; k < System::width; ++k) residual_[b][k] = y_[b][k] + fraction * change_[b][k];
    each(problem, [&](auto p, auto& c, auto& sides) {
      for (int k = 0; k < int(c.trial.size()); ++k) c.trial[k] = c.velocity[k] + fraction * c.move[k];
      auto local = proximal(c, epsilon);
      c.slope = c.template slope_at<p>(problem, local);
      c.lambda = local.lambda;
      const auto change = (c.lambda - c.centre).eval();
      for (Index s = c.first; s < c.last; ++s)
        add_product(sides[s].G, change, residual_[sides[s].block], -1.0);
    });
    double square = 0;
    each(problem, [&](auto, auto& c, auto& sides) {
      set_all(c.error, 0.0);
      for (Index s = c.first; s < c.last; ++s) add_product(sides[s].H, residual_[sides[s].block], c.error);
      square += squared_norm(c.error) / c.weight;
    });
    return std::sqrt(square);
  }

  /// S again, with bounds closer by a thousandth of the error: rows that just touch count as closed. In a
  /// stack that starts to fall as a whole each row is else found closed by a factorization of its own.
  template <class Problem>
  void close_what_touches(Problem& problem, double epsilon, double error) {
    each(problem, [&](auto p, auto& c, auto&) {
      constexpr auto kinds = Problem::BookType::template kinds<p>();
      if (kinds[0] == RowKind::equality) return;
      auto local = proximal(c, epsilon);
      for (std::size_t k = 0; k < kinds.size(); ++k)
        if (kinds[k] == RowKind::lower || kinds[k] == RowKind::upper)
          local.d[k] += (kinds[k] == RowKind::lower ? -1e-3 : 1e-3) * error;
      c.slope = c.template slope_at<p>(problem, local);
    });
  }

  /// J δ = −F; false when J is singular to working precision.
  bool find_direction(auto& problem) {
    const auto ends = [&](int work) { return problem.is_cut_off(work); };
    if (!this->factor(ends)) return false;
    for (std::size_t b = 0; b < change_.size(); ++b)
      for (int k = 0; k < System::width; ++k) change_[b][k] = -residual_[b][k];
    this->solve(change_, ends);
    each(problem, [&](auto, auto& c, auto& sides) {
      set_all(c.move, 0.0);
      for (Index s = c.first; s < c.last; ++s) add_product(sides[s].H, change_[sides[s].block], c.move);
    });
    return true;
  }

  /// Goes where the last evaluation was.
  void advance(auto& problem, double fraction) {
    for (std::size_t b = 0; b < y_.size(); ++b)
      for (int k = 0; k < System::width; ++k) y_[b][k] += fraction * change_[b][k], change_[b][k] = 0;
    each(problem, [](auto, auto& c, auto&) {
      c.velocity = c.trial;
      set_all(c.move, 0.0);
    });
  }

  /// √Σ|F_i(w_i)|² of the last measure, m/s: unlike the residual it is not small beside a velocity that has
  /// grown without bound.
  double error() const { return error_; }

  /// The measure of λ(u), whose own velocity is d + W λ = u − H F + R (λ − λ̂).
  Measure measure(auto& problem) {
    MeasureSums sums;
    each(problem, [&](auto p, auto& c, auto&) {
      constexpr int r = Rows::template rows_of<p>;
      Local<r, T> local{diagonal_of<r>(T(c.weight)), own_velocity(c).template cast<T>(),
                        c.lambda.template cast<T>()};
      problem.template add<p>(c.item, local, sums);
    });
    error_ = std::sqrt(sums.residual);
    return sums.finish(double(std::numeric_limits<T>::epsilon()));
  }

  /// λ̂ ← λ(u).
  void recentre(auto& problem) {
    each(problem, [&](auto, auto& c, auto&) {
      c.velocity = own_velocity(c);
      c.centre = c.lambda;
    });
    for (auto& y : y_) set_all(y, 0.0);
  }

  /// λ̂ ← what the rows have now, its velocity by W; `best` stays. False when that is not finite.
  bool restart(auto& problem) {
    bool is_finite = true;
    each(problem, [&](auto p, auto& c, auto&) {
      const auto local = problem.template local<p>(c.item);
      c.centre = c.lambda = local.lambda.template cast<double>();
      c.velocity = local.d.template cast<double>();
      set_all(c.error, 0.0);
      is_finite = is_finite && delassus::is_finite(c.velocity);
    });
    for (auto* array : {&y_, &change_})
      for (auto& x : *array) set_all(x, 0.0);
    return is_finite;
  }

  /// best ← λ(u).
  void keep(auto& problem) {
    each(problem, [](auto, auto& c, auto&) { c.best = c.lambda; });
  }

  /// The rows take one of the impulses kept here: `&NewtonItem<R>::best`, by a generic lambda.
  void hand_over(auto& problem, const auto& which) {
    each(problem, [&](auto p, auto& c, auto&) { problem.template assign<p>(c.item, which(c).template cast<T>()); });
  }

 protected:
  void each(auto& problem, auto&& f) {
    this->each_until([&](int work) { return problem.is_cut_off(work); }, f);
  }

 private:
  using Velocity = typename System::Velocities::value_type;

  /// The problem of one law: diag(R + ε w), u and λ̂.
  template <int r>
  static Local<r> proximal(const NewtonItem<r>& c, double epsilon) {
    Local<r> local{Mat<r, r>::Zero(), c.trial, c.centre};
    for (int k = 0; k < r; ++k) local.W(k, k) = c.compliance[k] + epsilon * c.weight;
    return local;
  }
  template <int r>
  static Vec<r> own_velocity(const NewtonItem<r>& c) {
    Vec<r> velocity;
    for (int k = 0; k < r; ++k)
      velocity[k] = c.velocity[k] - c.error[k] + c.compliance[k] * (c.lambda[k] - c.centre[k]);
    return velocity;
  }

  double error_ = 0;
  typename System::Velocities y_, change_, residual_;
};

}  // namespace delassus::inner
