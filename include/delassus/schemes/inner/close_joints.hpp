/// Joints are closed in places and velocities, in the metric of mass: after an extrapolation.
#pragma once

#include <delassus/compliance/add_impulses.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/rows/islands.hpp>
#include <delassus/rows/rate.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/soft.hpp>
#include <delassus/solvers/island_problem.hpp>
#include <delassus/step/find_islands.hpp>
#include <delassus/step/linearize.hpp>
#include <delassus/step/moves_at_once.hpp>
#include <delassus/step/position_laws.hpp>
#include <delassus/step/row_types.hpp>

#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

namespace delassus::inner {

/// Moves the bodies by w = M⁻¹ Hᵀ μ, H w = −φ, and changes their velocities by M⁻¹ Hᵀ ν, H (v + M⁻¹ Hᵀ ν) = 0, for rows that hold
/// exactly. Bounds are kept, springs are left alone.
template <class P>
class CloseJoints {
  using World = typename P::World;
  using Laws = typename P::Laws;

  template <class Law>
  static consteval bool holds_something() {
    for (const RowKind kind : row_kinds<Law>())
      if (kind == RowKind::equality) return true;
    return false;
  }
  template <class... L>
  static consteval bool any_holds(std::type_identity<Constraints<L...>>) {
    return (holds_something<L>() || ...);
  }

 public:
  void run(auto& step) {
    if constexpr (Laws::pool_count > 0 && any_holds(std::type_identity<Laws>{})) {
      using Step = std::remove_reference_t<decltype(step)>;
      follow(step.view, step.pools.all());
      linearize(step.view, step.pools.all(), step.arrays.all());
      find_islands(step.world(), step.arrays.all(), step.islands);
      step.world().each([](auto& set, auto) { set.factor(SystemScale{}); });
      step.W.build(std::as_const(step).world(), step.rows);
      solve<Step, true>(step);
      step.world().each([&](auto& set, auto s) {
        for (const Index b : set.active())
          if (set.moves(b)) set.displace(b, std::get<s>(change_)[b]);
      });
      solve<Step, false>(step);
      step.world().each([&](auto& set, auto s) {
        for (const Index b : set.active())
          if (set.moves(b)) set.velocity()[b] += std::get<s>(change_)[b];
      });
      if constexpr (MovesAtOnce<typename P::Integrator>) step.rows.reset(), step.islands.clear();  // it has none of its own
    }
  }

 private:
  /// Of places or of velocities: what closes the rows, into `change_`.
  template <class Step, bool of_places>
  void solve(Step& step) {
    using T = typename Step::Scalar;
    auto& rows = step.rows;
    for_each_index<Laws::pool_count>([&](auto p) {
      using Law = std::remove_cvref_t<decltype(step.laws().template pool<p>().law)>;
      constexpr auto kinds = row_kinds<Law>();
      auto& pool = rows.template pool<p>();
      for (Index i = 0; i < pool.items(); ++i) {
        const auto u = rate(pool, i, std::as_const(step).world(), [](const auto& set) -> const auto& { return set.velocity(); });
        set_zero(pool.lambda[i]);
        set_zero(pool.d[i]);
        for (int k = 0; k < Law::rows; ++k) {
          if (is_spring(pool.stiffness[i][k], pool.damping[i][k])) continue;
          const T phi = pool.phi[i][k];
          if (kinds[k] == RowKind::equality) pool.d[i][k] = of_places ? phi : u[k];
          const bool is_open = (kinds[k] == RowKind::lower && phi > T(0)) || (kinds[k] == RowKind::upper && phi < T(0));
          if (is_open) pool.d[i][k] = of_places ? phi : T(phi / step.h);
        }
      }
    });
    step.W.reset(rows);
    book_.show(step.W, rows);
    NoObserver nobody;
    for (Index k = 0; k < step.islands.count(); ++k) {
      IslandProblem island(book_, rows, step.W, step.islands, k, step.h, nobody);
      step.solver().solve(island, step.solver_workspace.itself());
    }
    step.world().each([&](auto& set, auto s) {
      auto& to = std::get<s>(change_);
      to.resize(std::size_t(set.blocks()));
      for (auto& x : to) set_zero(x);
      add_impulses(inverse_of<s>(step.W, set, 1), s, ArraysOf(rows).all(), to, part<s>(step.scratch));
    });
  }
  PositionLaws<Laws, typename World::Scalar, needs_of<typename P::Solver>> book_;
  typename World::template PerSet<VelocitiesOf> change_;
};

}  // namespace delassus::inner
