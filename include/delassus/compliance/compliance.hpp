/// What a solver may ask of a compliance: three functions per constraint, whether W exists as a matrix or not.
#pragma once

#include <delassus/core/ranges.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/fwd.hpp>
#include <delassus/rows/local.hpp>
#include <delassus/rows/row_system.hpp>

namespace delassus {

/// A compliance builder is a policy whose `Operator<Rows>` holds the workspace of one loop.
///
///   build(world, rows)          from H and A⁻¹, once a step; also writes G = A⁻¹ Hᵀ where A is block-diagonal
///   reset(rows)                 λ is what rows.lambda says now
///   diagonal<p>(i)              own block W_ii of item i of pool p, R × R, compliance included, 1/kg
///   residual<p>(rows, i)        u_i + bias_i = (d + W λ)_i at the present λ
///   commit<p>(rows, i, δ)       λ_i has been changed by δ. `commit_is_free` says that this does nothing
///   show<p>(rows, view, sets, blocks)   if it has arrays that a solver can read: fills a `RowView` with them, docs/project/core.md
template <class C>
concept Compliance = Plays<C, role::Compliance>;

namespace inner {

/// G_e = A⁻¹ H_eᵀ for these entries of one pool in one block-diagonal set; M⁻¹ H_eᵀ of the masses alone. Pre: G has room.
template <bool of_masses, class Set, int R, int w, class T>
void apply_inverse(const Set& set, SetBlocks<R, w, T>& blocks, Range entries) {
  for (std::size_t e = std::size_t(entries.first); e < std::size_t(entries.last); ++e) {
    if constexpr (of_masses) assign(blocks.G[e], set.template solve_mass<R>(blocks.block[e], transposed(blocks.H[e])));
    else assign(blocks.G[e], set.template solve_block<R>(blocks.block[e], transposed(blocks.H[e])));
  }
}
/// The same of all entries of every pool; `ranges` says who does which.
template <bool of_masses = false, class Set, class Rows, class S, class Ranges = OneRange>
[[gnu::always_inline]] inline void apply_inverse_to_all(const Set& set, Rows& rows, S s, const Ranges& ranges = {}) {
  for_each_index<Rows::pool_count>([&](auto p) __attribute__((always_inline)) {
    auto& blocks = inner::part<s>(rows.template pool<p>().sets);
    blocks.G.resize_for_overwrite(blocks.H.size());
    ranges(Index(blocks.H.size()), 256, [&](Range entries) { apply_inverse<of_masses>(set, blocks, entries); });
  });
}

/// What answers with A⁻¹ for set s: the operator where it has factors of its own, else the set. An operator
/// begins its solves with its answer to the last free motion (guess 0) or to the last impulses (1).
template <int s, class Operator, class Set>
decltype(auto) inverse_of(Operator& W, Set& set, int guess) {
  if constexpr (requires { W.template inverse<s>(set, guess); })
    return W.template inverse<s>(set, guess);
  else
    return (set);
}

/// (W̃ λ)_i: without d, and without the rows' own compliance, which is no part of the motion: W_kk + R_k stands
/// in `diagonal`.
template <int p, class Operator, class Rows>
auto response(const Operator& W, const Rows& rows, Index i) {
  using T = typename Rows::Scalar;
  const auto& pool = rows.template pool<p>();
  Vec<Rows::template rows_of<p>, T> out = W.template residual<p>(rows, i) - pool.d[i];
  for (int k = 0; k < out.size(); ++k) {
    const T whole = W.template diagonal<p>(i)(k, k);
    const T plain = (whole - pool.compliance[i][k]) / (T(1) + pool.relative_compliance[i][k]);
    out[k] -= (whole - plain) * pool.lambda[i][k];
  }
  return out;
}

/// A set whose A can have entries between blocks, depending on what it holds.
template <class Set>
inline constexpr bool may_couple = requires(const Set& set) { set.is_coupled(); };

/// A world with such a set.
template <class World>
inline constexpr bool any_may_couple = true;
template <class... Sets>
inline constexpr bool any_may_couple<World<Sets...>> = (may_couple<Sets> || ...);

template <class Set>
bool is_coupled(const Set& set) {
  if constexpr (may_couple<Set>) return set.is_coupled();
  else return false;
}

}  // namespace inner
}  // namespace delassus
