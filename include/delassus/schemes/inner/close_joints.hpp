/// Joints are closed in places and velocities, in the metric of mass: after an extrapolation.
#pragma once

#include <delassus/compliance/add_impulses.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/rows/islands.hpp>
#include <delassus/rows/row_arrays.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/world_view.hpp>
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
    auto& rows = step.rows;
    const BodyVelocities<World> v(step.world());
    for (std::size_t p = 0; p < std::size_t(Laws::pool_count); ++p) aim(step.pools.all()[p].law->kinds, step.arrays.all()[p], of_places ? nullptr : v.start, step.h);
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
  /// λ = 0, and d of the rows that hold: φ, or where the velocities `v` are given the rate. Open bounds are φ away, or φ/h.
  template <class T>
  static void aim(const RowKind* kinds, const RowArrays<T>& pool, const T* const* v, double h) {
    T u[most_rows];
    for (Index i = 0; i < pool.items(); ++i) {
      if (v) rate(pool, i, v, u);
      for (int k = 0; k < pool.rows; ++k) {
        const std::size_t row = std::size_t(i) * std::size_t(pool.rows) + std::size_t(k);
        const T phi = (*pool.phi)[row];
        const bool is_open = (kinds[k] == RowKind::lower && phi > T(0)) || (kinds[k] == RowKind::upper && phi < T(0));
        T d = 0;
        if (!pool.is_soft(row) && kinds[k] == RowKind::equality) d = v ? u[k] : phi;
        if (!pool.is_soft(row) && is_open) d = v ? T(phi / h) : phi;
        (*pool.d)[row] = d;
        (*pool.lambda)[row] = T(0);
      }
    }
  }
  PositionLaws<Laws, typename World::Scalar, needs_of<typename P::Solver>> book_;
  typename World::template PerSet<VelocitiesOf> change_;
};

}  // namespace delassus::inner
