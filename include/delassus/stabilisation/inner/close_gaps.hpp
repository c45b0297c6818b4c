/// Joints are closed where a step has ended, by displacements of their bodies.
#pragma once

#include <delassus/compliance/compliance.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/rows/row_arrays.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/show_rows.hpp>
#include <delassus/rows/soft.hpp>
#include <delassus/rows/world_view.hpp>
#include <delassus/solvers/inner/joint_system.hpp>
#include <delassus/step/row_types.hpp>

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

namespace delassus::inner {

/// A law whose rows are all equalities, and not all soft by their kind, as those of a rotor are.
template <class Law>
constexpr bool can_gape() {
  constexpr bool resists = requires { requires Law::resists; };
  return !ContactLaw<Law> && are_equalities(row_kinds<Law>()) && !resists;
}
template <class... Laws>
consteval bool some_can_gape(std::type_identity<Constraints<Laws...>>) {
  return (can_gape<Laws>() || ...);
}

/// Newton's method for φ(q ⊕ w) = 0 over all rigid rows of all joints: w = A⁻¹ Hᵀ μ, H w = −φ, with H of
/// where the bodies are. A is that of the step, the metric alone. Rows that depend on each other share μ.
template <class P>
class CloseGaps {
  using World = typename P::World;
  using Laws = typename P::Laws;
  using Rows = typename P::Rows;
  using T = typename World::Scalar;
  static constexpr int sets = Rows::set_count;
  template <int p>
  using Law = std::remove_cvref_t<decltype(std::declval<const Laws&>().template pool<p>().law)>;

 public:
  /// Leaves no gap above `tolerance` (m, rad), if `passes` do; a pass that widens the worst one is taken
  /// back.
  void run(auto& step, double tolerance, int passes) {
    bool is_coupled = false;
    step.world().each([&](const auto& set, auto) { is_coupled = is_coupled || inner::is_coupled(set); });
    if (is_coupled) return;
    double before = write(step);
    for (int pass = 0; pass < passes && before > tolerance; ++pass) {
      if (!find(step)) return;
      displace(step, 1);
      const double after = write(step);
      if (!(after < before)) return displace(step, -1);
      before = after;
    }
  }

 private:
  /// f(p, rows of pool p) for the laws that can gape and have items.
  void each_pool_that_can_gape(auto&& f) {
    for_each_index<Laws::pool_count>([&](auto p) {
      if constexpr (can_gape<Law<p>>())
        if (auto& pool = rows_.template pool<p>(); pool.items() > 0) f(p, pool);
    });
  }

  /// H and φ of where the bodies are; returns the largest |φ| of a rigid row.
  double write(auto& step) {
    const auto laws = step.pools.all();
    double worst = 0;
    for_each_index<Laws::pool_count>([&](auto p) {
      if constexpr (can_gape<Law<p>>()) {
        const Index items = laws[p].law->count(laws[p].pool);
        auto& pool = rows_.template pool<p>();
        if (items == 0 && pool.items() == 0) return;
        const ArraysOf<std::remove_cvref_t<decltype(pool)>> arrays(pool);
        arrays.reset(items);
        laws[p].law->linearize(laws[p].pool, step.view, arrays, 0, items);
        for (Index i = 0; i < items; ++i)
          for (int k = 0; k < pool.rows; ++k) {
            if (is_spring(pool.stiffness[i][k], pool.damping[i][k]))
              pool.relative_compliance[i][k] = yields, pool.phi[i][k] = T(0);
            else
              worst = std::max(worst, double(std::abs(pool.phi[i][k])));
          }
      }
    });
    return worst;
  }

  /// w of all bodies.
  bool find(auto& step) {
    joints_.begin();
    each_pool_that_can_gape([&](auto p, auto& pool) {
      step.world().each([&](const auto& set, auto s) {
        auto& blocks = part<s>(pool.sets);
        blocks.G.resize_for_overwrite(blocks.H.size());
        apply_inverse<false>(set, blocks, Range{0, Index(blocks.H.size())});
      });
      SetBlocksView<T> blocks[sets + 1];
      RowView<T> view;
      show_rows(pool, p, view, blocks);
      for (Index i = 0; i < view.items; ++i)
        if (!all_soft(pool, i)) joints_.take_joint(view, i, p);
    });
    if (joints_.parts().empty()) return false;
    joints_.analyse(0);
    if (!joints_.factor(1e-10)) return false;
    each_pool_that_can_gape([&](auto p, auto& pool) { phi_[p] = pool.phi.numbers.data(); });
    joints_.load([&](const auto& joint, auto& to) {
      for (int k = 0; k < joint.rows; ++k)
        to[k] = double(phi_[joint.pool][std::ptrdiff_t(joint.rows) * joint.item + k]);
    });
    joints_.solve();
    joints_.keep();
    step.world().each([&](const auto& set, auto s) {
      auto& w = std::get<s>(displacement_);
      w.resize(std::size_t(set.blocks()));
      for (auto& x : w) set_zero(x);
    });
    for (const auto& joint : joints_.parts())
      each_pool_that_can_gape([&](auto p, auto& pool) {
        if (joint.pool != p) return;
        std::remove_cvref_t<decltype(pool.phi[0])> mu;
        for (int k = 0; k < pool.rows; ++k) mu[k] = T(joint.step[k]);
        step.world().each([&](const auto&, auto s) {
          const auto& blocks = part<s>(pool.sets);
          for (Index e = blocks.offset[joint.item]; e < blocks.offset[joint.item + 1]; ++e)
            std::get<s>(displacement_)[std::size_t(blocks.block[e])] += blocks.G[e] * mu;
        });
      });
    return true;
  }
  static bool all_soft(const auto& pool, Index i) {
    for (int k = 0; k < pool.rows; ++k)
      if (!is_spring(pool.stiffness[i][k], pool.damping[i][k])) return false;
    return true;
  }

  /// q ← q ⊕ sign w.
  void displace(auto& step, double sign) {
    step.world().each([&](auto& set, auto s) {
      for (const Index b : set.active())
        if (set.moves(b)) set.displace(b, T(sign) * std::get<s>(displacement_)[std::size_t(b)]);
    });
  }

  static constexpr T yields = T(1e12);  ///< of a soft row beside rigid ones, in units of its W_kk

  Rows rows_;
  JointSystem<rows_of_a_node<Rows>, std::max(1, Rows::widest)> joints_;
  typename World::template PerSet<VelocitiesOf> displacement_;
  const T* phi_[Laws::pool_count + 1] = {};
};

}  // namespace delassus::inner
