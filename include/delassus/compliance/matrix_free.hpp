/// The Delassus operator without the matrix: W λ = H (A⁻¹ Hᵀ λ), the bracket kept per body.
#pragma once

#include <delassus/compliance/compliance.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/rows/show_rows.hpp>

#include <tuple>

namespace delassus {

/// Keeps y = A⁻¹ Hᵀ λ, the velocity that the impulses add to each block: residual = d + H y, commit: y += G δ.
/// Moves about 2 (R w) numbers per body and visit instead of one R × R block per neighbour: it wins where a
/// constraint has many neighbours.
struct MatrixFreeCompliance {
  using plays = role::Compliance;

  template <class Rows>
  class Operator;
};

/// y of one loop, one a block; what its functions do stands at `Compliance`.
template <class T, int... w, int... R>
class MatrixFreeCompliance::Operator<RowSystem<T, Widths<w...>, R...>> {
 public:
  using Rows = RowSystem<T, Widths<w...>, R...>;  ///< H, d, λ of one step
  using Sum = double;                             ///< of y and of the sums of a row

  void build(const auto& world, Rows& rows) {
    world.each([&](const auto& set, auto s) {
      DELASSUS_EXPECT(!inner::is_coupled(set),
                      "MatrixFreeCompliance: springs between particles couple A under an implicit integrator, and so do "
                      "the elements of soft bodies; use AssembledCompliance");
      inner::apply_inverse_to_all(set, rows, s);
      std::get<s>(y_).resize(set.blocks());
    });
    for_each_index<Rows::pool_count>([&](auto p) { own_blocks<p>(rows); });
  }

  void reset(const Rows& rows) {
    std::apply([](auto&... y) { (zero(y), ...); }, y_);
    each_pool(rows, [&](auto p, const auto& pool) {
      for (Index i = 0; i < pool.items(); ++i) commit<p>(rows, i, pool.lambda[i]);
    });
  }

  template <int p>
  const auto& diagonal(Index i) const {
    return std::get<p>(diagonal_)[i];
  }

  /// The arrays that a solver reads of row p.
  template <int p>
  void show(const Rows&, RowView<T>& view, SetBlocksView<T>* sets, BlockRowsView<T>*) {
    view.form = FormOfW::bodies;
    view.diagonal = std::get<p>(diagonal_).numbers.data();
    view.on_diagonal = std::get<p>(compliance_).numbers.data();
    std::apply([&](auto&... y) { ((sets++->y = y.numbers.data()), ...); }, y_);
  }

  /// (d + H y)_i with the row's own compliance.
  template <int p>
  [[gnu::always_inline]] Vec<Rows::template rows_of<p>, T> residual(const Rows& rows, Index i) const {
    const auto& pool = rows.template pool<p>();
    constexpr int Ra = Rows::template rows_of<p>;
    Vec<Ra, Sum> r = pool.d[i].template cast<Sum>();
    for_each_index<Rows::set_count>([&](auto s) {
      const auto& set = inner::part<s>(pool.sets);
      const auto& y = std::get<s>(y_);
      for (Index e = set.offset[i]; e < set.offset[i + 1]; ++e) r += set.H[e].template cast<Sum>() * y[set.block[e]];
    });
    r += std::get<p>(compliance_)[i].cwiseProduct(pool.lambda[i]).template cast<Sum>();
    return r.template cast<T>();
  }

  template <int p>
  [[gnu::always_inline]] void commit(const Rows& rows, Index i, const Vec<Rows::template rows_of<p>, T>& change) {
    const auto& pool = rows.template pool<p>();
    for_each_index<Rows::set_count>([&](auto s) {
      const auto& set = inner::part<s>(pool.sets);
      auto& y = std::get<s>(y_);
      for (Index e = set.offset[i]; e < set.offset[i + 1]; ++e) 
        y[set.block[e]] += set.G[e].template cast<Sum>() * change.template cast<Sum>();
    });
  }

 private:
  static void zero(auto& y) {
    for (auto& x : y) x.setZero();
  }

  /// W_ii = Σ H_e G_f over the pairs of entries e, f of item i on the same block.
  template <int p>
  void own_blocks(const Rows& rows) {
    const auto& pool = rows.template pool<p>();
    auto& diagonal = std::get<p>(diagonal_);
    auto& compliance = std::get<p>(compliance_);
    diagonal.resize(pool.items());
    compliance.resize(pool.items());
    for (Index i = 0; i < pool.items(); ++i) {
      auto& W = diagonal[i];
      W.setZero();
      for_each_index<Rows::set_count>([&](auto s) {
        const auto& set = inner::part<s>(pool.sets);
        for (Index e = set.offset[i]; e < set.offset[i + 1]; ++e)
          for (Index f = set.offset[i]; f < set.offset[i + 1]; ++f)
            if (set.block[e] == set.block[f]) W += set.H[e] * set.G[f];
      });
      compliance[i] = pool.compliance[i] + pool.relative_compliance[i].cwiseProduct(W.diagonal());
      W.diagonal() += compliance[i];
    }
  }

  std::tuple<BlockArray<Vec<w, Sum>>...> y_;  ///< in double: it takes thousands of small changes
  std::tuple<BlockArray<Mat<R, R, T>>...> diagonal_;
  std::tuple<BlockArray<Vec<R, T>>...> compliance_;
};

}  // namespace delassus
