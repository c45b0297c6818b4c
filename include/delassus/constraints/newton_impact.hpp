/// Newton's impact law in a step: restitution of rows that close.
#pragma once

#include <delassus/constraints/bounces.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/owning_array.hpp>
#include <delassus/rows/row_arrays.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/theta.hpp>
#include <delassus/rows/world_view.hpp>

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <utility>

namespace delassus {

/// A solver's, which takes its pools from what `rows/` shows.
template <class T>
class Island;

/// Newton's restitution on several contacts with friction can add energy. Where it did, λ becomes λ_c + s (λ_N − λ_c).
/// With restitution the solution is λ_N, without λ_c. Of s in [0, 1] it is the largest for which the impulses add no more
/// energy than those of λ_c do, and what rows that part took away as they landed. Both lie in the cone, which is convex, so λ does.
template <class T>
class EnergyGuard {
 public:
  EnergyGuard(Island<T>& island, const Bounces<T>& bounces, Array<T>& newton, Array<T>& newton_velocity, Array<T>& start)
      : island_(island), bounces_(bounces), newton_(newton), velocity_(newton_velocity), start_(start) {}

  /// After a solve that converged: whether to solve anew, from the λ there is, and then to `finish`. v is that of the start of the step.
  bool asks_again(AllRows<T> rows, const T* const* v) {
    if (!has_bounced()) return false;
    note_start(rows, v);
    if (!(energy() > returned())) return false;
    take_bounce_away();
    return true;
  }
  void finish() {
    shed();
    const double s = share();
    T next[most_rows];
    std::size_t at = 0;
    for (const auto& span : island_)
      for (const Index i : span) {
        const T* lambda = island_.impulse(span, i);
        for (int k = 0; k < span.pool->rows; ++k, ++at) next[k] = lambda[k] + T(s) * (newton_[at] - lambda[k]);
        island_.assign(span, i, next);
      }
  }

 private:
  static const T* bias(const auto& span, Index i) { return span.pool->bias + std::ptrdiff_t(span.pool->rows) * i; }

  bool has_bounced() const {
    for (const auto& span : island_) {
      const int R = span.pool->rows;
      const T* added = bounces_.added[std::size_t(span.pool->pool)].data();
      for (const Index i : span)
        for (int k = 0; k < R; ++k)
          if (added[std::ptrdiff_t(R) * i + k] != T(0)) return true;
    }
    return false;
  }

  /// What landings took and partings may give back, J.
  double returned() const {
    double sum = 0;
    for (const auto& span : island_) {
      const auto& of_pool = bounces_.returned[std::size_t(span.pool->pool)];
      if (of_pool.empty()) continue;
      for (const Index i : span)
        for (int k = 0; k < span.pool->rows; ++k) sum += double(of_pool[std::size_t(span.pool->rows * i + k)]);
    }
    return sum;
  }

  /// u⁻ = H v of all rows.
  void note_start(AllRows<T> rows, const T* const* v) {
    start_.resize(std::size_t(island_.row_count()));
    T* u = start_.data();
    for (const auto& span : island_)
      for (const Index i : span) {
        inner::rate(rows[std::size_t(span.pool->pool)], i, v, u);
        u += span.pool->rows;
      }
  }

  /// The energy that the impulses give the bodies, J: Σ ½ λ·(u⁻ + u⁺), u without bias. With u_free for u⁻ it would lack what the
  /// bodies gain or lose in height as they move by u⁺, or by the mean, and not freely.
  double energy() const {
    double sum = 0;
    T u[most_rows];
    const T* start = start_.data();
    for (const auto& span : island_)
      for (const Index i : span) {
        island_.velocity(span, i, u);
        const T *lambda = island_.impulse(span, i), *b = bias(span, i);
        for (int k = 0; k < span.pool->rows; ++k) sum += 0.5 * double(lambda[k]) * double(*start++ + u[k] - b[k]);
      }
    return sum;
  }

  /// λ_N is kept with its velocity; bias and d are those without restitution from here on.
  void take_bounce_away() {
    island_.save(newton_);
    velocity_.resize(newton_.size());
    T* u = velocity_.data();
    for (const auto& span : island_)
      for (const Index i : span) {
        const int R = span.pool->rows;
        island_.velocity(span, i, u);
        for (int k = 0; k < R; ++k) u[k] -= bias(span, i)[k];
        u += R;
      }
    for (const auto& span : island_)
      for (const Index i : span) {
        const std::ptrdiff_t at = std::ptrdiff_t(span.pool->rows) * i;
        const T* added = bounces_.added[std::size_t(span.pool->pool)].data() + at;
        for (int k = 0; k < span.pool->rows; ++k) span.pool->bias[at + k] -= added[k], span.pool->d[at + k] -= added[k];
      }
  }

  /// A solution without restitution gives at most −Σ λ·bias, the work of the push-out. Where the sweeps ran out before that
  /// holds, λ ← s λ, s the largest number in [0, 1] for which it does; a cone holds s λ too.
  void shed() {
    double push = 0, free = 0, curvature = 0;  // E(s) = free s + ½ curvature s²
    T u[most_rows];
    for (const auto& span : island_)
      for (const Index i : span) {
        island_.velocity(span, i, u);
        const T *lambda = island_.impulse(span, i), *d = island_.free_of_impulses(span, i), *b = bias(span, i);
        for (int k = 0; k < span.pool->rows; ++k) {
          push -= double(lambda[k] * b[k]);
          free += double(lambda[k] * (d[k] - b[k]));
          curvature += double(lambda[k] * (u[k] - d[k]));
        }
      }
    const double allowed = std::max(0.0, push);
    if (!(free + 0.5 * curvature > allowed) || !(curvature > 0)) return;
    const double s = std::clamp((std::sqrt(free * free + 2 * curvature * allowed) - free) / curvature, 0.0, 1.0);
    T next[most_rows];
    for (const auto& span : island_)
      for (const Index i : span) {
        const T* lambda = island_.impulse(span, i);
        for (int k = 0; k < span.pool->rows; ++k) next[k] = lambda[k] + T(s - 1) * lambda[k];
        island_.assign(span, i, next);
      }
  }

  /// s, by E(s) = E_c + b s + a s² with δ = λ_N − λ_c, a = ½ δ·Wδ, b = δ·(u_c + ½ (u⁻ − u_free)), u_c the velocity after λ_c.
  double share() const {
    double a = 0, b = 0;
    T u[most_rows];
    std::size_t at = 0;
    for (const auto& span : island_)
      for (const Index i : span) {
        island_.velocity(span, i, u);
        const T *lambda = island_.impulse(span, i), *d = island_.free_of_impulses(span, i), *bias_of = bias(span, i);
        for (int k = 0; k < span.pool->rows; ++k, ++at) {
          const T velocity = u[k] - bias_of[k], delta = newton_[at] - lambda[k];
          a += 0.5 * double(delta * (velocity_[at] - velocity));
          b += double(delta * (velocity + T(0.5) * (start_[at] - (d[k] - bias_of[k]))));
        }
      }
    const double plain = energy(), room = std::max(0.0, plain) + returned() - plain;  // a s² + b s ≤ room
    if (!(a + b > room)) return 1;
    const double root = std::sqrt(std::max(0.0, b * b + 4 * a * room));
    return a > 0 ? std::clamp(b > 0 ? 2 * room / (b + root) : (root - b) / (2 * a), 0.0, 1.0) : 0;
  }

  Island<T>& island_;
  const Bounces<T>& bounces_;
  Array<T>&newton_, &velocity_;  ///< λ_N and its velocity without bias
  Array<T>& start_;  ///< u⁻
};

/// What laws with `restitution(item)` change: the bias, a solve that must not add energy, and what is remembered of both.
struct NewtonImpact {
  template <class P>
  struct State {
    using T = typename P::Rows::Scalar;
    /// Of one island that is being solved.
    struct Solved {
      Array<T> newton, newton_velocity, start;
    };
    Bounces<T> bounces;
    OwningArray<Solved> solved;  ///< by worker
    void memory(auto& archive) { archive(bounces); }
  };

  template <class Base>
  struct stages : Base {
    static void make_bias(auto& step) {
      Base::make_bias(step);
      using T = typename State<typename std::remove_reference_t<decltype(step)>::Policies>::T;
      auto& own = step.template state<NewtonImpact>();
      own.solved.resize(std::size_t(Base::workers(step)));
      for (auto& one : own.solved)
        for (auto* numbers : {&one.newton, &one.newton_velocity, &one.start}) numbers->reserve(std::size_t(step.rows.row_count()));
      const inner::BodyVelocities v(std::as_const(step).world());
      using World = std::remove_cvref_t<decltype(step.world())>;
      std::size_t counts[World::set_count + 1];
      step.world().each([&](const auto& set, auto s) {
        counts[s] = set.velocity().size() * (sizeof(set.velocity()[0]) / sizeof(T));
        own.bounces.look_at(set, s);
      });
      add_restitution(step.view, step.pools.all(), step.arrays.all(), step.islands, v.free, v.start, counts, World::set_count, step.h,
                      theta<std::remove_cvref_t<decltype(step.integrator())>>(), own.bounces);
    }
    static void solve_island(auto& step, auto& island) {
      Base::solve_island(step, island);
      auto& own = step.template state<NewtonImpact>();
      const auto report = step.reports[island.island()];
      auto& solved = own.solved[std::size_t(island.worker)];
      EnergyGuard<typename State<typename std::remove_reference_t<decltype(step)>::Policies>::T> guard(
          island, own.bounces, solved.newton, solved.newton_velocity, solved.start);
      const inner::BodyVelocities v(std::as_const(step).world());
      if (guard.asks_again(step.arrays.all(), v.start)) {
        Base::solve_island(step, island);
        guard.finish();
      }
      step.reports[island.island()] = report;
    }
    static void keep_impulses(auto& step) {
      remember_impulses(step.arrays.all(), step.template state<NewtonImpact>().bounces);
      Base::keep_impulses(step);
    }
    static void advance(auto& step) {
      const inner::BodyVelocities v(std::as_const(step).world());
      step.template state<NewtonImpact>().bounces.end(v.start);
      Base::advance(step);
    }
  };
};

}  // namespace delassus
