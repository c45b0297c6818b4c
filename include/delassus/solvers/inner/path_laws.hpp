/// The laws of one island as smoothed rows, with the Newton step and the tangent of their path in body space.
#pragma once

#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/solvers/inner/path_item.hpp>
#include <delassus/solvers/inner/path_systems.hpp>
#include <delassus/solvers/inner/rows_alone.hpp>
#include <delassus/solvers/island_problem.hpp>

#include <algorithm>
#include <cmath>

namespace delassus::inner {

/// The constraints of an island with their unknowns x, r(x, τ) and the two directions that `PathNewton` goes
/// in.
template <class Rows>
class PathLaws {
  using System = PathSystem<Rows>;
  using T = typename Rows::Scalar;

 public:
  /// Begins at x = 0; false where a law has no such form, or Newton's method cannot act.
  template <class Problem>
  bool gather(Problem& problem) {
    bool is_known = true;
    problem.each(
        [&](auto p, Index) { is_known = is_known && (is_cone<Problem, p> || has_rows_alone<Problem, p>()); });
    if (!is_known || !system_.gather(problem)) return false;
    rows_ = problem.row_count();
    double square = 0;
    each([&](auto p, auto& c) {
      constexpr int R = Rows::template rows_of<p>;
      problem.template assign<p>(c.item, Vec<R, T>::Zero());
      c.shape.setOnes();
      if constexpr (is_cone<Problem, p>)
        for (int k = 1; k < R; ++k) c.shape[k] = problem.book().template friction<p>(c.item);
      const auto W = problem.template local<p>(c.item).W;
      c.weight = 0;
      for (int k = 0; k < R; ++k) c.weight += double(W(k, k)) * c.shape[k] * c.shape[k] / R;
      is_known = is_known && c.weight > 0;
      c.scale = c.shape / c.weight;
      for (auto* v : {&c.x, &c.direction, &c.tangent}) v->setZero();
    });
    each([&](auto p, auto& c) {
      const auto d = problem.template local<p>(c.item).d;
      for (int k = 0; k < d.size(); ++k) square += std::pow(c.shape[k] * double(d[k]), 2);
    });
    scale_ = std::sqrt(square / rows_);
    return is_known && scale_ > 0 && std::isfinite(scale_);
  }

  /// The root of the mean square of d: with τ its square, all rows are at once.
  double scale() const { return scale_; }
  int rows() const { return rows_; }
  /// The largest velocity that an impulse of the last evaluation stands for, a, or `scale`: what r is rounded
  /// by.
  double reach() const { return reach_; }
  bool is_negative() const { return system_.is_negative(); }

  /// |r| at x + t δ + s dx/ds; λ is handed over to the problem.
  template <class Problem>
  double evaluate(Problem& problem, double tau, double t = 0, double s = 0) {
    reach_ = scale_;
    each([&](auto p, auto& c) {
      constexpr int R = Rows::template rows_of<p>;
      c.ahead = c.x + t * c.direction + s * c.tangent;
      smooth<is_cone<Problem, p>>(c, Problem::BookType::template kinds<p>(), tau, System::largest_ratio);
      reach_ = std::max(reach_, c.a.cwiseAbs().maxCoeff());
      problem.template assign<p>(c.item, Vec<R, T>(c.scale.cwiseProduct(c.a).template cast<T>()));
    });
    double square = 0;
    each([&](auto p, auto& c) {
      const auto u = problem.template local<p>(c.item).d;
      for (int k = 0; k < u.size(); ++k) c.residual[k] = c.z[k] - c.shape[k] * double(u[k]);
      if constexpr (is_cone<Problem, p>) c.residual[0] -= lag(c, tau);
      square += c.residual.squaredNorm();
    });
    return std::sqrt(square);
  }
  /// x ← where the last evaluation was.
  void advance() {
    each([](auto, auto& c) { c.x = c.ahead; });
  }

  /// Factors −∂r/∂x where the last evaluation was; false when it is singular.
  template <class Problem>
  bool factor(double tau) {
    each([&](auto p, auto& c) {
      constexpr int R = Rows::template rows_of<p>;
      c.B.setIdentity();
      if constexpr (is_cone<Problem, p>)
        for (int k = 1; k < R; ++k) c.B(0, k) = -c.z[k] / slip(c, tau);
    });
    return system_.factor();
  }

  /// Leaves (−∂r/∂x)⁻¹ r in `lambda`.
  void find_direction() {
    each([](auto, auto& c) { c.side = c.residual; });
    system_.solve();
  }
  /// rate ← (−∂r/∂x)⁻¹ ∂r/∂log τ: what x does along the path as log τ grows.
  template <class Problem>
  void find_rate(double tau) {
    // In the algebra ∂a/∂log τ = ∂z/∂log τ = τ (a + z)⁻¹, since a ∘ z = τ and a − z = x.
    each([&](auto p, auto& c) {
      const Vec<Rows::template rows_of<p>> change = growth<Problem, p>(c, tau);
      c.error = c.scale.cwiseProduct(change);  // ∂λ/∂log τ
      c.side = change;
      if constexpr (is_cone<Problem, p>) {
        const double s = slip(c, tau);
        for (int k = 1; k < c.side.size(); ++k) c.side[0] -= c.z[k] / s * change[k];
        c.side[0] += 0.5 * std::sqrt(tau) * lag(c, tau) / s;
      }
    });
    system_.answer();
    each([](auto, auto& c) { c.side -= c.shape.cwiseProduct(c.velocity); });
    system_.solve();
    each([](auto, auto& c) { c.rate = c.lambda; });
  }

  /// Σ of the two at every constraint, f(c) and g(c), in the lengths of the path: each beside |x_i|² + 4 τ.
  double product(double tau, const auto& f, const auto& g) {
    double sum = 0;
    each([&](auto, auto& c) { sum += f(c).dot(g(c)) / (c.x.squaredNorm() + 4 * tau); });
    return sum / rows_;
  }
  /// f(constraint) for all.
  void each_item(auto&& f) {
    each([&](auto, auto& c) { f(c); });
  }

 private:
  template <class Problem, int p>
  static constexpr bool is_cone = Problem::BookType::template has_cone<p>();

  void each(auto&& f) {
    system_.each(f);
  }

  /// √(|z_t|² + τ).
  static double slip(const auto& c, double tau) {
    return std::hypot(c.z[1], c.z[2], std::sqrt(tau));
  }

  /// √(|z_t|² + τ) − √τ, without their difference.
  static double lag(const auto& c, double tau) {
    return (c.z[1] * c.z[1] + c.z[2] * c.z[2]) / (slip(c, tau) + std::sqrt(tau));
  }

  /// τ (a + z)⁻¹.
  template <class Problem, int p, class Item>
  static auto growth(const Item& c, double tau) {
    constexpr int R = Rows::template rows_of<p>;
    Vec<R> out = c.a + c.z;
    if constexpr (is_cone<Problem, p>) {
      const double length = std::hypot(out[1], out[2]), determinant = (out[0] - length) * (out[0] + length);
      out *= tau / determinant;
      for (int k = 1; k < R; ++k) out[k] = -out[k];
    } else {
      constexpr auto kinds = Problem::BookType::template kinds<p>();
      for (int k = 0; k < R; ++k) out[k] = kinds[std::size_t(k)] == RowKind::equality ? 0 : tau / out[k];
    }
    return out;
  }

  System system_;
  double scale_ = 0, reach_ = 0;
  int rows_ = 0;
};

}  // namespace delassus::inner
