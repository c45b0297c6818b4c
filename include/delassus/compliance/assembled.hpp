/// The Delassus operator as a block-sparse matrix.
#pragma once

#include <delassus/compliance/compliance.hpp>
#include <delassus/compliance/inner/block_matrix.hpp>
#include <delassus/compliance/inner/incidence.hpp>
#include <delassus/compliance/inner/nodal_rows.hpp>
#include <delassus/core/array.hpp>
#include <delassus/rows/block_list.hpp>
#include <delassus/rows/block_row.hpp>
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
  List &start, &column;
  Blocks block;
};

/// Where A couples the blocks of a set, W takes A⁻¹ whole.
struct WholeInverse {
  static constexpr bool is_whole = true;
};

/// W = Σ H A⁻¹ Hᵀ over the bodies: two constraints meet in W where they act on one body. W is kept in
/// the scalar of the rows; sums run in double. `Inverse` says what is taken of an A that couples blocks.
template <class Inverse = WholeInverse>
struct BasicAssembledCompliance {
  using plays = role::Compliance;

  template <class Rows>
  class Operator;
};
using AssembledCompliance = BasicAssembledCompliance<>;

template <class Inverse>
template <class T, int... w, int... R>
class BasicAssembledCompliance<Inverse>::Operator<RowSystem<T, Widths<w...>, R...>> {
 public:
  using Rows = RowSystem<T, Widths<w...>, R...>;
  static constexpr int pools = int(sizeof...(R));

  Operator() { matrix_.resize(pools); }

  void build(const auto& world, Rows& rows) {
    world.each([&](const auto& set, auto s) {
      using Set = std::remove_cvref_t<decltype(set)>;
      is_coupled_[s] = couples<Set> && inner::is_coupled(set);
      if (is_coupled_[s]) return;
      if constexpr (!Inverse::is_whole && inner::may_couple<Set>) {
        constexpr bool has_masses = requires(const Mat<Set::width, 1, typename Set::Scalar>& x) {
          set.template solve_mass<1>(0, x);
        };
        static_assert(has_masses,
                      "delassus: UncoupledCompliance takes the mass of each node alone, which this set of bodies does not give (Rods "
                      "do not); use AssembledCompliance");
        if constexpr (has_masses) {
          if (set.is_coupled()) inner::apply_inverse<true>(set, rows, s);
          else inner::apply_inverse(set, rows, s);
        }
      } else {
        inner::apply_inverse(set, rows, s);
      }
    });
    show(rows);
    world.each([&](const auto& set, auto s) {
      if constexpr (couples<std::remove_cvref_t<decltype(set)>>)
        if (is_coupled_[s]) return coupling_of(set).prepare(set, views_, pools, s);
      incidence_.find(views_, pools, s, set.blocks());
    });
    for_each_index<pools>([&](auto a) { build_rows<a>(world, nullptr); });
  }

  /// The rows of those items alone that are not crowded, by pool; the others have no blocks, and of W_ii only
  /// their own compliance. Pre: G stands, and no set couples its blocks.
  void build_where(const auto& world, Rows& rows, const CrowdedRow* const* crowded) {
    show(rows);
    world.each([&](const auto& set, auto s) {
      is_coupled_[s] = false;
      incidence_.find(views_, pools, s, set.blocks());
    });
    for_each_index<pools>([&](auto a) { build_rows<a>(world, crowded[a]); });
  }

  void reset(const Rows&) {}

  /// No block yet, and a diagonal for every item: for who writes W into it.
  void resize_like(const Rows& rows) {
    for_each_index<pools>([&](auto a) {
      const Index items = rows.template pool<a>().items();
      matrix_.diagonal(a).resize(std::size_t(R_of<a> * R_of<a>) * std::size_t(items));
      for (int b = 0; b < pools; ++b) matrix_.blocks(a, b).reset(items);
    });
  }

  template <int p>
  const Mat<Rows::template rows_of<p>, Rows::template rows_of<p>, T>& diagonal(Index i) const {
    return *reinterpret_cast<const Mat<R_of<p>, R_of<p>, T>*>(matrix_.diagonal(p).data() + std::ptrdiff_t(R_of<p> * R_of<p>) * i);
  }
  template <int p>
  Mat<Rows::template rows_of<p>, Rows::template rows_of<p>, T>& diagonal(Index i) {
    return *reinterpret_cast<Mat<R_of<p>, R_of<p>, T>*>(matrix_.diagonal(p).data() + std::ptrdiff_t(R_of<p> * R_of<p>) * i);
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
    view.form = FormOfW::square_blocks;
    view.diagonal = matrix_.diagonal(p).data();
    const T* impulses[pools];
    for_each_index<pools>([&](auto b) { impulses[b] = inner::numbers_of(rows.template pool<b>().lambda); });
    constexpr int heights[] = {R...};
    for (int b = 0; b < pools; ++b) {
      const auto& W = matrix_.blocks(p, b);
      if (W.numbers.empty()) continue;
      if (heights[b] != R_of<p>) view.form = FormOfW::blocks;
      out[view.block_rows++] = {W.start.data(), W.column.data(), W.numbers.data(), impulses[b], heights[b]};
    }
  }

  static constexpr bool commit_is_free = true;
  template <int p>
  void commit(const Rows&, Index, const Vec<Rows::template rows_of<p>, T>&) {}

  /// W alone, without what builds it.
  void copy_matrix(const Operator& from) { matrix_.copy(from.matrix_); }

  /// The arrays of the matrix.
  static void each_array(auto& self, auto&& f) {
    for_each_index<pools>([&](auto a) {
      for_each_index<pools>([&](auto b) {
        auto W = self.template blocks<a, b>();
        f(W.start), f(W.column), f(W.block);
      });
      using Numbers = std::remove_reference_t<decltype(self.matrix_.diagonal(a))>;
      BlockList<Mat<R_of<a>, R_of<a>, T>, Numbers> diagonal(self.matrix_.diagonal(a));
      f(diagonal);
    });
  }

  /// The off-diagonal blocks between pools a and b, for export and tests.
  template <int a, int b>
  auto blocks() const {
    const auto& W = matrix_.blocks(a, b);
    return BlockRows<const Array<Index>, BlockList<Mat<R_of<a>, R_of<b>, T>, const Array<T>>>{W.start, W.column, BlockList<Mat<R_of<a>, R_of<b>, T>, const Array<T>>(W.numbers)};
  }
  /// For who changes a copy.
  template <int a, int b>
  auto blocks() {
    auto& W = matrix_.blocks(a, b);
    return BlockRows<Array<Index>, BlockList<Mat<R_of<a>, R_of<b>, T>, Array<T>>>{W.start, W.column, BlockList<Mat<R_of<a>, R_of<b>, T>, Array<T>>(W.numbers)};
  }

 private:
  template <int p>
  static constexpr int R_of = Rows::template rows_of<p>;

  template <int r>
  static Vec<r, T> vector_of(const double* x) {
    Vec<r, T> out;
    for (int k = 0; k < r; ++k) out[k] = T(x[k]);
    return out;
  }
  template <int p>
  void sum_others(const Rows& rows, Index i, double* r) const {
    const auto& d = rows.template pool<p>().d[i];
    for (int k = 0; k < R_of<p>; ++k) r[k] = double(d[k]);
    for_each_index<pools>([&](auto b) {
      const auto& W = matrix_.blocks(p, b);
      const T* x = inner::numbers_of(rows.template pool<b>().lambda);
      if (R_of<p> == R_of<b>) inner::add_row<R_of<p>>(r, W.start[i], W.start[i + 1], W.numbers.data(), W.column.data(), x);
      else inner::add_wide_row<R_of<p>>(r, W.start[i], W.start[i + 1], W.numbers.data(), W.column.data(), x, R_of<b>);
    });
  }

  template <class Set>
  static constexpr bool couples = Inverse::is_whole && inner::may_couple<Set>;

  /// What knows A⁻¹ of a set that couples its blocks.
  template <class Set>
  auto& coupling_of(const Set&) {
    if constexpr (NodeCompliantSet<Set>) return nodal_;
    else return columns_;
  }

  void show(Rows& rows) {
    for_each_index<pools>([&](auto p) { inner::show_rows(rows.template pool<p>(), p, views_[p], sets_[p]); });
  }

  template <int a>
  void build_rows(const auto& world, const CrowdedRow* crowded) {
    constexpr int height = R_of<a>;
    if (!matrix_.begin_rows(views_, a)) return;
    bool any_coupled = false;
    for (const bool is_coupled : is_coupled_) any_coupled = any_coupled || is_coupled;
    for (Index i = 0; i < views_[a].items; ++i) {
      matrix_.begin_row(views_[a], a, i);
      if (!crowded || !crowded[i].is_crowded) {
        if (any_coupled) add_coupled<height>(world, a, i);
        for (int s = 0; s < views_[a].sets; ++s)
          if (!is_coupled_[s]) add_row<height>(a, s, i);
      }
      matrix_.end_row(views_[a], a, i);
    }
  }

  /// Every entry e of item i meets all entries f on its block, and W_ij += H_e G_f.
  template <int height>
  void add_row(int a, int s, Index i) {
    const SetBlocksView<T>& mine = views_[a].set[s];
    for (Index e = mine.offset[i]; e < mine.offset[i + 1]; ++e)
      for (int b = 0; b < pools; ++b) {
        const SetBlocksView<T>& theirs = views_[b].set[s];
        if (theirs.offset[views_[b].items] == 0) continue;
        const auto meeting = incidence_.at(s, b, mine.block[e]);
        const T* H = mine.H + std::ptrdiff_t(height * mine.width) * e;
        const int columns = views_[b].rows;
        if (columns == height && mine.width == 6) {
          for (const auto& [j, f] : meeting) add_product<height, 6>(a, b, i, j, H, theirs.G + std::ptrdiff_t(6 * height) * f);
        } else if (columns == height && mine.width == 3) {
          for (const auto& [j, f] : meeting) add_product<height, 3>(a, b, i, j, H, theirs.G + std::ptrdiff_t(3 * height) * f);
        } else {
          for (const auto& [j, f] : meeting)
            add_wide_product<height>(a, b, i, j, H, theirs.G + std::ptrdiff_t(mine.width * columns) * f, mine.width, columns);
        }
      }
  }
  template <int height, int width>
  [[gnu::always_inline]] void add_product(int a, int b, Index i, Index j, const T* H, const T* G) {
    T block[height * height];
    inner::set_product<height, width, height>(H, G, block);
    matrix_.template add<height>(a, b, i, j, height, block);
  }
  template <int height>
  void add_wide_product(int a, int b, Index i, Index j, const T* H, const T* G, int width, int columns) {
    T block[height * std::max({1, R...})];
    inner::set_block<height>(H, G, width, columns, block);
    matrix_.template add<height>(a, b, i, j, columns, block);
  }

  /// The sets whose blocks A couples.
  template <int height>
  void add_coupled(const auto& world, int a, Index i) {
    world.each([&](const auto& set, auto s) {
      using Set = std::remove_cvref_t<decltype(set)>;
      if constexpr (couples<Set>) {
        if (!is_coupled_[s]) return;
        if constexpr (NodeCompliantSet<Set>)
          nodal_.each(views_, s, a, i, [&](int b, Index j, const T* block) { matrix_.template add<height>(a, b, i, j, views_[b].rows, block); });
        else
          columns_.each(views_, s, a, i, [&](int b, Index j, const T* H, const T* response, int width) {
            add_wide_product<height>(a, b, i, j, H, response, width, views_[b].rows);
          });
      }
    });
  }

  static constexpr int sets = int(sizeof...(w));
  inner::BlockMatrix<T> matrix_;
  inner::Incidence<T> incidence_;
  inner::CoupledColumns<T> columns_;
  inner::NodalRows<T> nodal_;
  RowView<T> views_[pools > 0 ? pools : 1];  ///< of the rows that are being built
  SetBlocksView<T> sets_[pools > 0 ? pools : 1][sets > 0 ? sets : 1];
  bool is_coupled_[sets > 0 ? sets : 1] = {};
};

}  // namespace delassus
