/// Joints one by one: each is linearised, solved, and answered by its bodies before the next is looked at.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/unrolled.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/schemes/inner/item_rows.hpp>
#include <delassus/schemes/inner/joint_visit.hpp>
#include <delassus/schemes/inner/point_visit.hpp>
#include <delassus/solvers/inner/length_of_island.hpp>
#include <delassus/solvers/solve_report.hpp>
#include <delassus/step/linearize.hpp>
#include <delassus/step/move_freely.hpp>
#include <delassus/step/notify.hpp>
#include <delassus/step/solve.hpp>
#include <delassus/step/stage.hpp>
#include <delassus/step/step_report.hpp>
#include <delassus/step/warm_start.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <tuple>
#include <type_traits>
#include <utility>

namespace delassus {
namespace inner {

template <class Laws>
inline constexpr bool has_turns = true;
template <class... Laws>
inline constexpr bool has_turns<Constraints<Laws...>> = ((turning_rows<Laws>() != 0) || ...);

}  // namespace inner

/// The visits of a step:
///
///   λ_i ← λ_i − (W_ii + R_i)⁻¹ (H_i v + bias_i + R_i λ_i),   v ← v + A⁻¹ H_iᵀ Δλ_i,   i = 1 … n,
///
/// the sweep of Gauss and Seidel with v in the place of W λ + d. Where no two joints hold one moving body,
/// one visit is exact and λ begins at zero; elsewhere it begins with that of the last step, and what the
/// visits leave is measured once more. Nothing is kept of a joint between its visits.
template <class World, class Laws>
class JointVisits {
  static constexpr bool can_turn = inner::has_turns<Laws>;

 public:
  /// Leaves v_next, which is v_free on entry, and the impulses of the joints. `scheme` says `sweeps` and
  /// `tolerance`.
  void run(World& world, Laws& laws, const auto& stabilisation, double h, double step_ratio,
           const auto& scheme, StepReport& step, SolveReport& solved) {
    begin(world);
    const bool were_shared = std::exchange(are_shared_, false);
    Sums sums = were_shared ? begin_with_last(world, laws, stabilisation, h, step_ratio)
                            : visit_alone(world, laws, stabilisation, h);
    step.rows = sums.rows;
    step.max_joint_violation = std::max(step.max_joint_violation, sums.violation);
    solved.sweeps = were_shared ? 0 : 1;
    solved.ended_by = "visits";
    if (were_shared || are_shared_) [[unlikely]] {
      for (; solved.sweeps < scheme.sweeps; ++solved.sweeps) sweep(world, laws, stabilisation, h);
      sums = measure(world, laws, stabilisation, h);
    }
    sums.give(solved.measure);
    const bool is_met = solved.measure.residual <= scheme.tolerance, is_exact = !were_shared && !are_shared_;
    solved.status = is_met ? Status::converged : is_exact ? Status::stalled : Status::max_iterations;
  }

  /// What outlives a step.
  void memory(auto& archive) { archive(are_shared_); }

 private:
  /// What is measured of rows in one unit: squares of the velocities, of what is left, and of the impulses.
  struct Squares {
    double d = 0, u = 0, lambda = 0, worst = 0;
  };
  /// The same of rows in m/s and of those in rad/s, which `Measure` counts at the length L.
  struct Sums {
    Squares motion, turn;
    inner::LengthOfRows length;
    double violation = 0;  ///< m or rad, at the start
    Index rows = 0;

    template <unsigned turns, int R>
    void add(const Vec<R>& d, const Vec<R>& u, const Vec<R>& lambda, const auto& visit) {
      double own[2] = {};
      unrolled<R>([&]<int k>() {
        constexpr bool is_turn = turns >> k & 1;
        Squares& of = is_turn ? turn : motion;
        of.d += d[k] * d[k];
        own[is_turn] += u[k] * u[k];
        of.lambda += lambda[k] * lambda[k];
        if constexpr (can_turn) length.add(is_turn, visit.own(k));
      });
      motion.u += own[0], turn.u += own[1];
      motion.worst = std::max(motion.worst, own[0]);
      turn.worst = std::max(turn.worst, own[1]);
    }
    /// All in m/s. `worst` is no less than it is where one joint has rows of either unit.
    Squares all() const {
      if constexpr (!can_turn) return motion;
      const double square = length.square();
      return {motion.d + square * turn.d, motion.u + square * turn.u, motion.lambda + turn.lambda / square,
              motion.worst + square * turn.worst};
    }
    void give(Measure& m) const {
      const Squares s = all();
      const double whole = s.u > 0 ? std::max(s.d, s.u) : 1;
      m.residual = std::sqrt(s.u / whole);
      m.siconos = std::sqrt(s.u / std::max(whole, s.lambda));
      m.worst = std::sqrt(s.worst / whole);
    }
  };
  template <class Pool>
  static constexpr unsigned turns_of = turning_rows<std::remove_cvref_t<decltype(std::declval<Pool&>().law)>>();

  void begin(const World& world) {
    ++now_;
    world.each([&](const auto& set, auto s) {
      auto& seen = std::get<s>(seen_);
      if (Index(seen.size()) != set.blocks()) [[unlikely]]
        seen.resize(std::size_t(set.blocks()), 0);
    });
  }

  /// f(pool, place, visit) for every joint, in the order of the laws and of adding.
  template <class S, class F>
  static void each(World& world, Laws& laws, const S& stabilisation, double h, F&& f) {
    each_pool(laws, [&](auto, auto& pool) {
      using Law = std::remove_cvref_t<decltype(pool.law)>;
      for (const Index place : pool.slots.active()) {
        const auto& item = std::as_const(pool.items[place]);
        if constexpr (HoldsPoint<Law>)
          with_set(world, item.a, [&](auto sa) {
            with_set(world, item.b, [&](auto sb) {
              f(pool, place, PointVisit<World, sa, sb>(world, pool.law, item, stabilisation, h));
            });
          });
        else
          f(pool, place, JointVisit<World, Law::rows>(world, pool.law, item, stabilisation, h));
      }
    });
  }
  template <class Visit>
  static constexpr int rows_of = std::remove_cvref_t<Visit>::R;

  static void note(const auto& visit, Sums& sums) {
    sums.violation = std::max(sums.violation, visit.violation);
    sums.rows += rows_of<decltype(visit)>;
  }
  /// Whether some end answers: what holds two kinematic bodies has no impulse, and nothing to measure.
  bool see(const World& world, const auto& visit) {
    bool answers = false;
    visit.each_moving(world, [&](auto s, Index block) {
      auto& seen = std::get<s>(seen_)[block];
      if (seen == now_) are_shared_ = true;
      seen = now_;
      answers = true;
    });
    return answers;
  }
  template <int R>
  static void keep(auto& pool, Index place, const Vec<R>& lambda) {
    pool.impulse[place] = lambda;
    double size = 0;
    unrolled<R>([&]<int k>() { size += lambda[k] * lambda[k]; });
    pool.starts_cold[place] = !(size < std::numeric_limits<double>::infinity());
  }

  /// One exact visit each, from zero.
  template <class S>
  Sums visit_alone(World& world, Laws& laws, const S& stabilisation, double h) {
    Sums sums;
    each(world, laws, stabilisation, h, [&](auto& pool, Index place, const auto& visit) {
      using Row = Vec<rows_of<decltype(visit)>>;
      const bool answers = see(world, visit);
      const Row d = visit.template velocity<VisitVelocity::next>(), lambda = visit.against(d);
      visit.push(lambda);
      keep(pool, place, lambda);
      if (answers) sums.template add<turns_of<decltype(pool)>>(d, Row(d + visit.response(lambda)), lambda, visit);
      note(visit, sums);
    });
    return sums;
  }

  // The ways of joints that share bodies stay out of the function that a pendulum's step is inlined to.
  template <class S>
  [[gnu::noinline]] Sums begin_with_last(World& world, Laws& laws, const S& stabilisation, double h, double step_ratio) {
    Sums sums;
    each(world, laws, stabilisation, h, [&](auto& pool, Index place, const auto& visit) {
      note(visit, sums);
      auto& impulse = pool.impulse[place];
      if (!see(world, visit) || pool.starts_cold[place]) set_zero(impulse);
      else impulse *= step_ratio;
      visit.push(impulse);
    });
    return sums;
  }
  template <class S>
  [[gnu::noinline]] void sweep(World& world, Laws& laws, const S& stabilisation, double h) {
    each(world, laws, stabilisation, h, [&](auto& pool, Index place, const auto& visit) {
      using Row = Vec<rows_of<decltype(visit)>>;
      if (!visit.answers()) return;
      const Row lambda = pool.impulse[place];
      const Row change = visit.against(visit.template velocity<VisitVelocity::next>() + visit.yields(lambda));
      visit.push(change);
      keep(pool, place, Row(lambda + change));
    });
  }
  /// What the last sweep has left, by the laws all at once.
  template <class S>
  [[gnu::noinline]] Sums measure(World& world, Laws& laws, const S& stabilisation, double h) {
    constexpr double far = 0.05;  // of the largest velocity
    Sums sums;
    each(world, laws, stabilisation, h, [&](auto& pool, Index place, const auto& visit) {
      using Row = Vec<rows_of<decltype(visit)>>;
      if (!visit.answers()) return;
      const Row lambda = pool.impulse[place], d = visit.template velocity<VisitVelocity::free>();
      sums.template add<turns_of<decltype(pool)>>(d, Row(visit.template velocity<VisitVelocity::next>() + visit.yields(lambda)), lambda, visit);
    });
    const Squares all = sums.all();
    if (all.u > far * far * std::max(all.d, all.u) && are_loads_exceeded(world, laws, stabilisation, h, sums.length.length()))
      each_pool(laws, [&](auto, auto& pool) {
        for (const Index place : pool.slots.active()) pool.starts_cold[place] = 1;
      });
    return sums;
  }
  /// As in `forget_lost_islands`.
  template <class S>
  [[gnu::noinline]] bool are_loads_exceeded(World& world, Laws& laws, const S& stabilisation, double h, double length) {
    inner::ImpulseLoads loads;
    each(world, laws, stabilisation, h, [&](auto& pool, Index place, const auto& visit) {
      constexpr int R = rows_of<decltype(visit)>;
      constexpr unsigned turns = turns_of<decltype(pool)>;
      if (!visit.answers()) return;
      const Vec<R> lambda = pool.impulse[place], d = visit.template velocity<VisitVelocity::free>();
      double sum[2] = {}, count[2] = {}, w[R];
      for (int k = 0; k < R; ++k) sum[turns >> k & 1] += visit.own(k), ++count[turns >> k & 1];
      for (int k = 0; k < R; ++k) w[k] = sum[turns >> k & 1] / count[turns >> k & 1];
      loads.add(w, d.data(), lambda.data(), R, turns, length);
    });
    return loads.are_exceeded();
  }

  template <class Set>
  using Steps = Array<std::uint32_t>;
  typename World::template PerSet<Steps> seen_;  ///< the last step in which a joint held the block
  std::uint32_t now_ = 0;
  bool are_shared_ = false;  ///< some block is held by two joints
};

/// FreeMotion to Correct at once.
void visit_joints(auto& step) {
  step.world().each([&](auto& set, auto s) {
    if (set.is_separable()) {
      delassus::kick(set, step.integrator(), step.h);
    } else {
      delassus::free_motion(set, set, step.integrator(), inner::part<s>(step.scratch), step.h);
      set.v_next = set.v_free;
    }
  });
  inner::notify<stage::FreeMotion>(step);
  follow(std::as_const(step).world(), step.laws());
  if (step.reports.empty()) [[unlikely]] step.reports.emplace_back();
  step.template state<role::Scheme>().run(step.world(), step.laws(), step.stabilisation(), step.h, step.h / step.last_h,
                                          step.scheme(), step.summary, step.reports[0]);
  summarise(step.reports, step.summary);
  step.summary.islands = 1;
  inner::notify<stage::Solve>(step);
  inner::notify<stage::Correct>(step);
}

}  // namespace delassus
