/// W as blocks: one list of rows for each pair of pools, and the diagonal.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/owning_array.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/rows/block_row.hpp>
#include <delassus/rows/row_view.hpp>

#include <cstddef>

namespace delassus::inner {

/// Rows of blocks, compressed: row i holds blocks start[i] … start[i+1] − 1 in the columns named by `column`.
/// Blocks are stored column-major, so that W_ij λ_j is a sum of columns.
template <class T>
struct BlockRowsOfNumbers {
  Array<Index> start{0}, column;
  Array<T> numbers;

  /// No block yet in any of `rows` rows.
  void reset(Index rows) {
    start.assign(std::size_t(rows) + 1, 0);
    column.clear();
    numbers.clear();
  }
};

/// out ← H G of blocks R × w and w × columns by columns, the sums from left to right.
template <int R, class T>
[[gnu::always_inline]] inline void set_block(const T* H, const T* G, int w, int columns, T* out) {
  for (int c = 0; c < columns; ++c) {
    DELASSUS_UNROLL
    for (int i = 0; i < R; ++i) out[i + R * c] = H[i] * G[w * c];
    for (int k = 1; k < w; ++k) {
      DELASSUS_UNROLL
      for (int i = 0; i < R; ++i) out[i + R * c] += H[i + R * k] * G[k + w * c];
    }
  }
}

template <class T>
class BlockMatrix {
 public:
  /// For so many pools, whatever they hold.
  void resize(int pools) {
    pools_ = pools;
    blocks_.resize(std::size_t(pools * pools));
    diagonal_.resize(std::size_t(pools));
    place_.resize(std::size_t(pools));
  }

  BlockRowsOfNumbers<T>& blocks(int a, int b) { return blocks_[std::size_t(a * pools_ + b)]; }
  const BlockRowsOfNumbers<T>& blocks(int a, int b) const { return blocks_[std::size_t(a * pools_ + b)]; }
  Array<T>& diagonal(int pool) { return diagonal_[std::size_t(pool)]; }
  const Array<T>& diagonal(int pool) const { return diagonal_[std::size_t(pool)]; }

  /// Opens pool a, whose rows are added one after the other. False where it has no items, and had none.
  bool begin_rows(const RowView<T>* pools, int a) {
    const RowView<T>& mine = pools[a];
    if (mine.items == 0 && diagonal(a).empty()) return false;
    diagonal(a).resize_for_overwrite(std::size_t(mine.rows * mine.rows) * std::size_t(mine.items));
    for (int b = 0; b < pools_; ++b) {
      blocks(a, b).reset(mine.items);
      if (place_[std::size_t(b)].size() != std::size_t(pools[b].items)) place_[std::size_t(b)].assign(std::size_t(pools[b].items), -1);
    }
    return true;
  }
  template <int R>
  void begin_row(int a, Index i) {
    T* own = diagonal(a).data() + std::ptrdiff_t(R * R) * i;
    DELASSUS_UNROLL
    for (int k = 0; k < R * R; ++k) own[k] = T(0);
  }
  /// W_ij += block of R × columns, opening the column when it is the first. A square block is no wider than the R of pool a.
  template <int R>
  [[gnu::always_inline]] void add(int a, int b, Index i, Index j, int columns, const T* block) {
    T* to;
    if (a == b && i == j) {
      to = diagonal(a).data() + std::ptrdiff_t(R * R) * i;
      columns = R;
    } else {
      BlockRowsOfNumbers<T>& W = blocks(a, b);
      Index& place = place_[std::size_t(b)][std::size_t(j)];
      if (place < 0) {
        place = Index(W.column.size());
        W.column.push_back(j);
        W.numbers.append(block, std::size_t(R * columns));
        return;
      }
      to = W.numbers.data() + std::ptrdiff_t(R * columns) * place;
    }
    for (int k = 0; k < R * columns; ++k) to[k] += block[k];
  }
  /// The rows' own compliance joins the diagonal, and the row is closed.
  void end_row(const RowView<T>& mine, int a, Index i) {
    T* own = own_block(mine, a, i);
    for (int k = 0; k < mine.rows; ++k) {
      const std::ptrdiff_t row = std::ptrdiff_t(mine.rows) * i + k;
      T& x = own[k * (mine.rows + 1)];
      x += mine.compliance[row] + mine.relative_compliance[row] * x;
    }
    for (int b = 0; b < pools_; ++b) {
      Array<Index>& place = place_[std::size_t(b)];
      if (place.empty()) continue;  // a pool without items costs one look
      BlockRowsOfNumbers<T>& W = blocks(a, b);
      for (Index e = W.start[std::size_t(i)]; e < Index(W.column.size()); ++e) place[std::size_t(W.column[std::size_t(e)])] = -1;
      W.start[std::size_t(i) + 1] = Index(W.column.size());
    }
  }

  void copy(const BlockMatrix& from) {
    pools_ = from.pools_;
    blocks_ = from.blocks_;
    diagonal_ = from.diagonal_;
  }

  Array<T> room_along, room_of_block;  ///< at work while a row is made

 private:
  T* own_block(const RowView<T>& mine, int a, Index i) { return diagonal(a).data() + std::ptrdiff_t(mine.rows * mine.rows) * i; }

  int pools_ = 0;
  OwningArray<BlockRowsOfNumbers<T>> blocks_;
  OwningArray<Array<T>> diagonal_;
  OwningArray<Array<Index>> place_;  ///< of column j of pool b in the row that is being built; −1 between rows
};

}  // namespace delassus::inner
