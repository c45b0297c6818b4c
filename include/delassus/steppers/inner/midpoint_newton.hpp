/// The equations of the midpoint rule with joints, by Newton's method: what `MidpointHold` solves once a step
/// or more.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/math/twist.hpp>
#include <delassus/rows/impulses.hpp>
#include <delassus/rows/soft.hpp>
#include <delassus/steppers/inner/direct_rows.hpp>
#include <delassus/solvers/solve_report.hpp>
#include <delassus/step/linearize.hpp>
#include <delassus/steppers/inner/equalities.hpp>
#include <delassus/steppers/inner/speed_of.hpp>

#include <algorithm>
#include <limits>
#include <tuple>
#include <type_traits>

namespace delassus {

/// Solves for the means z = (v̄, Ω̄) of all bodies and the impulses λ of all rows,
///
///   P(z) − h f − H(mean)ᵀ λ = 0,   φ(q₊(z)) + R λ + c = 0,
///
/// by δλ = −W⁻¹ (φ + R λ + c − H₊ C (P − h f − Hᵀλ)), W = H₊ C H(mean)ᵀ + R, C = ∂q₊/∂z (∂P/∂z − K)⁻¹:
/// `inner::DirectSystem` takes W, which is not symmetric. A soft row is λ = −h k (φ + φ₊)/2 − c (φ₊ − φ), φ
/// at the start. Source: docs/references.md, [SimoWong1991]; the quadratic invariants of Gauss' methods.
template <class World, class Laws, class Rows>
class MidpointNewton {
  template <class Set>
  using MidpointOf = typename Set::Midpoint;

 public:
  using T = typename Rows::Scalar;

  Impulses<Rows> impulses;  ///< the guess before `solve`, N·s of the step, and its result

  /// Finds z and λ of a step of h from where the bodies are, which stay there; `rows` is linearised at that
  /// place on entry.
  ///
  /// Rows that depend on each other only where all hold (Bricard's loop) contradict each other on the way
  /// there, by the square of what is missing. Where Newton's method fails it is begun again with ε in
  /// proportion to what is missing, which keeps such impulses small and the order of convergence. Source:
  /// [Levenberg1944], [YamashitaFukushima2001].
  template <class I>
  SolveReport solve(World& world, const Laws& laws, Rows& rows, const I& integrator, double h) {
    keep_start(rows);
    keep_rates(world, laws, rows);
    SolveReport report{.status = Status::max_iterations, .ended_by = "Newton"};
    for (const bool is_damped : {false, true}) {
      begin(world, integrator, h);
      iterate(world, laws, rows, integrator, h, is_damped,
              is_damped ? integrator.max_iterations : most_undamped, report);
      if (report.status != Status::max_iterations || is_cut_short(integrator, report)) break;
      if (!is_damped) impulses.set_zero();
    }
    return report;
  }

  /// Whether the joints were further apart where the last `solve` began than a solved step leaves them.
  template <class I>
  bool began_open(const I& integrator, double h) const {
    return apart_ > 10 * integrator.tolerance * h * speed_;
  }

  /// Ended by its own small number of factorizations, near enough to be taken.
  template <class I>
  static bool is_cut_short(const I& integrator, const SolveReport& report) {
    return integrator.max_iterations <= most_undamped && report.factorizations >= integrator.max_iterations &&
           report.measure.residual <= integrator.acceptable;
  }

  /// q ← q₊ and v ← v₊ of the bodies that move; the others go on with the velocity they have.
  void go(World& world, double h) {
    world.each([&](auto& set, auto s) {
      for (const Index b : set.active()) {
        if (set.moves(b))
          set.velocity()[b] = std::get<s>(bodies_).go(set.state(), b, T(h));
        else if (!is_zero(set.velocity()[b]))
          set.displace(b, T(h) * set.velocity()[b]);
      }
    });
  }

 protected:
  /// Whether the items of a law resist changes of their rate.
  template <int p>
  static constexpr bool resists = requires {
    requires std::remove_cvref_t<decltype(std::declval<const Laws&>().template pool<p>().law)>::resists;
  };

  /// Of rows that resist changes: their inertia, and their rate where the step begins.
  void keep_rates(World& world, const Laws& laws, const Rows& rows) {
    for_each_index<Rows::pool_count>([&](auto p) {
      if constexpr (resists<p>) {
        auto& inertia = inner::part<p>(inertia_.pools);
        inertia.resize(rows.template pool<p>().items());
        for (Index i = 0; i < rows.template pool<p>().items(); ++i) inertia[i][0] = T(laws.template pool<p>().item(i).inertia);
        rates<p>(world, rows, inner::part<p>(start_rate_.pools), [](auto& set, auto, Index b) -> const auto& { return set.velocity()[b]; });
      }
    });
  }
  /// The rates of `rows` where they were linearised, with the velocities that `of` says.
  template <int p, class Of>
  void rates(World& world, const Rows& rows, auto& to, const Of& of) {
    const auto& pool = rows.template pool<p>();
    to.resize(pool.items());
    for (auto& rate : to) rate.setZero();
    world.each([&](auto& set, auto s) {
      const auto& blocks = inner::part<s>(pool.sets);
      for (Index i = 0; i < pool.items(); ++i)
        for (Index e = blocks.offset[i]; e < blocks.offset[i + 1]; ++e) to[i] += blocks.H[e] * of(set, s, blocks.block[e]);
    });
  }
  /// The velocity of a body at q₊, where it is now; the unknowns have it, and `go` alone says it.
  auto end_velocity(auto& set, auto s, Index b, double h) {
    if (!set.moves(b)) return set.velocity()[b];
    auto& state = set.state();
    const auto x = state.x[b];
    const auto q = state.q[b];
    const auto R = state.R[b];
    const auto v = std::get<s>(bodies_).go(state, b, T(h));
    state.q[b] = q;
    state.turn(b);
    state.x[b] = x, state.R[b] = R;
    return v;
  }

  // `YieldingMidpoint` begins, iterates and assembles the same equations
  static constexpr int most_undamped = 10;

  /// φ where the step begins; no row yields.
  void keep_start(const Rows& rows) {
    apart_ = Equalities<Rows>::worst(rows);
    for (auto* all : {&start_, &yield_}) all->resize_like(rows);
    for_each_index<Rows::pool_count>([&](auto p) {
      inner::part<p>(start_.pools) = rows.template pool<p>().phi;
      for (auto& x : inner::part<p>(yield_.pools)) x.setZero();
    });
  }

  template <class I>
  void iterate(World& world, const Laws& laws, Rows& rows, const I& integrator, double h, bool is_damped,
               int most, SolveReport& report) {
    double first = 0, last = std::numeric_limits<double>::infinity();
    const double of_places = inner::rounding_of_places<T>(world, laws, rows) / (h * (speed_ > 0 ? speed_ : 1));
    int slow = 0;
    for (int k = 0;; ++k) {
      linearize_both(world, laws, rows, h);
      const double size = balance(world, rows, h);
      if (k == 0) first = size;
      report.measure.residual = size;
      const double of_load = 64 * std::numeric_limits<T>::epsilon() * load_;
      report.measure.floor = std::max(of_load, of_places);
      // What bodies and what rows miss may fall by turns: one slow step is a sign of rounding only near it.
      slow = size > 0.5 * last && size <= std::max(1e-7, of_places) ? slow + 1 : 0;
      if (size <= integrator.tolerance)
        report.status = Status::converged;
      else if ((size <= of_load && std::isfinite(load_)) || slow >= (size <= 100 * of_load ? 1 : 2))
        report.status = Status::stalled;
      // The first step from a poor λ may throw light bodies far: by the ratio of the masses.
      const bool is_lost = !(size <= 1e12 * first) || k == std::min(most, integrator.max_iterations);
      if (report.status != Status::max_iterations || is_lost) return;
      last = size;
      ++report.factorizations;
      differentiate(world, laws, rows, h);
      if (!improve(world, rows, is_damped ? std::clamp(1e-2 * size / first, 1e-9, 1e-2) : 1e-12)) return;
    }
  }

  template <class I>
  void begin(World& world, const I& integrator, double h) {
    speed_ = 0;
    world.each([&](auto& set, auto s) {
      auto& body = std::get<s>(bodies_);
      auto& force = std::get<s>(force_);
      body.resize(std::size_t(set.blocks()));
      force.resize(set.blocks());
      for (auto& f : force) f.setZero();
      integrator.impulse(set, force, h);
      for (const Index b : set.active()) {
        body.begin(set.state(), b, set.velocity()[b], set.moves(b), T(h));
        speed_ = std::max(speed_, inner::speed_of(set, b, set.velocity()[b]));
        if (set.moves(b))
          speed_ = std::max(speed_, double(linear_part(set.template solve_block<1>(b, force[b])).norm()));
      }
    });
  }

  /// φ and H at q₊ into `rows`, H at the mean into `middle_`.
  void linearize_both(World& world, const Laws& laws, Rows& rows, double h) {
    const auto place = [&](auto&& put) {
      world.each([&](auto& set, auto s) {
        for (const Index b : set.active()) put(std::get<s>(bodies_), set.state(), b);
      });
    };
    place([&](auto& bodies, auto& state, Index b) { bodies.to_end(state, b, T(h)); });
    linearize(world, laws, rows);
    for_each_index<Rows::pool_count>([&](auto p) {
      if constexpr (resists<p>)
        rates<p>(world, rows, inner::part<p>(end_rate_.pools), [&](auto& set, auto s, Index b) { return end_velocity(set, s, b, h); });
    });
    place([&](auto& bodies, auto& state, Index b) { bodies.to_middle(state, b, T(h)); });
    linearize(world, laws, middle_);
    place([&](auto& bodies, auto& state, Index b) { bodies.back(state, b); });
    match_work(world, rows, h);
  }
  /// What springs and rotors take from the bodies is what they store: their rows at the mean are stretched so that h H z is φ₊ − φ, or H z
  /// the mean rate. That is a discrete gradient, of second order. Newton's matrix does not see how the stretch changes. Source:
  /// docs/references.md, [Gonzalez1996].
  void match_work(World& world, const Rows& rows, double h) {
    each_pool(rows, [&](auto p, const auto& pool) {
      for (Index i = 0; i < pool.items(); ++i)
        for (int k = 0; k < pool.rows; ++k) {
          if (!resists<p> && !inner::is_spring(pool.stiffness[i][k], pool.damping[i][k])) continue;
          const double phi = double(pool.phi[i][k]);
          // The least is where rounding of `wanted` would begin to tell.
          if constexpr (resists<p>)
            stretch<p>(world, i, k, 0.5 * double(inner::part<p>(start_rate_.pools)[i][k] + inner::part<p>(end_rate_.pools)[i][k]), 1e-6);
          else
            stretch<p>(world, i, k, (phi - double(inner::part<p>(start_.pools)[i][k])) / h, 1e-6 * (1 + std::abs(phi)) / h);
        }
    });
  }
  /// Row k of item i at the mean, so that it sees the rate `wanted`; one that sees less than `least` is left as it is.
  template <int p>
  void stretch(World& world, Index i, int k, double wanted, double least) {
    auto& pool = middle_.template pool<p>();
    double seen = 0;
    world.each([&](auto&, auto s) {
      const auto& blocks = inner::part<s>(pool.sets);
      for (Index e = blocks.offset[i]; e < blocks.offset[i + 1]; ++e)
        seen += double((blocks.H[e].row(k) * std::get<s>(bodies_).mean(blocks.block[e]))[0]);
    });
    const double factor = wanted / seen;
    if (!(std::abs(seen) > least) || !(factor > 0.5 && factor < 2)) return;
    world.each([&](auto&, auto s) {
      auto& blocks = inner::part<s>(pool.sets);
      for (Index e = blocks.offset[i]; e < blocks.offset[i + 1]; ++e) blocks.H[e].row(k) *= T(factor);
    });
  }

  /// P − h f − Hᵀλ, and φ + R λ + c; returns the largest of both, in units of
  /// the speed.
  double balance(World& world, Rows& rows, double h) {
    double most = 0, spoilt = 0;
    load_ = 0;
    impulse_ = force_;
    each_pool(rows, [&](auto p, auto& pool) {
      for (Index i = 0; i < pool.items(); ++i) {
        const auto& lambda = inner::part<p>(impulses.pools)[i];
        world.each([&](auto& set, auto s) {
          each_push<p>(set, s, i, lambda, [&](Index b, const auto& by) {
            std::get<s>(impulse_)[b] += by;
            load_ = std::max(load_, double(linear_part(by).norm() / set.mass(b)));
          });
        });
        for (int k = 0; k < pool.rows; ++k) {
          pool.compliance[i][k] = inner::part<p>(yield_.pools)[i][k];
          if constexpr (resists<p>) {  // λ + I (u₊ − u) = 0, in the unit of φ
            pool.compliance[i][k] = T(h / 2) / inner::part<p>(inertia_.pools)[i][k];
            pool.bias[i][k] = pool.compliance[i][k] * lambda[k] +
                              T(h / 2) * (inner::part<p>(end_rate_.pools)[i][k] - inner::part<p>(start_rate_.pools)[i][k]);
          } else {
            soften(pool, i, k, double(inner::part<p>(start_.pools)[i][k]), h);
            pool.bias[i][k] += pool.phi[i][k] + pool.compliance[i][k] * lambda[k];
          }
          most = std::max(most, std::abs(double(pool.bias[i][k])) / h);
        }
      }
    });
    world.each([&](auto& set, auto s) {
      for (const Index b : set.active())
        if (set.moves(b)) {
          const double missing =
              double(std::get<s>(bodies_).balance(set.state(), b, std::get<s>(impulse_)[b]));
          most = std::max(most, missing);
          spoilt += 0 * missing;  // NaN for one that is no number, which a maximum would lose
        }
    });
    const double unit = speed_ > 0 ? speed_ : 1;
    load_ /= unit;
    return most / unit + spoilt;
  }
  /// f(b, Hᵀλ) for the ends of item i that move.
  template <int p, class Set, class S, class Lambda, class F>
  void each_push(const Set& set, S s, Index i, const Lambda& lambda, F&& f) {
    const auto& blocks = inner::part<s>(middle_.template pool<p>().sets);
    for (Index e = blocks.offset[i]; e < blocks.offset[i + 1]; ++e) {
      const Index b = blocks.block[e];
      if (!set.moves(b)) continue;
      f(b, typename Set::Velocity(blocks.H[e].transpose() * lambda));
    }
  }
  /// The matrices of the bodies where `balance` was: the force at each end of an item stiffens its body.
  void differentiate(World& world, const Laws& laws, const Rows& rows, double h) {
    each_pool(rows, [&](auto p, const auto& pool) {
      for (Index i = 0; i < pool.items(); ++i)
        world.each([&](auto& set, auto s) {
          each_push<p>(set, s, i, inner::part<p>(impulses.pools)[i], [&](Index b, const auto& by) {
            each_end(laws.template pool<p>().item(i), [&](const Anchor& end) {
              if (end.set == s && end.block == b)
                std::get<s>(bodies_).stiffen(b, linear_part(by), end.local.template cast<T>(), T(h));
            });
          });
        });
    });
    world.each([&](auto& set, auto s) {
      for (const Index b : set.active())
        if (set.moves(b)) std::get<s>(bodies_).differentiate(set.state(), b, T(h));
    });
  }
  /// R and c of a soft row, in `bias`; λ (h k/2 + c)⁻¹ + φ₊ + φ (h k/2 − c)/(h k/2 + c) = 0.
  template <class Pool>
  static void soften(Pool& pool, Index i, int k, double start, double h) {
    const double stiffness = h / 2 * double(pool.stiffness[i][k]), damping = double(pool.damping[i][k]);
    if (!inner::is_spring(stiffness, damping)) return;
    pool.compliance[i][k] = T(1 / (stiffness + damping));
    pool.bias[i][k] = T(start * (stiffness - damping) / (stiffness + damping));
  }

  /// One step of Newton's method; false when its matrix is singular.
  bool improve(World& world, Rows& rows, double epsilon) {
    assemble(world, rows, [&](const auto&, auto s, Index b, const auto& X) {
      return std::get<s>(bodies_).answer(b, X);
    });
    if (!system_.factor(epsilon)) return false;
    system_.load([&](auto p, Index i) { return gap<p>(world, rows, i); });
    system_.solve();
    change_by(world);
    return true;
  }
  /// W = H₊ answer(set, s, b, H(mean)ᵀ) of where the last `balance` was.
  template <class Answer>
  void assemble(World& world, Rows& rows, const Answer& answer) {
    inner::answer_ends(world, rows, middle_, answer);
    system_.take_all(rows);
    system_.analyse(0);
  }
  /// φ + R λ + c − H₊ C (P − h f − Hᵀλ).
  template <int p>
  Vec<Rows::template rows_of<p>, T> gap(const World& world, const Rows& rows, Index i) const {
    const auto& pool = rows.template pool<p>();
    Vec<Rows::template rows_of<p>, T> r = pool.bias[i];
    world.each([&](const auto& set, auto s) {
      const auto& blocks = inner::part<s>(pool.sets);
      for (Index e = blocks.offset[i]; e < blocks.offset[i + 1]; ++e)
        if (set.moves(blocks.block[e]))
          r.noalias() -= blocks.H[e] * std::get<s>(bodies_).answer_to_missing(blocks.block[e]);
    });
    return r;
  }
  /// λ and z after δλ.
  void change_by(World& world) {
    world.each([&](const auto&, auto s) {
      for (auto& x : std::get<s>(impulse_)) x.setZero();
    });
    system_.each([&](auto p, Index k) {
      const Index i = system_.node(k).item;
      Vec<Rows::template rows_of<p>, T> change;
      for (int r = 0; r < change.size(); ++r) change[r] = T(system_.answer(k)[r]);
      inner::part<p>(impulses.pools)[i] += change;
      for_each_index<Rows::set_count>([&](auto s) {
        const auto& blocks = inner::part<s>(middle_.template pool<p>().sets);
        for (Index e = blocks.offset[i]; e < blocks.offset[i + 1]; ++e)
          std::get<s>(impulse_)[blocks.block[e]].noalias() += blocks.H[e].transpose() * change;
      });
    });
    world.each([&](auto& set, auto s) {
      for (const Index b : set.active())
        if (set.moves(b)) std::get<s>(bodies_).move(set.state(), b, std::get<s>(impulse_)[b]);
    });
  }

  typename World::template PerSet<MidpointOf> bodies_;
  typename World::template PerSet<VelocitiesOf> force_, impulse_;
  Rows middle_;
  Impulses<Rows> start_, yield_;
  Impulses<Rows> inertia_, start_rate_, end_rate_;  ///< of rows that resist changes of their rate
  inner::DirectRows<Rows> system_;
  double apart_ = 0, speed_ = 0, load_ = 0;  ///< load: of the impulses over the masses, in units of the speed
};

}  // namespace delassus
