/// What a law writes its linearisation with.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/rows/anchor.hpp>
#include <delassus/rows/row_arrays.hpp>
#include <delassus/rows/world_view.hpp>

#include <cstddef>
#include <string>
#include <string_view>

namespace delassus {

namespace inner {

/// A law writes into no rows but its own. A template, so that a program can compile it once.
template <class Char>
[[noreturn, gnu::cold, gnu::noinline]] void refuse_row(std::basic_string_view<Char> what, int row, int rows) {
  refuse(std::string(what) + ": a law of " + std::to_string(rows) + " rows writes row " + std::to_string(row) + "; they count from 0 to " +
         std::to_string(rows - 1) + ", change its `rows` or its linearize");
}
[[gnu::always_inline]] inline void expect_row(int row, int rows) {
  if (unsigned(row) >= unsigned(rows)) [[unlikely]] refuse_row<char>("linearize", row, rows);
}

}  // namespace inner

/// One end of a constraint: the blocks that move one material point, where the law enters its directions.
template <class T>
class RowEnd {
 public:
  RowEnd(const WorldView<T>& world, const RowArrays<T>& rows, const Anchor& anchor, const Vec3& point)
      : anchor_(anchor), point_(point), rows_(rows.rows) {
    if (anchor.set < 0) return;
    set_ = &world.set(anchor);
    const SetArrays<T>& blocks = rows.set[anchor.set];
    set_->table->add_blocks(set_->set, anchor, *blocks.block);
    H_ = blocks.H;
    first_ = H_->size();
    H_->resize(blocks.block->size() * std::size_t(rows_) * std::size_t(blocks.width));
  }

  /// Row k sees the velocity of the point along `direction`: u_k += direction · v(point).
  void along(int k, const Vec3& direction) {
    inner::expect_row(k, rows_);
    if (set_) set_->table->along(set_->set, anchor_, point_, direction, H(), rows_, k);
  }
  /// The first n rows see the velocity of the point along the rows of `axes`, times `sign`: one call for all of them.
  template <int n>
  void along(const Mat<n, 3>& axes, double sign) {
    inner::expect_row(n - 1, rows_);
    if (!set_) return;
    if constexpr (n == 3) set_->table->along_three(set_->set, anchor_, point_, axes, sign, H(), rows_);
    else
      for (int k = 0; k < n; ++k) along(k, Vec3(sign * axes(k, 0), sign * axes(k, 1), sign * axes(k, 2)));
  }
  /// The first three rows see the velocity of the point along the axes of the world, times `sign`.
  void along_axes(double sign) {
    inner::expect_row(2, rows_);
    if (set_) set_->table->along_axes(set_->set, anchor_, point_, sign, H(), rows_);
  }
  /// Row k sees the rate of turn about `axis`: u_k += axis · ω. The anchor must have a frame.
  void about(int k, const Vec3& axis) {
    inner::expect_row(k, rows_);
    if (set_ && set_->table->about) set_->table->about(set_->set, anchor_, axis, H(), rows_, k);
  }

 private:
  T* H() { return H_->data() + first_; }

  const Anchor& anchor_;
  Vec3 point_;
  const SetView<T>* set_ = nullptr;  ///< null: the world, which nothing moves
  Array<T>* H_ = nullptr;
  std::size_t first_ = 0;
  int rows_;
};

/// Writes H and φ of one item. A law never divides by h: φ becomes a rate in step/bias.hpp.
template <class T>
class RowWriter {
 public:
  RowWriter(const WorldView<T>& world, const RowArrays<T>& rows, Index item)
      : world_(world), rows_(rows), first_(std::size_t(item) * std::size_t(rows.rows)) {}

  /// The blocks that move the material point of `anchor` that is at `point` (world, m) now.
  RowEnd<T> end(const Anchor& anchor, const Vec3& point) { return {world_, rows_, anchor, point}; }

  /// Violation of row k, m or rad.
  void phi(int k, double value) {
    inner::expect_row(k, rows_.rows);
    (*rows_.phi)[first_ + std::size_t(k)] = T(value);
  }

  /// Makes row k a spring with a damper, N/m and N·s/m (N·m/rad and N·m·s/rad for a row about an axis). A row of kind
  /// `friction` is one only if its law has speed(item).
  void soft(int k, double stiffness, double damping) {
    inner::expect_row(k, rows_.rows);
    (*rows_.stiffness)[first_ + std::size_t(k)] = T(stiffness);
    (*rows_.damping)[first_ + std::size_t(k)] = T(damping);
  }

 private:
  const WorldView<T>& world_;
  const RowArrays<T>& rows_;
  std::size_t first_;
};

}  // namespace delassus
