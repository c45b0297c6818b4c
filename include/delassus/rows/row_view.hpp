/// The rows of one pool and their part of W as plain arrays: what solvers and the loops of laws read, whatever they were built by.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/index.hpp>
#include <delassus/rows/row_kind.hpp>

#include <cstddef>

namespace delassus {

/// The blocks of H and G = A⁻¹ Hᵀ that a pool has in one body set; see `SetBlocks`. H is R × width, G width × R, by columns.
template <class T>
struct SetBlocksView {
  const Index *offset = nullptr, *block = nullptr;
  const T *H = nullptr, *G = nullptr;  ///< no G where A couples the blocks
  double* y = nullptr;                 ///< A⁻¹ Hᵀ λ by block, where W has no matrix
  int width = 0;

  bool has_entries(Index i) const { return offset[i + 1] > offset[i]; }
};

/// W between a pool and another one, or itself without its diagonal. Row i holds the blocks start[i] … start[i + 1] − 1.
/// They are R × columns numbers by columns, which meet the impulses of the items that `column` names.
template <class T>
struct BlockRowsView {
  const Index *start, *column;
  const T *block, *lambda;
  int columns;
};

/// Of an item where some rows have no blocks: whether it has none itself, and whether it acts on a body of one that has none.
struct CrowdedRow {
  bool is_crowded, meets_crowded;
};

/// How W is kept: as one `BlockRowsView` whose blocks are as wide as high, as any of them, or as A⁻¹ Hᵀ λ of the bodies. Else
/// row by row one or the other, or by functions of its own. What is no matrix must hear of changes of λ.
enum class FormOfW : char { square_blocks, blocks, bodies, mixed, functions };

/// W by functions of its own: residual sets u = (d + W λ)_i, `changed` hears that λ_i was changed by δ.
template <class T>
struct FunctionsOfW {
  void *W = nullptr, *rows = nullptr;
  void (*residual)(const FunctionsOfW&, int pool, Index i, T* u) = nullptr;
  void (*changed)(const FunctionsOfW&, int pool, Index i, const T* change) = nullptr;
};

/// All rows of one pool, R an item. Item i has the numbers R i … R i + R − 1 of each array, R² of `diagonal`.
template <class T>
struct RowView {
  int pool = 0, rows = 0;
  Index items = 0;
  unsigned turns = 0;  ///< see `turning_rows`
  T *lambda = nullptr, *d = nullptr, *bias = nullptr;
  const T *compliance = nullptr, *relative_compliance = nullptr;
  const T *diagonal = nullptr;    ///< W_ii, compliance included
  const T *own_diagonal = nullptr;  ///< the same without what a solver lifts it by
  FormOfW form = FormOfW::square_blocks;
  int block_rows = 0, sets = 0;
  const BlockRowsView<T>* blocks = nullptr;
  const SetBlocksView<T>* set = nullptr;
  const T* on_diagonal = nullptr;  ///< compliance in 1/kg, of a W that has no matrix
  const CrowdedRow* crowded = nullptr;
  FunctionsOfW<T> functions{};

  bool turn(int k) const { return turns >> k & 1; }
  bool is_matrix() const { return form <= FormOfW::blocks; }
  const T* own_block(Index i) const { return diagonal + std::ptrdiff_t(rows) * rows * i; }
  T trace(Index i) const {
    const T* own = own_block(i);
    T sum = own[0];
    for (int k = 1; k < rows; ++k) sum += own[k * (rows + 1)];
    return sum;
  }
  /// w = tr(W_ii)/rows, of rows that have one unit: 1/kg or 1/(kg m²).
  double weight(Index i) const { return double(trace(i)) / rows; }
  /// w of each row: the mean W_kk of the rows in its unit. What Σ w_k λ_k² says is an energy, J, in any unit of length.
  void weights(Index i, double* w) const {
    if (!inner::are_mixed(rows, turns)) {
      const double all = weight(i);
      for (int k = 0; k < rows; ++k) w[k] = all;
      return;
    }
    const T* own = own_block(i);
    double sum[2] = {};
    int count[2] = {};
    for (int k = 0; k < rows; ++k) sum[turn(k)] += double(own[k * (rows + 1)]), ++count[turn(k)];
    for (int k = 0; k < rows; ++k) w[k] = sum[turn(k)] / count[turn(k)];
  }
  /// √w of each row.
  void roots_of_weights(Index i, double* roots) const {
    weights(i, roots);
    for (int k = 0; k < rows; ++k) roots[k] = k > 0 && !inner::are_mixed(rows, turns) ? roots[0] : std::sqrt(roots[k]);
  }
};

}  // namespace delassus
