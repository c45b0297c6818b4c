/// Newton's impact law in a step: restitution of rows that close.
#pragma once

#include <delassus/constraints/constraints.hpp>
#include <delassus/constraints/rebound.hpp>
#include <delassus/constraints/row_past.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/owning_array.hpp>
#include <delassus/rows/islands.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/theta.hpp>
#include <delassus/rows/world_view.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>

namespace delassus {
/// What restitution does to the rows of a step, and what it remembers for the next one. Lists by pool and row.
template <class T>
struct Bounces {
  OwningArray<Array<T>> added;     ///< to the bias, m/s
  OwningArray<Array<T>> returned;  ///< to the bodies, of what they lost as they landed, J; empty: nothing in this pool
  RowPasts pasts;
  Array<std::size_t> rows;  ///< of `pasts.now()`, in their pools
  Array<Index> blocks;      ///< of each island; empty: nobody asked

  void begin(std::size_t pools, double h) {
    for (auto* list : {&added, &returned}) list->clear(), list->resize(pools);
    pasts.begin(h);
    rows.clear();
    blocks.clear();
  }
  /// Whether nothing else that moves is in the island of the item.
  bool is_alone(const Islands<T>& islands, int p, Index i) {
    if (blocks.empty()) islands.count_blocks(blocks);
    const Index island = islands.island_of(p, i);
    return island >= 0 && blocks[island] == 1;
  }
};

namespace inner {

/// A row with e > 0 in this step and in the last one, opening positive.
struct BouncingRow {
  double gap, velocity, free;  ///< free: the velocity without impulses
  double h, last_h, theta;
  const RowPast* past;  ///< null: it was not there

  /// Of joints and neighbours the free motion knows nothing, the last two velocities do. Where the row pushed between them, this is
  /// what it was before. Infinite of a new row.
  double last_acceleration() const {
    if (!past) return std::numeric_limits<double>::infinity();
    return past->impulse > 0 ? past->acceleration : (velocity - past->velocity) / last_h;
  }
  /// The smaller one of the last two: an impact elsewhere, or a host who sets a velocity, is in one of them alone.
  double acceleration(double last) const {
    if (!past) return (free - velocity) / h;
    return std::abs(past->last) < std::abs(last) ? past->last : last;
  }
  /// For θ = 1, v is the velocity of the middle of the last step, and moves the row. For θ = ½ it is that of the end, and the mean
  /// with u moves the row.
  double now(double acceleration) const { return velocity + (theta - 0.5) * last_h * acceleration; }
  double height(double acceleration) const { return gap + (1 - theta) * (h * velocity + 0.25 * h * h * acceleration); }
  bool closes(double acceleration) const { return velocity < 0 && gap + h * (velocity + h * acceleration) < 0; }
  Closing closing(double acceleration, bool may_land) const {
    const double a = std::min(0.0, acceleration), fall = std::max(std::max(0.0, velocity - free), -h * a);
    return {.gap = gap, .velocity = now(a), .acceleration = a, .height = height(a), .least = 0.5 * fall, .h = h, .may_land = may_land};
  }
  /// The energy that its impulse took from the bodies as it landed, J.
  double taken() const { return std::max(0.0, -0.5 * past->impulse * (past->free + velocity)); }
  /// It fell into an overlap and does not bounce: it comes back to the surface, with no more than falling for a step gives.
  double comes_back(double acceleration) const {
    const bool flew = !past || !(past->impulse > 0);
    return flew && gap < 0 ? std::min(-gap / h, -h * std::min(0.0, acceleration)) : 0;
  }
};

}  // namespace inner

/// A row with a bound (`RowKind::lower` or `upper`) that closes within the step gets the stronger of what `rebound` says and the
/// push-out speed, never their sum. A row lands only where a body is alone in its island and moves by the velocity that the row
/// is about (θ = 1): in towers landings would be impacts of their own.
template <class Laws, class Rows, class T>
void add_restitution(const WorldView<T>& world, Laws laws, Rows rows, const Islands<T>& islands, const T* const* v_free, const T* const* v, double h, double theta,
                     Bounces<T>& bounces) {
  bounces.begin(rows.size(), h);
  for (std::size_t p = 0; p < rows.size(); ++p) {
    const auto& pool = rows[p];
    const auto& law = *laws[p].law;
    Array<T>&added = bounces.added[p], &returned = bounces.returned[p];
    added.assign_zeros(pool.phi->size());
    if (!law.restitution) continue;
    T free[most_rows], start[most_rows];
    for (Index i = 0; i < pool.items(); ++i) {
      const double restitution = law.restitution(laws[p].pool, i);
      if (!(restitution > 0)) continue;
      const ItemName name = law.name(laws[p].pool, world, i);
      for (int k = 0; k < pool.rows; ++k) free[k] = start[k] = T(0);
      for (int s = 0; s < pool.sets; ++s) {
        pool.set[s].products->rate(pool.set[s], i, v_free[s], free, free);
        pool.set[s].products->rate(pool.set[s], i, v[s], start, start);
      }
      for (int k = 0; k < pool.rows; ++k) {
        const std::size_t row = std::size_t(i) * std::size_t(pool.rows) + std::size_t(k);
        if (law.kinds[k] != RowKind::lower && law.kinds[k] != RowKind::upper) continue;
        if (pool.is_soft(row)) continue;
        const double sign = law.kinds[k] == RowKind::lower ? 1 : -1, phi = sign * double((*pool.phi)[row]);
        const double plain = sign * double((*pool.bias)[row]);
        const std::uint32_t place = std::uint32_t(most_rows) * std::uint32_t(p) + std::uint32_t(k);
        const inner::BouncingRow is{phi, sign * double(start[k]), sign * double(free[k]), h, bounces.pasts.last_h(), theta, bounces.pasts.find(name, place)};
        RowPast& now = bounces.pasts.add(name, place);
        bounces.rows.push_back(row);
        now.velocity = is.velocity, now.free = is.free, now.last = is.last_acceleration(), now.acceleration = is.acceleration(now.last);
        double leaves = 0;
        if (is.past && is.past->parts > 0) {
          leaves = is.past->parts + 0.5 * h * std::min(0.0, is.past->acceleration);
          if (!(leaves > 0)) continue;
          if (returned.empty()) returned.assign_zeros(pool.phi->size());
          returned[row] = T(is.taken());
        } else if (is.closes(now.acceleration)) {
          const Rebound does = rebound(is.closing(now.acceleration, theta == 1 && bounces.is_alone(islands, int(p), i)), restitution);
          now.parts = does.parts;
          leaves = does.leaves > 0 || does.parts > 0 ? does.leaves : is.comes_back(now.acceleration);
        }
        if (!(leaves > 0)) continue;
        const double bias = std::min(phi < 0 ? plain : 0.0, -leaves);
        added[row] = T(sign * (bias - plain));
        (*pool.bias)[row] = T(sign * bias);
        (*pool.d)[row] = free[k] + (*pool.bias)[row];
      }
    }
  }
}

/// After the solve.
template <class Rows, class T>
void remember_impulses(Rows rows, Bounces<T>& bounces) {
  for (std::size_t i = 0; i < bounces.rows.size(); ++i) {
    RowPast& row = bounces.pasts.now()[i];
    row.impulse = std::abs(double((*rows[row.row / most_rows].lambda)[bounces.rows[i]]));
  }
}

/// A solver's, which takes its pools from what `rows/` shows.
template <class T>
class Island;

/// Newton's restitution on several contacts with friction can add energy. Where it did, λ becomes λ_c + s (λ_N − λ_c).
/// With restitution the solution is λ_N, without λ_c. Of s in [0, 1] it is the largest for which the impulses add no more
/// energy than those of λ_c do, and than is returned of what was lost as rows landed. Both lie in the cone, which is convex, so λ does.
template <class T>
class EnergyGuard {
 public:
  EnergyGuard(Island<T>& island, const Bounces<T>& bounces, Array<T>& newton, Array<T>& newton_velocity)
      : island_(island), bounces_(bounces), newton_(newton), velocity_(newton_velocity) {}

  /// After a solve that converged: whether to solve anew, from the λ there is, and then to `finish`.
  bool asks_again() {
    if (!has_bounced() || !(energy() > returned())) return false;
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

  /// The energy that the impulses give the bodies, J: Σ ½ λ·(u_free + u⁺), u without bias.
  double energy() const {
    double sum = 0;
    T u[most_rows];
    for (const auto& span : island_)
      for (const Index i : span) {
        island_.velocity(span, i, u);
        const T *lambda = island_.impulse(span, i), *d = island_.free_of_impulses(span, i), *b = bias(span, i);
        for (int k = 0; k < span.pool->rows; ++k) sum += 0.5 * double(lambda[k]) * double(d[k] + u[k] - b[k] - b[k]);
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

  /// s, by E(s) = E_c + b s + a s² with δ = λ_N − λ_c, a = ½ δ·Wδ, b = δ·u_c, u_c the velocity after λ_c.
  double share() const {
    double a = 0, b = 0;
    T u[most_rows];
    std::size_t at = 0;
    for (const auto& span : island_)
      for (const Index i : span) {
        island_.velocity(span, i, u);
        const T* lambda = island_.impulse(span, i);
        for (int k = 0; k < span.pool->rows; ++k, ++at) {
          const T velocity = u[k] - bias(span, i)[k], delta = newton_[at] - lambda[k];
          a += 0.5 * double(delta * (velocity_[at] - velocity));
          b += double(delta * velocity);
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
};

/// What laws with `restitution(item)` change: the bias, and a solve that must not add energy.
struct NewtonImpact {
  template <class P>
  struct State {
    using T = typename P::Rows::Scalar;
    Bounces<T> bounces;
    Array<T> newton, newton_velocity;
    void memory(auto& archive) { archive(bounces.pasts); }
  };

  template <class Base>
  struct stages : Base {
    static void make_bias(auto& step) {
      Base::make_bias(step);
      auto& own = step.template state<NewtonImpact>();
      for (auto* numbers : {&own.newton, &own.newton_velocity}) numbers->reserve(std::size_t(step.rows.row_count()));
      const inner::BodyVelocities v(std::as_const(step).world());
      add_restitution(step.view, step.pools.all(), step.arrays.all(), step.islands, v.free, v.start, step.h,
                      theta<std::remove_cvref_t<decltype(step.integrator())>>(), own.bounces);
    }
    static void solve_island(auto& step, auto& island) {
      Base::solve_island(step, island);
      auto& own = step.template state<NewtonImpact>();
      const auto report = step.reports[island.island()];
      EnergyGuard<typename State<typename std::remove_reference_t<decltype(step)>::Policies>::T> guard(island, own.bounces, own.newton,
                                                                                                     own.newton_velocity);
      if (guard.asks_again()) {
        Base::solve_island(step, island);
        guard.finish();
      }
      step.reports[island.island()] = report;
    }
    static void keep_impulses(auto& step) {
      remember_impulses(step.arrays.all(), step.template state<NewtonImpact>().bounces);
      Base::keep_impulses(step);
    }
  };
};

}  // namespace delassus
