/// Of all impulses of equalities that make the same motion, the smallest: for rows that depend on each other.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>

#include <cstddef>
#include <type_traits>
#include <vector>

namespace delassus {

/// λ ← argmin Σ w_k λ_k² with W λ unchanged, w_k = W_kk, by
///
///   (W + ε w) δ = W (λ − x),   x ← x + δ   from x = 0,
///
/// which never leaves what W reaches: hinges of one door carry equal shares, and their loads are as
/// continuous in time as its motion is. Source: [Carpentier2021] for the iteration.
template <class System>
class LeastImpulses {
  using Row = typename System::Row;

 public:
  /// Whether λ is the smallest, by one answer of the factor that `system`, an `inner::DirectSystem`, has.
  /// lambda(p, item) is a reference to the impulses of an item.
  template <class Lambda>
  bool are_least(System& system, const Lambda& lambda) {
    begin(system, lambda);
    rate_ = goal_;
    add_answer(system);
    double apart = 0, size = 0;
    for (Index k = 0; k < system.bilateral(); ++k)
      for (int r = 0; r < system.node(k).rows; ++r) {
        const double w = system.node(k).scale[r], share = x_[k][r] - given_[k][r];
        apart += w * share * share;
        size += w * given_[k][r] * given_[k][r];
      }
    return apart <= 1e-6 * size;
  }
  /// Factors W with an ε whose rounding is no load, and finds them; λ stays where that fails.
  template <class Lambda>
  void find(System& system, const Lambda& lambda) {
    if (!system.factor(1e-8)) return;
    begin(system, lambda);
    const double whole = squared(system, goal_);
    double left = whole;
    for (int pass = 0; pass < 4 && left > 1e-24 * whole; ++pass) {
      rate_ = goal_;
      multiply(system, x_, moved_);
      for (std::size_t k = 0; k < x_.size(); ++k) rate_[k] -= moved_[k];
      left = squared(system, rate_);
      add_answer(system);
    }
    if (!(left <= 1e-18 * whole)) return;
    system.each([&](auto p, Index k) {
      auto& to = lambda(p, system.node(k).item);
      using T = typename std::remove_reference_t<decltype(to)>::Scalar;
      for (int r = 0; r < to.size(); ++r) to[r] = T(x_[k][r]);
    });
  }

 private:
  template <class Lambda>
  void begin(System& system, const Lambda& lambda) {
    const std::size_t n = std::size_t(system.bilateral());
    for (auto* rows : {&x_, &given_}) rows->assign(n, Row::Zero());
    system.each([&](auto p, Index k) {
      const auto& from = lambda(p, system.node(k).item);
      for (int r = 0; r < from.size(); ++r) given_[k][r] = double(from[r]);
    });
    multiply(system, given_, goal_);
  }
  /// u = W x = (H G + R) x.
  void multiply(const System& system, const Array<Row>& x, Array<Row>& u) {
    u.resize(x.size());
    moves_.assign(system.blocks(), System::Twist::Zero());
    each_side(system,
              [&](std::size_t k, const auto& side) { moves_[side.block].noalias() += side.G * x[k]; });
    for (std::size_t k = 0; k < x.size(); ++k) u[k] = system.node(Index(k)).compliance.cwiseProduct(x[k]);
    each_side(system,
              [&](std::size_t k, const auto& side) { u[k].noalias() += side.H * moves_[side.block]; });
  }
  template <class F>
  static void each_side(const System& system, F&& f) {
    for (Index k = 0; k < system.bilateral(); ++k)
      for (Index e = system.node(k).first; e < system.node(k).last; ++e) f(std::size_t(k), system.side(e));
  }
  /// x += (W + ε w)⁻¹ rate.
  void add_answer(System& system) {
    system.clear();
    for (Index k = 0; k < system.bilateral(); ++k) system.set_right_side(k, rate_[k]);
    system.solve();
    for (Index k = 0; k < system.bilateral(); ++k) x_[k] += system.answer(k);
  }
  static double squared(const System& system, const Array<Row>& u) {
    double sum = 0;
    for (std::size_t k = 0; k < u.size(); ++k)
      for (int r = 0; r < system.node(Index(k)).rows; ++r)
        if (system.node(Index(k)).scale[r] > 0) sum += u[k][r] * u[k][r] / system.node(Index(k)).scale[r];
    return sum;
  }

  Array<Row> given_, goal_, x_, rate_, moved_;
  std::vector<typename System::Twist> moves_;
};

}  // namespace delassus
