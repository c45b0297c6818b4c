/// Joints one by one: each is linearised, solved, and answered by its bodies before the next is looked at.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/core/unrolled.hpp>
#include <delassus/loop/stages/joint_visit.hpp>
#include <delassus/loop/stages/point_visit.hpp>
#include <delassus/loop/step_report.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace delassus {

/// The visits of a step:
///
///   λ_i ← λ_i − (W_ii + R_i)⁻¹ (H_i v + bias_i + R_i λ_i),   v ← v + A⁻¹ H_iᵀ Δλ_i,   i = 1 … n,
///
/// the sweep of Gauss and Seidel with v in the place of W λ + d. Where no two joints hold one moving body,
/// one visit is exact and λ begins at zero; elsewhere it begins with that of the last step, and what the
/// visits leave is measured once more. Nothing is kept of a joint between its visits.
template <class World, class Laws>
class JointVisits;

template <class... Sets, class Laws>
class JointVisits<World<Sets...>, Laws> {
 public:
  using World = delassus::World<Sets...>;
  using T = typename World::Scalar;

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
    solved.status = solved.measure.residual <= scheme.tolerance ? Status::converged : Status::max_iterations;
  }

  /// What outlives a step.
  void memory(auto& archive) { archive(are_shared_); }

 private:
  /// What is measured of a step: squares of the largest velocities, of what is left, and of the impulses.
  struct Sums {
    double d = 0, u = 0, lambda = 0, worst = 0;
    double violation = 0;  ///< m or rad, at the start
    Index rows = 0;

    double velocity() const { return std::max(d, u); }
    template <int R>
    void add(const Vec<R, T>& d_, const Vec<R, T>& u_, const Vec<R, T>& lambda_) {
      double own = 0;
      unrolled<R>([&]<int k>() {
        d += double(d_[k]) * double(d_[k]);
        own += double(u_[k]) * double(u_[k]);
        lambda += double(lambda_[k]) * double(lambda_[k]);
      });
      u += own;
      worst = std::max(worst, own);
    }
    void give(Measure& m) const {
      const double whole = u > 0 ? velocity() : 1;
      m.residual = std::sqrt(u / whole);
      m.siconos = std::sqrt(u / std::max(whole, lambda));
      m.worst = std::sqrt(worst / whole);
    }
  };

  /// Impulses beyond every load, see `forget_lost_islands`, are no start for the next step.
  struct Loads {
    double least = std::numeric_limits<double>::infinity(), most = 0, load = 0, response = 0;
    long joints = 0;

    template <class V>
    void add(double w, const V& d, const V& lambda) {
      least = std::min(least, w);
      most = std::max(most, w);
      load = std::max(load, double(d.norm()));
      response = std::max(response, w * double(lambda.norm()));
      ++joints;
    }
    bool are_exceeded() const { return response * least > double(joints) * most * load; }
  };

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
    for_each_index<Laws::pool_count>([&](auto p) {
      auto& pool = laws.template pool<p>();
      using Law = std::remove_cvref_t<decltype(pool.law)>;
      for (const Index place : pool.slots.active()) {
        const auto& item = std::as_const(pool.items[place]);
        with_set(world, item.a, [&](auto sa) {
          with_set(world, item.b, [&](auto sb) {
            if constexpr (HoldsPoint<Law, World>)
              f(pool, place, PointVisit<World, sa, sb>(world, pool.law, item, stabilisation, h));
            else
              f(pool, place, JointVisit<World, Law, sa, sb>(world, pool.law, item, stabilisation, h));
          });
        });
      }
    });
  }
  /// f(the set of an end), −1 for the world and for a body that never moves.
  template <int s = 0, class F>
  static void with_set(const World& world, const Anchor& end, F&& f) {
    if constexpr (s == World::set_count) {
      f(std::integral_constant<int, -1>{});
    } else {
      if (end.set == s && world.template set<s>().anchor_blocks(end) > 0)
        f(std::integral_constant<int, s>{});
      else
        with_set<s + 1>(world, end, f);
    }
  }

  static void note(const auto& visit, Sums& sums) {
    sums.violation = std::max(sums.violation, visit.violation);
    sums.rows += std::remove_cvref_t<decltype(visit)>::R;
  }
  /// Whether some end answers: there is nothing to measure of a joint between bodies that are led.
  bool see(const auto& visit) {
    bool answers = false;
    visit.each_moving([&](auto s, Index block) {
      auto& seen = std::get<s>(seen_)[block];
      if (seen == now_) are_shared_ = true;
      seen = now_;
      answers = true;
    });
    return answers;
  }
  static void keep(auto& pool, Index place, const auto& lambda) {
    pool.impulse[place] = lambda.template cast<double>();
    double size = 0;
    unrolled<std::remove_cvref_t<decltype(lambda)>::RowsAtCompileTime>(
        [&]<int k>() { size += double(lambda[k]) * double(lambda[k]); });
    pool.starts_cold[place] = !(size < std::numeric_limits<double>::infinity());
  }

  static constexpr auto next = [](const auto& set) -> const auto& { return set.v_next; };
  static constexpr auto free = [](const auto& set) -> const auto& { return set.v_free; };

  /// One exact visit each, from zero.
  template <class S>
  Sums visit_alone(World& world, Laws& laws, const S& stabilisation, double h) {
    Sums sums;
    each(world, laws, stabilisation, h, [&](auto& pool, Index place, const auto& visit) {
      const bool answers = see(visit);
      const auto d = visit.velocity(next);
      const auto lambda = visit.against(d);
      visit.push(lambda);
      keep(pool, place, lambda);
      if (answers) sums.template add<std::remove_cvref_t<decltype(visit)>::R>(d, d + visit.response(lambda), lambda);
      note(visit, sums);
    });
    return sums;
  }

  // The ways of joints that share bodies stay out of the function that a pendulum's step is inlined to.
  template <class S>
  [[gnu::noinline]] Sums begin_with_last(World& world, Laws& laws, const S& stabilisation, double h,
                                         double step_ratio) {
    Sums sums;
    each(world, laws, stabilisation, h, [&](auto& pool, Index place, const auto& visit) {
      see(visit);
      auto& impulse = pool.impulse[place];
      if (pool.starts_cold[place])
        impulse.setZero();
      else
        impulse *= step_ratio;
      visit.push(impulse.template cast<T>());
      note(visit, sums);
    });
    return sums;
  }
  template <class S>
  [[gnu::noinline]] void sweep(World& world, Laws& laws, const S& stabilisation, double h) {
    each(world, laws, stabilisation, h, [&](auto& pool, Index place, const auto& visit) {
      using Row = Vec<std::remove_cvref_t<decltype(visit)>::R, T>;
      const Row lambda = pool.impulse[place].template cast<T>();
      const Row change = visit.against(visit.velocity(next) + visit.yields(lambda));
      visit.push(change);
      keep(pool, place, Row(lambda + change));
    });
  }
  /// What the last sweep has left, by the laws all at once.
  template <class S>
  [[gnu::noinline]] Sums measure(World& world, Laws& laws, const S& stabilisation, double h) {
    constexpr double far = 0.05;  // of the largest velocity
    Sums sums;
    Loads loads;
    each(world, laws, stabilisation, h, [&](auto& pool, Index place, const auto& visit) {
      constexpr int R = std::remove_cvref_t<decltype(visit)>::R;
      const double w = double(visit.trace()) / R;
      if (!(w > 0)) return;  // both ends go where they are led
      const Vec<R, T> lambda = pool.impulse[place].template cast<T>(), d = visit.velocity(free);
      sums.template add<R>(d, visit.velocity(next) + visit.yields(lambda), lambda);
      loads.add(w, d, lambda);
    });
    if (sums.u > far * far * sums.velocity() && loads.are_exceeded()) start_cold(laws);
    return sums;
  }
  static void start_cold(Laws& laws) {
    for_each_index<Laws::pool_count>([&](auto p) {
      auto& pool = laws.template pool<p>();
      for (const Index place : pool.slots.active()) pool.starts_cold[place] = 1;
    });
  }

  template <class Set>
  using Steps = std::vector<std::uint32_t>;
  std::tuple<Steps<Sets>...> seen_;  ///< the last step in which a joint held the block
  std::uint32_t now_ = 0;
  bool are_shared_ = false;  ///< some block is held by two joints
};

}  // namespace delassus
