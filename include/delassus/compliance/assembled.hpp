/// The Delassus operator as a block-sparse matrix.
#pragma once

#include <delassus/compliance/compliance.hpp>
#include <delassus/compliance/inner/incidence.hpp>
#include <delassus/compliance/inner/nodal_rows.hpp>
#include <delassus/core/array.hpp>
#include <delassus/rows/block_row.hpp>
#include <delassus/rows/show_rows.hpp>

#include <tuple>
#include <type_traits>
#include <utility>

namespace delassus {

/// Rows of blocks, compressed: row i holds blocks start[i] … start[i+1] − 1 in the columns named by `column`.
/// Blocks are stored column-major, so that W_ij λ_j is a sum of columns.
template <int Ra, int Rb, class S>
struct BlockRows {
  Array<Index> start{0}, column;
  Array<Mat<Ra, Rb, S>> block;

  static void each_array(auto& self, auto&& f) { f(self.start), f(self.column), f(self.block); }
  /// No block yet in any of `rows` rows.
  void reset(Index rows) {
    start.assign(rows + 1, 0);
    column.clear();
    block.clear();
  }
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
  using Sum = double;
  static constexpr int pools = int(sizeof...(R));

  void build(const auto& world, Rows& rows) {
    world.each([&](const auto& set, auto s) {
      if constexpr (couples<decltype(set)>)
        if (set.is_coupled()) return coupling_of(set).template prepare<s>(set, rows);
      using Set = std::remove_cvref_t<decltype(set)>;
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
      incidence_.template find<s>(rows, set.blocks());
    });
    for_each_index<pools>([&](auto a) { build_rows<a>(world, rows, [](Index) { return true; }); });
  }

  /// The rows of those items alone of which keep(pool, item) is true; the others have no blocks, and of W_ii only
  /// their own compliance. Pre: G stands, and no set couples its blocks.
  void build_where(const auto& world, const Rows& rows, const auto& keep) {
    world.each([&](const auto& set, auto s) { incidence_.template find<s>(rows, set.blocks()); });
    for_each_index<pools>([&](auto a) { build_rows<a>(world, rows, [&](Index i) { return keep(a, i); }); });
  }

  void reset(const Rows&) {}

  /// No block yet, and a diagonal for every item: for who writes W into it.
  void resize_like(const Rows& rows) {
    for_each_index<pools>([&](auto a) {
      const Index items = rows.template pool<a>().items();
      std::get<a>(diagonal_).resize(items);
      for_each_index<pools>([&](auto b) { std::get<b>(std::get<a>(blocks_)).reset(items); });
    });
  }

  template <int p>
  const auto& diagonal(Index i) const {
    return std::get<p>(diagonal_)[i];
  }

  template <int p>
  Vec<Rows::template rows_of<p>, T> residual(const Rows& rows, Index i) const {
    constexpr int Ra = Rows::template rows_of<p>;
    Vec<Ra, Sum> r = others<p>(rows, i);
    r += std::get<p>(diagonal_)[i].template cast<Sum>() *
         rows.template pool<p>().lambda[i].template cast<Sum>();
    return Vec<Ra, T>(r.template cast<T>());
  }

  /// d_i + Σ_{j ≠ i} W_ij λ_j: what the rows would do without this constraint.
  template <int p>
  Vec<Rows::template rows_of<p>, T> free_velocity(const Rows& rows, Index i) const {
    return Vec<Rows::template rows_of<p>, T>(others<p>(rows, i).template cast<T>());
  }

  /// The arrays that a solver reads of row p.
  template <int p>
  void show(const Rows& rows, RowView<T>& view, SetBlocksView<T>*, BlockRowsView<T>* out) const {
    view.form = FormOfW::square_blocks;
    view.diagonal = inner::numbers_of(std::get<p>(diagonal_));
    for_each_index<pools>([&](auto b) {
      const auto& W = std::get<b>(std::get<p>(blocks_));
      if (W.block.empty()) return;
      if (R_of<b> != R_of<p>) view.form = FormOfW::blocks;
      out[view.block_rows++] = {W.start.data(), W.column.data(), inner::numbers_of(W.block),
                                inner::numbers_of(rows.template pool<b>().lambda), R_of<b>};
    });
  }

  static constexpr bool commit_is_free = true;
  template <int p>
  void commit(const Rows&, Index, const Vec<Rows::template rows_of<p>, T>&) {}

  /// W alone, without what builds it.
  void copy_matrix(const Operator& from) {
    blocks_ = from.blocks_;
    diagonal_ = from.diagonal_;
  }

  /// The arrays of the matrix.
  static void each_array(auto& self, auto&& f) {
    const auto row_of = [&](auto& row) { std::apply([&](auto&... b) { (b.each_array(b, f), ...); }, row); };
    std::apply([&](auto&... row) { (row_of(row), ...); }, self.blocks_);
    std::apply([&](auto&... diagonal) { (f(diagonal), ...); }, self.diagonal_);
  }

  /// The off-diagonal blocks between pools a and b, for export and tests.
  template <int a, int b>
  const auto& blocks() const {
    return std::get<b>(std::get<a>(blocks_));
  }
  /// For who changes a copy.
  template <int a, int b>
  auto& blocks() {
    return std::get<b>(std::get<a>(blocks_));
  }
  template <int p>
  auto& diagonal(Index i) {
    return std::get<p>(diagonal_)[i];
  }

 private:
  /// Large terms cancel here: the sum runs in double whatever is stored.
  template <int p>
  [[gnu::always_inline]] Vec<Rows::template rows_of<p>, Sum> others(const Rows& rows, Index i) const {
    Vec<Rows::template rows_of<p>, Sum> r = rows.template pool<p>().d[i].template cast<Sum>();
    for_each_index<pools>([&](auto b) {
      const auto& W = std::get<b>(std::get<p>(blocks_));
      const T* x = inner::numbers_of(rows.template pool<b>().lambda);
      if constexpr (R_of<p> == R_of<b>)
        inner::add_row<R_of<p>>(r.data(), W.start[i], W.start[i + 1], inner::numbers_of(W.block), W.column.data(), x);
      else
        inner::add_wide_row<R_of<p>>(r.data(), W.start[i], W.start[i + 1], inner::numbers_of(W.block), W.column.data(), x, R_of<b>);
    });
    return r;
  }

  template <int p>
  static constexpr int R_of = Rows::template rows_of<p>;

  template <class Set>
  static constexpr bool couples = Inverse::is_whole && inner::may_couple<std::remove_cvref_t<Set>>;

  /// What knows A⁻¹ of a set that couples its blocks.
  template <class Set>
  auto& coupling_of(const Set&) {
    if constexpr (NodeCompliantSet<Set>) return nodal_;
    else return columns_;
  }

  /// Row by row: every entry e of item i meets all entries f on its block, and W_ij += H_e G_f.
  template <int a, class World, class Keep>
  void build_rows(const World& world, const Rows& rows, const Keep& keep) {
    const auto& pool = rows.template pool<a>();
    auto& diagonal = std::get<a>(diagonal_);
    if (pool.items() == 0 && diagonal.empty()) return;  // a law without items, step after step
    diagonal.resize(pool.items());
    for_each_index<pools>([&](auto b) {
      std::get<b>(std::get<a>(blocks_)).reset(pool.items());
      place_[b].assign(rows.template pool<b>().items(), -1);
    });
    for (Index i = 0; i < pool.items(); ++i) {
      diagonal[i].setZero();
      if (keep(i)) world.each([&](const auto& set, auto s) {
        if constexpr (couples<decltype(set)>)
          if (set.is_coupled())
            return coupling_of(set).template each<s, a>(
                rows, i, [&](auto b, Index j, const auto& W) { add<a, b>(i, j, W); });
        add_row<a, s>(rows, i);
      });
      for (int k = 0; k < pool.rows; ++k)
        diagonal[i](k, k) += pool.compliance[i][k] + pool.relative_compliance[i][k] * diagonal[i](k, k);
      for_each_index<pools>([&](auto b) {
        if (place_[b].empty()) return;  // a pool without items costs one look
        auto& W = std::get<b>(std::get<a>(blocks_));
        for (Index e = W.start[i]; e < Index(W.column.size()); ++e) place_[b][W.column[e]] = -1;
        W.start[i + 1] = Index(W.column.size());
      });
    }
  }

  template <int a, int s>
  void add_row(const Rows& rows, Index i) {
    const auto& mine = std::get<s>(rows.template pool<a>().sets);
    for (Index e = mine.offset[i]; e < mine.offset[i + 1]; ++e)
      for_each_index<pools>([&](auto b) {
        const auto& theirs = std::get<s>(rows.template pool<b>().sets);
        if (theirs.block.empty()) return;
        for (const auto& [j, f] : incidence_.template at<s, b>(mine.block[e]))
          add<a, b>(i, j, mine.H[e] * theirs.G[f]);
      });
  }

  /// W_ij += block, opening the column when it is the first.
  template <int a, int b, class Block>
  void add(Index i, Index j, const Block& block) {
    if constexpr (a == b)
      if (i == j) {
        std::get<a>(diagonal_)[i] += block;
        return;
      }
    auto& W = std::get<b>(std::get<a>(blocks_));
    Index& place = place_[b][j];
    if (place < 0) {
      place = Index(W.column.size());
      W.column.push_back(j);
      W.block.emplace_back(block.template cast<T>());
    } else {
      W.block[place] += block.template cast<T>();
    }
  }

  template <int Ra>
  using RowOf = std::tuple<BlockRows<Ra, R, T>...>;

  std::tuple<RowOf<R>...> blocks_;
  std::tuple<Array<Mat<R, R, T>>...> diagonal_;
  std::array<Array<Index>, sizeof...(R)> place_;
  inner::Incidence<Rows> incidence_;
  inner::CoupledColumns<Rows> columns_;
  inner::NodalRows<Rows> nodal_;
};

}  // namespace delassus
