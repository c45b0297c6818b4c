/// A whole step of the classical Runge-Kutta method with its joints: for `RungeKutta4`.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/math/twist.hpp>
#include <delassus/rows/impulses.hpp>
#include <delassus/rows/rate.hpp>
#include <delassus/solvers/solve_report.hpp>
#include <delassus/steppers/inner/equalities.hpp>
#include <delassus/steppers/inner/leave_step.hpp>
#include <delassus/steppers/inner/speed_of.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <tuple>

namespace delassus {

/// Four stages of q̇ = v, v̇ = a with the accelerations that the joints allow (index 1),
///
///   a = M⁻¹ (f + Hᵀ λ),   H a + Ḣ v = 0,
///
/// f with the gyroscopic moment; then q₊ and v₊ are brought onto φ = 0 and H v = 0 along M⁻¹ Hᵀ. Ḣ v is a
/// central difference of H v along the motion: its error changes λ alone, so it leaves what the joints allow
/// untouched, and the projection takes away the rest. Source: [HairerWanner1996], chapter VII.2; orientations
/// as four numbers, made unit.
template <class World, class Laws, class Rows>
class RungeKuttaStep {
 public:
  using T = typename Rows::Scalar;

  /// Leaves q₊ and v_next in the sets and the impulses of the step in `rows`.
  template <class I>
  SolveReport solve(World& world, const Laws& laws, Rows& rows, const I& integrator, double h) {
    SolveReport report{.status = Status::max_iterations, .ended_by = "Newton"};
    begin(world, rows, integrator, h);
    inner::BackUnlessDone back(world, paths_);
    constexpr std::array node{0.0, 0.5, 0.5, 1.0}, weight{1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
    for (int k = 0; k < 4; ++k) {
      world.each([&](auto& set, auto s) {
        for (const Index b : set.active())
          set.velocity()[b] = std::get<s>(paths_).to_stage(set.state(), b, T(node[k] * h), set.moves(b));
      });
      accelerate(world, laws, rows, integrator, h, h * weight[k], report);
      world.each([&](auto& set, auto s) {
        for (const Index b : set.active())
          if (set.moves(b))
            std::get<s>(paths_).note_slope(set.state(), b, set.velocity()[b], std::get<s>(a_)[b],
                                           T(weight[k]));
      });
    }
    world.each([&](auto& set, auto s) {
      for (const Index b : set.active()) {
        set.v_next[b] = std::get<s>(paths_).to_end(set.state(), b, T(h), set.moves(b));
        set.velocity()[b] = std::get<s>(paths_).start_velocity(b);
      }
    });
    project(world, laws, rows, integrator, h, report);
    lambda_.give_to(rows);
    inner::keep_or_leave(world, laws, rows, integrator, equalities_, paths_, h * speed_, report);
    back.is_done = true;
    return report;
  }

 private:
  template <class I>
  void begin(World& world, Rows& rows, const I& integrator, double h) {
    speed_ = 0;
    lambda_.resize_like(rows);
    lambda_.set_zero();
    world.each([&](auto& set, auto s) {
      set.factor(integrator.scale(h));
      auto& path = std::get<s>(paths_);
      path.resize(std::size_t(set.blocks()));
      std::get<s>(a_).resize(set.blocks());
      for (const Index b : set.active()) path.begin(set.state(), b, set.velocity()[b]);
    });
  }

  /// a where q and v are now; λ counts by `share` (s) in the impulses.
  template <class I>
  void accelerate(World& world, const Laws& laws, Rows& rows, const I& integrator, double h, double share,
                  SolveReport& report) {
    world.each([&](auto& set, auto s) {
      auto& a = std::get<s>(a_);
      for (auto& x : a) x.setZero();
      integrator.impulse(set, a, 1);
      for (const Index b : set.active()) {
        const auto& v = set.velocity()[b];
        speed_ = std::max(speed_, inner::speed_of(set, b, v));
        if (set.moves(b)) {
          a[b] += std::get<s>(paths_).gyroscopic(set.state(), b, v);
          a[b] = set.template solve_block<1>(b, a[b]);
          speed_ = std::max(speed_, h * double(linear_part(a[b]).norm()));
        } else {
          a[b].setZero();
        }
      }
    });
    if constexpr (Rows::pool_count > 0) {
      turn_directions(world, laws, rows, h);
      linearize(world, laws, rows);
      world.each([&](const auto& set, auto s) { inner::apply_inverse_to_all(set, rows, s); });
      Equalities<Rows>::pull(world, rows, force_, 1);
      lambda_.add(force_, T(share));
      const auto a_of = [this](auto s) -> auto& { return std::get<s>(a_); };
      Equalities<Rows>::push_all(rows, force_, a_of);
      ++report.factorizations;
      if (!equalities_.factor(rows)) return;
      for (int pass = 0; pass < 2; ++pass)  // the second takes out the error of ε
        equalities_.solve(
            rows, [&](auto p, Index i) { return missing<p>(rows, i); },
            [&](auto p, Index i, const auto& force) {
              inner::part<p>(lambda_.pools)[i] += T(share) * force;
              Equalities<Rows>::template push<p>(rows, i, force, a_of);
            });
    }
  }
  /// Ḣ v into `turned_`: (H(q ⊕ e v) − H(q ⊖ e v)) v/(2 e), e a thousandth of the step.
  void turn_directions(World& world, const Laws& laws, Rows& rows, double h) {
    const double e = 1e-3 * h;
    const auto look = [&](double t) {
      world.each([&](auto& set, auto s) {
        for (const Index b : set.active())
          std::get<s>(paths_).look_along(set.state(), b, set.velocity()[b], T(t));
      });
    };
    world.each([&](auto& set, auto s) {
      for (const Index b : set.active()) std::get<s>(paths_).keep_stage(set.state(), b);
    });
    turned_.resize_like(rows);
    for (const double side : {-1.0, 1.0}) {
      look(side * e);
      linearize(world, laws, rows);
      each_pool(rows, [&](auto p, const auto& pool) {
        auto& out = inner::part<p>(turned_.pools);
        for (Index i = 0; i < pool.items(); ++i) {
          const auto u = inner::rate(
              pool, i, world, [](const auto& set) -> const auto& { return set.velocity(); });
          if (side < 0)
            out[i] = -u;
          else
            out[i] = (out[i] + u) * T(0.5 / e);
        }
      });
    }
    look(0);
  }
  /// H a + Ḣ v of an item.
  template <int p>
  Vec<Rows::template rows_of<p>, T> missing(const Rows& rows, Index i) const {
    Vec<Rows::template rows_of<p>, T> r = inner::part<p>(turned_.pools)[i];
    for_each_index<World::set_count>([&](auto s) {
      const auto& blocks = inner::part<s>(rows.template pool<p>().sets);
      for (Index e = blocks.offset[i]; e < blocks.offset[i + 1]; ++e)
        r.noalias() += blocks.H[e] * std::get<s>(a_)[blocks.block[e]];
    });
    return r;
  }

  /// Newton's method for φ(q) = 0 along M⁻¹ Hᵀ, then H v = 0.
  template <class I>
  void project(World& world, const Laws& laws, Rows& rows, const I& integrator, double h,
               SolveReport& report) {
    if constexpr (Rows::pool_count == 0) {
      report.status = Status::converged;
    } else {
      const double unit = h * (speed_ > 0 ? speed_ : 1), near = std::max(1e-7, inner::rounding_of_places<T>(world, laws, rows) / unit);
      const int first = report.factorizations;
      for (double last = std::numeric_limits<double>::infinity();;) {
        linearize(world, laws, rows);
        world.each([&](const auto& set, auto s) { inner::apply_inverse_to_all(set, rows, s); });
        const double size = Equalities<Rows>::worst(rows) / unit;
        report.measure.residual = size;
        if (size <= integrator.tolerance)
          report.status = Status::converged;
        else if (size > 0.5 * last && size <= near)
          report.status = Status::stalled;
        ++report.factorizations;
        if (!equalities_.factor(rows)) return;
        if (report.status != Status::max_iterations ||
            report.factorizations - first > integrator.max_iterations)
          break;
        last = size;
        equalities_.solve(
            rows, [&](auto p, Index i) { return rows.template pool<p>().phi[i]; },
            [&](auto p, Index i, const auto& change) {
              world.each([&](auto& set, auto s) {
                const auto& blocks = inner::part<s>(rows.template pool<p>().sets);
                for (Index e = blocks.offset[i]; e < blocks.offset[i + 1]; ++e)
                  if (set.moves(blocks.block[e])) set.displace(blocks.block[e], blocks.G[e] * change);
              });
            });
      }
      for (int pass = 0; pass < 2; ++pass)
        equalities_.solve(
            rows, [&](auto p, Index i) { return inner::next_rate(rows.template pool<p>(), i, world); },
            [&](auto p, Index i, const auto& change) {
              Equalities<Rows>::template push<p>(rows, i, change, inner::next_of(world));
            });
    }
  }

  typename World::template PerSet<inner::PathOf> paths_;
  typename World::template PerSet<VelocitiesOf> a_;
  Impulses<Rows> lambda_, force_, turned_;
  Equalities<Rows> equalities_;
  double speed_ = 0;
};

}  // namespace delassus
