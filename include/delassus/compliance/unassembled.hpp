/// The Delassus operator of a solver that reads no matrix: its diagonal, and the rest by the bodies.
#pragma once

#include <delassus/compliance/assembled.hpp>
#include <delassus/compliance/compliance.hpp>
#include <delassus/compliance/inner/own_blocks.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/owning_array.hpp>
#include <delassus/core/pack.hpp>
#include <delassus/rows/free_velocity.hpp>
#include <delassus/rows/show_rows.hpp>

#include <cstddef>

namespace delassus {

/// As `MatrixFreeCompliance`, W λ = H y with y = A⁻¹ Hᵀ λ of each body, where A couples no bodies; else W is
/// a matrix, as of `AssembledCompliance`. What a loop takes that names `DirectGaussSeidel` and no compliance:
/// of n joints of one body the matrix would have n² blocks, which nobody reads. `loop.problem()` has the
/// matrix.
struct UnassembledCompliance {
  using plays = role::Compliance;

  template <class Rows>
  class Operator;
};

/// y of one loop, one a block; what its functions do stands at `Compliance`.
template <class T, int... w, int... R>
class UnassembledCompliance::Operator<RowSystem<T, Widths<w...>, R...>> {
 public:
  using Rows = RowSystem<T, Widths<w...>, R...>;   ///< H, d, λ of one step
  static constexpr int pools = int(sizeof...(R));  ///< one for each law
  static constexpr int sets = Rows::set_count;     ///< of bodies

  Operator() {
    diagonal_.resize(std::size_t(pools));
    compliance_.resize(std::size_t(pools));
    y_.resize(std::size_t(sets));
  }

  template <class World>
  void build(const World& world, Rows& rows) {
    are_apart_ = is_matrix_ = false;
    if constexpr (inner::any_may_couple<World>)
      if ((is_matrix_ = couples(world))) return matrix_.build(world, rows);
    build_own(world, rows, inner::OneRange{});
  }
  /// The same by several workers, with room as for a matrix.
  template <class World, class Parts, class E>
  void build(const World& world, Rows& rows, Parts& parts, auto& of_sets, const E& execution) {
    are_apart_ = true, is_matrix_ = false;
    if constexpr (inner::any_may_couple<World>)
      if ((is_matrix_ = couples(world))) return matrix_.build(world, rows, parts, of_sets, execution);
    build_own(world, rows, inner::SharedRanges{execution});
    world.each([&](const auto& set, auto s) {
      each_pool(rows, [&](auto, const auto& pool) {
        for (const Index block : inner::part<s>(pool.sets).block) are_apart_ = are_apart_ && set.moves(block);
      });
    });
  }
  static constexpr bool islands_are_apart = true;  ///< where `are_islands_apart` says so besides
  /// False where a body that does not move, a kinematic one, may be of several islands: they share its y.
  bool are_islands_apart() const { return are_apart_; }

  void reset(const Rows& rows) {
    if (is_matrix_) return;
    for (auto& y : y_) y.assign_zeros(y.size());
    for_each_index<pools>([&](auto p) __attribute__((always_inline)) {
      Shown of;
      show_bodies<p>(rows, of);
      inner::add_impulses_to_bodies<R_of<p>>(of.view);
    });
  }

  template <int p>
  const Mat<Rows::template rows_of<p>, Rows::template rows_of<p>, T>& diagonal(Index i) const {
    if (is_matrix_) return matrix_.template diagonal<p>(i);
    return *reinterpret_cast<const Mat<R_of<p>, R_of<p>, T>*>(diagonal_[p].data() +
                                                              std::ptrdiff_t(R_of<p> * R_of<p>) * i);
  }
  /// (d + W λ)_i of item i of pool p, m/s and rad/s: from y where W is no matrix.
  template <int p>
  Vec<Rows::template rows_of<p>, T> residual(const Rows& rows, Index i) const {
    if (is_matrix_) return matrix_.template residual<p>(rows, i);
    Vec<R_of<p>, T> out;
    Shown of;
    show_bodies<p>(rows, of);
    inner::store(inner::velocity_without_blocks<R_of<p>>(of.view, i), out.data());
    return out;
  }
  template <int p>
  void commit(const Rows& rows, Index i, const Vec<Rows::template rows_of<p>, T>& change) {
    if (is_matrix_) return;
    Shown of;
    show_bodies<p>(rows, of);
    inner::impulse_changed<R_of<p>>(of.view, i, inner::load<R_of<p>>(change.data()));
  }

  /// The arrays that a solver reads of row p.
  template <int p>
  void show(const Rows& rows, RowView<T>& view, SetBlocksView<T>* of_sets, BlockRowsView<T>* blocks) const {
    if (is_matrix_) return matrix_.template show<p>(rows, view, of_sets, blocks);
    view.form = FormOfW::bodies;
    view.diagonal = diagonal_[p].data();
    view.on_diagonal = compliance_[p].data();
    for (int s = 0; s < sets; ++s) of_sets[s].y = const_cast<double*>(y_[std::size_t(s)].data());
  }

  /// Makes the matrix of the rows that were built, once; from then on it is W.
  void complete(const auto& world, Rows& rows) {
    if (is_matrix_) return;
    const CrowdedRow* const nobody[pools] = {};
    matrix_.build_where(world, rows, nobody);
    is_matrix_ = true;
  }
  /// Its blocks between pools a and b, without the diagonal. Pre: it is complete, as that of
  /// `loop.problem()`.
  template <int a, int b>
  auto blocks() const {
    return matrix_.template blocks<a, b>();
  }

 private:
  template <int p>
  static constexpr int R_of = Rows::template rows_of<p>;

  static bool couples(const auto& world) {
    bool any = false;
    world.each([&](const auto& set, auto) { any = any || inner::is_coupled(set); });
    return any;
  }
  template <class Ranges>
  void build_own(const auto& world, Rows& rows, const Ranges& ranges) {
    world.each([&](const auto& set, auto s) {
      inner::apply_inverse_to_all(set, rows, s, ranges);
      y_[std::size_t(int(s))].resize(std::size_t(set.blocks()) *
                                     std::size_t(std::remove_cvref_t<decltype(set)>::width));
    });
    for_each_index<pools>([&](auto p) __attribute__((always_inline)) {
      constexpr int height = R_of<p>;
      const std::size_t items = std::size_t(rows.template pool<p>().items());
      diagonal_[p].resize_for_overwrite(std::size_t(height * height) * items);
      compliance_[p].resize_for_overwrite(std::size_t(height) * items);
      if (items == 0) return;
      Shown of;
      show_bodies<p>(rows, of);
      ranges(of.view.items, 128, inner::SetOwnBlocks<height, T>{of.view, diagonal_[p].data(), compliance_[p].data()});
    });
  }

  /// What `show` says, for a moment.
  struct Shown {
    SetBlocksView<T> of_sets[sets + 1];
    RowView<T> view;
  };
  template <int p>
  [[gnu::always_inline]] void show_bodies(const Rows& rows, Shown& of) const {
    inner::show_rows(const_cast<Rows&>(rows).template pool<p>(), p, of.view, of.of_sets);
    of.view.form = FormOfW::bodies;
    of.view.on_diagonal = compliance_[p].data();
    for (int s = 0; s < sets; ++s) of.of_sets[s].y = const_cast<double*>(y_[std::size_t(s)].data());
  }

  bool is_matrix_ = false, are_apart_ = false;
  OwningArray<Array<T>> diagonal_, compliance_;  ///< by pool
  OwningArray<Array<double>> y_;  ///< by set of bodies; in double: it takes thousands of small changes
  AssembledCompliance::Operator<Rows> matrix_;
};

}  // namespace delassus
