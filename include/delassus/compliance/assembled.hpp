/// The Delassus operator as a block-sparse matrix.
#pragma once

#include <delassus/compliance/compliance.hpp>
#include <delassus/compliance/inner/assembled_rows.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/pack.hpp>
#include <delassus/rows/block_list.hpp>
#include <delassus/rows/block_row.hpp>
#include <delassus/rows/shared_set.hpp>
#include <delassus/rows/show_rows.hpp>

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <utility>

namespace delassus {

/// Rows of blocks, compressed: row i holds blocks start[i] … start[i+1] − 1 in the columns named by `column`. It refers to
/// the arrays of an operator.
template <class List, class Blocks>
struct BlockRows {
  /// The first block of each row; one number more than there are rows.
  List &start, &column;  ///< of each block
  Blocks block;  ///< rows of i × rows of j numbers each, 1/kg
};

/// Where A couples the blocks of a set, W takes A⁻¹ whole.
struct WholeInverse {
  static constexpr bool is_whole = true;  ///< read by `BasicAssembledCompliance`
};

/// W = Σ H A⁻¹ Hᵀ over the bodies: two constraints meet in W where they act on one body. W is kept in
/// the scalar of the rows; sums run in double. `Inverse` says what is taken of an A that couples blocks.
template <class Inverse = WholeInverse>
struct BasicAssembledCompliance {
  using plays = role::Compliance;

  template <class Rows>
  class Operator;
};
using AssembledCompliance = BasicAssembledCompliance<>;  ///< what a loop takes where none is named

/// W of one loop, as blocks; what its functions do stands at `Compliance`.
template <class Inverse>
template <class T, int... w, int... R>
class BasicAssembledCompliance<Inverse>::Operator<RowSystem<T, Widths<w...>, R...>> {
 public:
  using Rows = RowSystem<T, Widths<w...>, R...>;   ///< H, d, λ of one step
  static constexpr int pools = int(sizeof...(R));  ///< one for each law
  using Built = inner::AssembledRows<T>;           ///< what makes the blocks

  Operator() { own_.resize(pools, Rows::set_count); }

  template <class World>
  void build(const World& world, Rows& rows) {
    world.each([&](const auto& set, auto s) __attribute__((always_inline)) { invert(set, rows, s); });
    prepare(world, rows);
    constexpr bool any_couples = Inverse::is_whole && inner::any_may_couple<World>;
    for_each_index<pools>([&](auto a) __attribute__((always_inline)) { Built::template build_pool<R_of<a>, any_couples>(own_, a, nullptr); });
  }

  /// The same by several workers; `parts` is room for what each makes, `sets` what they keep of the sets of
  /// bodies.
  template <class World, class Parts, class E>
  void build(const World& world, Rows& rows, Parts& parts, auto& sets, const E& execution) {
    world.each([&](const auto& set, auto s) __attribute__((always_inline)) { invert(set, rows, s, inner::SharedRanges{execution}); });
    show(rows);
    world.each([&](const auto& set, auto s) {
      if constexpr (inner::SharedSet<std::remove_cvref_t<decltype(set)>>)
        own_.prepare(set, s, inner::part<s>(sets), execution);
      else
        own_.prepare(set, s);
    });
    constexpr bool any_couples = Inverse::is_whole && inner::any_may_couple<World>;
    for_each_index<pools>([&](auto a) { parts.template build<R_of<a>, any_couples>(own_, a, execution); });
  }
  /// Each island has rows and blocks of its own: several may be solved at once.
  static constexpr bool islands_are_apart = true;

  /// The rows of those items alone that are not crowded, by pool; the others have no blocks, and of W_ii only
  /// their own compliance. Pre: G stands, and no set couples its blocks.
  void build_where(const auto& world, Rows& rows, const CrowdedRow* const* crowded) {
    for (auto& how : own_.coupled) how = inner::HowCoupled::not_at_all;
    prepare(world, rows);
    for_each_index<pools>([&](auto a) __attribute__((always_inline)) { Built::template build_pool<R_of<a>, false>(own_, a, crowded[a]); });
  }

  void reset(const Rows&) {}

  /// No block yet, and a diagonal for every item: for who writes W into it.
  void resize_like(const Rows& rows) {
    for_each_index<pools>([&](auto a) {
      const Index items = rows.template pool<a>().items();
      own_.matrix.diagonal(a).resize(std::size_t(R_of<a> * R_of<a>) * std::size_t(items));
      for (int b = 0; b < pools; ++b) own_.matrix.blocks(a, b).reset(items);
    });
  }

  template <int p>
  const Mat<Rows::template rows_of<p>, Rows::template rows_of<p>, T>& diagonal(Index i) const {
    return *reinterpret_cast<const Mat<R_of<p>, R_of<p>, T>*>(own_.matrix.diagonal(p).data() + std::ptrdiff_t(R_of<p> * R_of<p>) * i);
  }
  template <int p>
  Mat<Rows::template rows_of<p>, Rows::template rows_of<p>, T>& diagonal(Index i) {
    return *reinterpret_cast<Mat<R_of<p>, R_of<p>, T>*>(own_.matrix.diagonal(p).data() + std::ptrdiff_t(R_of<p> * R_of<p>) * i);
  }

  /// u_i = (d + W λ)_i; large terms cancel here: the sum runs in double whatever is stored.
  template <int p>
  Vec<Rows::template rows_of<p>, T> residual(const Rows& rows, Index i) const {
    double r[R_of<p>];
    sum_others<p>(rows, i, r);
    inner::add_square_block<R_of<p>>(r, diagonal<p>(i).data(), rows.template pool<p>().lambda[i].data());
    return vector_of<R_of<p>>(r);
  }

  /// d_i + Σ_{j ≠ i} W_ij λ_j: what the rows would do without this constraint.
  template <int p>
  Vec<Rows::template rows_of<p>, T> free_velocity(const Rows& rows, Index i) const {
    double r[R_of<p>];
    sum_others<p>(rows, i, r);
    return vector_of<R_of<p>>(r);
  }

  /// The arrays that a solver reads of row p.
  template <int p>
  void show(const Rows& rows, RowView<T>& view, SetBlocksView<T>*, BlockRowsView<T>* out) const {
    view.diagonal = own_.matrix.diagonal(p).data();
    const T* impulses[pools];
    find_impulses(rows, impulses);
    const auto add = [&](int b) {
      const auto& W = own_.matrix.blocks(p, b);
      out[view.block_rows++] = {W.start.data(), W.column.data(), W.numbers.data(), impulses[b], heights[b]};
    };
    for (int b = 0; b < pools; ++b)
      if (!own_.matrix.blocks(p, b).numbers.empty()) add(b);
    if (view.block_rows == 0) add(p);
    view.form = view.block_rows == 1 && out->columns == R_of<p> ? FormOfW::square_blocks : FormOfW::blocks;
  }

  static constexpr bool commit_is_free = true;  ///< see `Compliance`
  template <int p>
  void commit(const Rows&, Index, const Vec<Rows::template rows_of<p>, T>&) {}

  /// W alone, without what builds it.
  void copy_matrix(const Operator& from) { own_.matrix.copy(from.own_.matrix); }

  /// The arrays of the matrix.
  static void each_array(auto& self, auto&& f) {
    for_each_index<pools>([&](auto a) {
      for_each_index<pools>([&](auto b) {
        auto W = self.template blocks<a, b>();
        f(W.start), f(W.column), f(W.block);
      });
      using Numbers = std::remove_reference_t<decltype(self.own_.matrix.diagonal(a))>;
      BlockList<Mat<R_of<a>, R_of<a>, T>, Numbers> diagonal(self.own_.matrix.diagonal(a));
      f(diagonal);
    });
  }

  /// The off-diagonal blocks between pools a and b, for export and tests.
  template <int a, int b>
  auto blocks() const {
    const auto& W = own_.matrix.blocks(a, b);
    return BlockRows<const Array<Index>, BlockList<Mat<R_of<a>, R_of<b>, T>, const Array<T>>>{W.start, W.column, BlockList<Mat<R_of<a>, R_of<b>, T>, const Array<T>>(W.numbers)};
  }
  /// For who changes a copy.
  template <int a, int b>
  auto blocks() {
    auto& W = own_.matrix.blocks(a, b);
    return BlockRows<Array<Index>, BlockList<Mat<R_of<a>, R_of<b>, T>, Array<T>>>{W.start, W.column, BlockList<Mat<R_of<a>, R_of<b>, T>, Array<T>>(W.numbers)};
  }

 private:
  template <int p>
  static constexpr int R_of = Rows::template rows_of<p>;
  static constexpr int heights[] = {R..., 0};

  template <int r>
  static Vec<r, T> vector_of(const double* x) {
    Vec<r, T> out;
    for (int k = 0; k < r; ++k) out[k] = T(x[k]);
    return out;
  }
  /// r = (d + W λ)_i without W_ii.
  template <int p>
  void sum_others(const Rows& rows, Index i, double* r) const {
    const T* impulses[pools];
    find_impulses(rows, impulses);
    own_.template sum_others<R_of<p>>(p, i, rows.template pool<p>().d.numbers.data(), impulses, heights, r);
  }
  /// λ of each pool.
  [[gnu::noinline]] static void find_impulses(const Rows& rows, const T** out) {
    rows.pools.each([&](const auto& pool) __attribute__((always_inline)) { *out++ = pool.lambda.numbers.data(); });
  }

  template <class Set>
  static constexpr bool couples = Inverse::is_whole && inner::may_couple<Set>;

  /// G of a set whose blocks A does not couple, and who answers for the others.
  template <class Set, class S, class Ranges = inner::OneRange>
  [[gnu::always_inline]] void invert(const Set& set, Rows& rows, S s, const Ranges& ranges = {}) {
    const bool is_coupled = couples<Set> && inner::is_coupled(set);
    own_.coupled[s] = !is_coupled               ? inner::HowCoupled::not_at_all
                      : NodeCompliantSet<Set> ? inner::HowCoupled::nodes
                                              : inner::HowCoupled::columns;
    if (is_coupled) return;
    if constexpr (!Inverse::is_whole && inner::may_couple<Set>) {
      constexpr bool has_masses = requires(const Mat<Set::width, 1, typename Set::Scalar>& x) { set.template solve_mass<1>(0, x); };
      static_assert(has_masses,
                    "delassus: UncoupledCompliance takes the mass of each node alone, which this set of bodies does not give (Rods "
                    "do not); use AssembledCompliance");
      if constexpr (has_masses) {
        if (set.is_coupled()) inner::apply_inverse_to_all<true>(set, rows, s, ranges);
        else inner::apply_inverse_to_all(set, rows, s, ranges);
      }
    } else {
      inner::apply_inverse_to_all(set, rows, s, ranges);
    }
  }
  [[gnu::always_inline]] void show(Rows& rows) {
    for_each_index<pools>([&](auto p) __attribute__((always_inline)) {
      inner::show_rows(rows.template pool<p>(), p, own_.views[p], own_.sets(p));
    });
  }
  [[gnu::always_inline]] void prepare(const auto& world, Rows& rows) {
    show(rows);
    world.each([&](const auto& set, auto s) __attribute__((always_inline)) { own_.prepare(set, s); });
  }

  Built own_;
};

}  // namespace delassus
