/// Joints are closed where a step has ended, by displacements of their bodies.
#pragma once

#include <delassus/compliance/compliance.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/fixed_array.hpp>
#include <delassus/rows/row_arrays.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/row_view.hpp>
#include <delassus/rows/world_view.hpp>
#include <delassus/solvers/inner/joint_system.hpp>
#include <delassus/step/law_rows.hpp>
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

/// As `show_rows` of the rows themselves.
template <class T>
void show_rows(const RowArrays<T>& rows, int pool, RowView<T>& view, SetBlocksView<T>* sets) {
  view.pool = pool;
  view.rows = rows.rows;
  view.items = rows.items();
  view.lambda = rows.lambda->data();
  view.d = rows.d->data();
  view.bias = rows.bias->data();
  view.compliance = rows.compliance->data();
  view.relative_compliance = rows.relative_compliance->data();
  view.set = sets;
  view.sets = rows.sets;
  for (int s = 0; s < rows.sets; ++s) {
    const SetArrays<T>& set = rows.set[s];
    sets[s] = {set.offset->data(), set.block->data(), set.H->data(), set.G->size() == set.H->size() ? set.G->data() : nullptr, nullptr, set.width};
  }
}

/// Newton's method for φ(q ⊕ w) = 0 over all rigid rows of all joints: w = A⁻¹ Hᵀ μ, H w = −φ, with H of
/// where the bodies are. A is that of the step, the metric alone. Rows that depend on each other share μ.
template <class P>
class CloseGaps {
  using World = typename P::World;
  using Laws = typename P::Laws;
  using Rows = typename P::Rows;
  using T = typename World::Scalar;
  static constexpr int pools = Laws::pool_count, sets = Rows::set_count;

 public:
  /// Leaves no gap above `tolerance` (m, rad), if `passes` do; a pass that widens the worst one, or in which a law throws, is
  /// taken back.
  void run(auto& step, double tolerance, int passes) {
    bool is_coupled = false;
    step.world().each([&](const auto& set, auto) { is_coupled = is_coupled || inner::is_coupled(set); });
    if (is_coupled) return;
    double before = write(step);
    for (int pass = 0; pass < passes && before > tolerance; ++pass) {
      if (!find(step)) return;
      Pass<std::remove_reference_t<decltype(step)>> trial(*this, step);
      const double after = write(step);
      if (!(after < before)) return;
      trial.is_kept = true;
      before = after;
    }
  }

 private:
  /// q ← q ⊕ w, and back at its end unless it is kept.
  template <class Step>
  struct Pass {
    Pass(CloseGaps& own, Step& step) : own_(own), step_(step) { own_.displace(step_, 1); }
    Pass(const Pass&) = delete;
    ~Pass() {
      if (!is_kept) own_.displace(step_, -1);
    }
    bool is_kept = false;

   private:
    CloseGaps& own_;
    Step& step_;
  };

  /// H and φ of where the bodies are; returns the largest |φ| of a rigid row.
  double write(auto& step) {
    const AllLaws<T> laws = step.pools.all();
    arrays_.attach(rows_);
    double worst = 0;
    for (int p = 0; p < pools; ++p) {
      if (!gapes[p]) continue;
      const LawPool<T>& law = laws[std::size_t(p)];
      const RowArrays<T>& pool = arrays_.all()[std::size_t(p)];
      const Index items = law.law->count(law.pool);
      pool.reset(items);
      law.law->linearize(law.pool, step.view, pool, 0, items);
      for (std::size_t row = 0; row < pool.phi->size(); ++row) {
        if (pool.is_soft(row)) (*pool.relative_compliance)[row] = yields, (*pool.phi)[row] = T(0);
        else worst = std::max(worst, double(std::abs((*pool.phi)[row])));
      }
    }
    return worst;
  }

  /// w of all bodies.
  bool find(auto& step) {
    joints_.begin();
    step.world().each([&](const auto& set, auto s) { apply_inverse_to_all(set, rows_, s); });
    const AllRows<T> all = arrays_.all();
    for (int p = 0; p < pools; ++p) {
      SetBlocksView<T> blocks[sets + 1];
      RowView<T> view;
      show_rows(all[std::size_t(p)], p, view, blocks);
      for (Index i = 0; i < view.items; ++i)
        if (!all_soft(all[std::size_t(p)], i)) joints_.take_joint(view, i, p);
    }
    if (joints_.parts().empty()) return false;
    joints_.analyse(0);
    if (!joints_.factor(1e-10)) return false;
    joints_.load([&](const auto& joint, auto& to) {
      const T* phi = all[std::size_t(joint.pool)].phi->data() + std::ptrdiff_t(joint.rows) * joint.item;
      for (int k = 0; k < joint.rows; ++k) to[k] = double(phi[k]);
    });
    joints_.solve();
    joints_.keep();
    step.world().each([&](const auto& set, auto s) {
      auto& w = std::get<s>(displacement_);
      w.resize(std::size_t(set.blocks()));
      for (auto& x : w) set_zero(x);
    });
    for (const RowArrays<T>& pool : all) pool.lambda->assign_zeros(pool.phi->size());
    for (const auto& joint : joints_.parts())
      for (int k = 0; k < joint.rows; ++k) (*all[std::size_t(joint.pool)].lambda)[std::size_t(joint.rows * joint.item + k)] = T(joint.step[k]);
    step.world().each([&](const auto&, auto s) {
      T* const w = reinterpret_cast<T*>(std::get<s>(displacement_).data());
      for (const RowArrays<T>& pool : all) pool.set[s].products->add_motion(pool.set[s], pool.items(), pool.lambda->data(), w);
    });
    return true;
  }
  static bool all_soft(const RowArrays<T>& pool, Index i) {
    for (int k = 0; k < pool.rows; ++k)
      if (!pool.is_soft(std::size_t(i * pool.rows + k))) return false;
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
  template <class... L>
  static constexpr FixedArray<bool, sizeof...(L)> which_gape(std::type_identity<Constraints<L...>>) {
    return {can_gape<L>()...};
  }
  static constexpr auto gapes = which_gape(std::type_identity<Laws>{});

  Rows rows_;  ///< of the laws that can gape
  ArraysOf<Rows> arrays_;
  JointSystem<rows_of_a_node<Rows>, std::max(1, Rows::widest)> joints_;
  typename World::template PerSet<VelocitiesOf> displacement_;
};

}  // namespace delassus::inner
