/// What W says of one item: its free velocity, its velocity, and what a change of its impulse does.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/math/two_lanes.hpp>
#include <delassus/rows/block_row.hpp>
#include <delassus/rows/row_view.hpp>

#include <cstddef>
#include <type_traits>

namespace delassus::inner {

// A law and its items are solved in double, whatever scalar the rows have: free velocities are sums of large terms that cancel,
// and what a sum in single precision leaves is as large as what a law should see.

/// R numbers from `at`, and back.
template <int R, class T>
[[gnu::always_inline]] inline Vec<R, double> load(const T* at) {
  Vec<R, double> x;
  DELASSUS_UNROLL
  for (int k = 0; k < R; ++k) x.data()[k] = double(at[k]);
  return x;
}
template <int R, class T>
[[gnu::always_inline]] inline Mat<R, R, double> load_square(const T* at) {
  Mat<R, R, double> x;
  DELASSUS_UNROLL
  for (int k = 0; k < R * R; ++k) x.data()[k] = double(at[k]);
  return x;
}
/// The same where it lies, if the type asks for no more than the alignment of a number: blocks follow each
/// other with no gap.
template <int R, class T>
[[gnu::always_inline]] inline decltype(auto) as_square(const T* at) {
  if constexpr (std::is_same_v<T, double> && alignof(Mat<R, R, double>) <= alignof(T))
    return (*reinterpret_cast<const Mat<R, R, double>*>(at));
  else
    return load_square<R>(at);
}
template <int R, class T>
[[gnu::always_inline]] inline void store(const Vec<R, double>& x, T* at) {
  DELASSUS_UNROLL
  for (int k = 0; k < R; ++k) at[k] = T(x.data()[k]);
}

/// r = d_i + Σ_{j ≠ i} W_ij λ_j. Large terms cancel here: the sum runs in double whatever is stored.
template <int R, class T>
[[gnu::always_inline]] inline void sum_of_squares(const RowView<T>& view, Index i, double* r) {
  DELASSUS_UNROLL
  for (int k = 0; k < R; ++k) r[k] = double(view.d[std::ptrdiff_t(R) * i + k]);
  const BlockRowsView<T>& W = *view.blocks;
  add_row<R>(r, W.start[i], W.start[i + 1], W.block, W.column, W.lambda);
}
/// The same over all blocks, of any width.
template <int R, class T>
[[gnu::noinline]] void sum_of_blocks(const RowView<T>& view, Index i, double* r) {
  for (int k = 0; k < R; ++k) r[k] = double(view.d[std::ptrdiff_t(R) * i + k]);
  for (const BlockRowsView<T>*W = view.blocks, *end = W + view.block_rows; W != end; ++W) {
    if (W->columns == R) add_row<R>(r, W->start[i], W->start[i + 1], W->block, W->column, W->lambda);
    else add_wide_row<R>(r, W->start[i], W->start[i + 1], W->block, W->column, W->lambda, W->columns);
  }
}

/// r += Σ_e H_e y_{block(e)} over the entries of item i in a body set.
template <int R, class T>
[[gnu::always_inline]] inline void add_velocity_of_bodies(const SetBlocksView<T>& set, Index i, double* r, int width) {
  for (Index e = set.offset[i], end = set.offset[i + 1]; e < end; ++e)
    add_block<R>(r, set.H + std::ptrdiff_t(R) * width * e, set.y + std::ptrdiff_t(width) * set.block[e], width);
}
template <int R, class T>
[[gnu::noinline]] void add_velocity_of_bodies_otherwise(const SetBlocksView<T>& set, Index i, double* r) {
  add_velocity_of_bodies<R>(set, i, r, set.width);
}

/// u = (d + W λ)_i from A⁻¹ Hᵀ λ of the bodies, or by W's own function.
template <int R, class T>
[[gnu::always_inline]] inline Vec<R, double> velocity_without_blocks(const RowView<T>& view, Index i) {
  if (view.form == FormOfW::functions) {
    T u[R];
    view.functions.residual(view.functions, view.pool, i, u);
    return load<R>(u);
  }
  Vec<R, double> u = load<R>(view.d + std::ptrdiff_t(R) * i);
  for (const SetBlocksView<T>*set = view.set, *end = set + view.sets; set != end; ++set) {
    if (set->width == 6) {
      add_velocity_of_bodies<R>(*set, i, u.data(), 6);
    } else {
      double sum[R];
      store(u, sum);
      add_velocity_of_bodies_otherwise<R>(*set, i, sum);
      u = load<R>(sum);
    }
  }
  DELASSUS_UNROLL
  for (int k = 0; k < R; ++k)
    u.data()[k] += double(view.on_diagonal[std::ptrdiff_t(R) * i + k] * view.lambda[std::ptrdiff_t(R) * i + k]);
  return u;
}

template <int R, class T>
[[gnu::noinline]] void free_velocity_without_blocks(const RowView<T>& view, Index i, double* r) {
  const Vec<R, double> own = load_square<R>(view.own_diagonal + std::ptrdiff_t(R * R) * i) * load<R>(view.lambda + std::ptrdiff_t(R) * i);
  store(Vec<R, double>(velocity_without_blocks<R>(view, i) - own), r);
}
/// The same where all bodies are rigid: what most matrix-free W are, without a call and what it keeps.
template <int R, class T>
[[gnu::always_inline]] inline void free_velocity_of_rigid_bodies(const RowView<T>& view, Index i, double* r) {
  const T* const lambda = view.lambda + std::ptrdiff_t(R) * i;
  double own[R] = {};
  add_square_block<R>(own, view.own_diagonal + std::ptrdiff_t(R * R) * i, lambda);
  DELASSUS_UNROLL
  for (int k = 0; k < R; ++k) r[k] = double(view.d[std::ptrdiff_t(R) * i + k]);
  add_velocity_of_bodies<R>(*view.set, i, r, 6);
  DELASSUS_UNROLL
  for (int k = 0; k < R; ++k) r[k] = r[k] + double(view.on_diagonal[std::ptrdiff_t(R) * i + k] * lambda[k]) - own[k];
}

/// d_i + Σ_{j ≠ i} W_ij λ_j: what the rows would do without this constraint; of a W that is not square blocks.
template <int R, class T>
[[gnu::noinline]] void free_velocity_otherwise(const RowView<T>& view, Index i, double* r) {
  if (view.form == FormOfW::bodies && view.sets == 1 && view.set->width == 6)
    free_velocity_of_rigid_bodies<R>(view, i, r);
  else if (view.is_matrix() || (view.form == FormOfW::mixed && !view.crowded[i].is_crowded))
    sum_of_blocks<R>(view, i, r);
  else
    free_velocity_without_blocks<R>(view, i, r);
}
// What a call writes into has a place in memory, and what the caller makes of it has none: else it would pass through memory
// where no call is made, too.
template <int R, class T>
[[gnu::always_inline]] inline Vec<R, double> free_velocity(const RowView<T>& view, Index i) {
  if (view.form == FormOfW::square_blocks) {
    double r[R];
    sum_of_squares<R>(view, i, r);
    return load<R>(r);
  }
  double r[R];
  free_velocity_otherwise<R>(view, i, r);
  return load<R>(r);
}

/// u_i = (d + W λ)_i.
template <int R, class T>
[[gnu::noinline]] Vec<R, double> velocity_otherwise(const RowView<T>& view, Index i) {
  Vec<R, double> u;
  const T *own = view.diagonal + std::ptrdiff_t(R * R) * i, *lambda = view.lambda + std::ptrdiff_t(R) * i;
  if (view.is_matrix() || (view.form == FormOfW::mixed && !view.crowded[i].is_crowded)) {
    sum_of_blocks<R>(view, i, u.data());
    add_square_block<R>(u.data(), own, lambda);
  } else {
    u = velocity_without_blocks<R>(view, i);
    if (view.diagonal != view.own_diagonal)  // lifted
      u += (load_square<R>(own) - load_square<R>(view.own_diagonal + std::ptrdiff_t(R * R) * i)) * load<R>(lambda);
  }
  return u;
}
template <int R, class T>
[[gnu::always_inline]] inline Vec<R, double> velocity(const RowView<T>& view, Index i) {
  if (view.form != FormOfW::square_blocks) return velocity_otherwise<R>(view, i);
  double r[R];
  sum_of_squares<R>(view, i, r);
  add_square_block<R>(r, view.diagonal + std::ptrdiff_t(R * R) * i, view.lambda + std::ptrdiff_t(R) * i);
  return load<R>(r);
}

/// The first row of the free velocity, of three. Pre: W is a matrix.
template <class T>
[[gnu::noinline]] double free_normal_velocity_otherwise(const RowView<T>& view, Index i) {
  double sum = double(view.d[3 * std::ptrdiff_t(i)]);
  for (const BlockRowsView<T>*W = view.blocks, *end = W + view.block_rows; W != end; ++W)
    sum += W->columns == 3 ? first_of_row(W->start[i], W->start[i + 1], W->block, W->column, W->lambda)
                           : first_of_wide_row(W->start[i], W->start[i + 1], W->block, W->column, W->lambda, W->columns);
  return sum;
}
template <class T>
[[gnu::always_inline]] inline double free_normal_velocity(const RowView<T>& view, Index i) {
  if (view.form != FormOfW::square_blocks) return free_normal_velocity_otherwise(view, i);
  const BlockRowsView<T>& W = *view.blocks;
  return double(view.d[3 * std::ptrdiff_t(i)]) + first_of_row(W.start[i], W.start[i + 1], W.block, W.column, W.lambda);
}

/// y_{block(e)} += G_e δ over the entries of item i in a body set of even width. All of a block is read before anything is
/// written, so that no number has to be read twice.
template <int R, int width, class T>
[[gnu::always_inline]] inline void add_change_of_bodies(const SetBlocksView<T>& set, Index i, const double* change) {
  for (Index e = set.offset[i], end = set.offset[i + 1]; e < end; ++e) {
    const T* G = set.G + std::ptrdiff_t(R * width) * e;
    double* y = set.y + std::ptrdiff_t(width) * set.block[e];
    TwoLanes sum[width / 2];
    for (int j = 0; j < width / 2; ++j) sum[j] = two_lanes_at(G + 2 * j) * change[0];
    DELASSUS_UNROLL
    for (int k = 1; k < R; ++k)
      for (int j = 0; j < width / 2; ++j) sum[j] += two_lanes_at(G + 2 * j + width * k) * change[k];
    for (int j = 0; j < width / 2; ++j) put_two_lanes(two_lanes_at(y + 2 * j) + sum[j], y + 2 * j);
  }
}
/// The same of bodies of any width.
template <int R, class T>
[[gnu::noinline]] void add_change_of_bodies_otherwise(const SetBlocksView<T>& set, Index i, const double* change) {
  const int width = set.width;
  for (Index e = set.offset[i], end = set.offset[i + 1]; e < end; ++e) {
    const T* G = set.G + std::ptrdiff_t(R) * width * e;
    double* y = set.y + std::ptrdiff_t(width) * set.block[e];
    for (int j = 0; j < width; ++j) {
      double sum = double(G[j]) * change[0];
      for (int k = 1; k < R; ++k) sum += double(G[j + width * k]) * change[k];
      y[j] += sum;
    }
  }
}

/// What W hears of a change of λ_i where it is no matrix.
template <int R, class T>
[[gnu::noinline]] void tell_change_otherwise(const RowView<T>& view, Index i, const double* change) {
  if (view.form == FormOfW::functions) {
    T numbers[R];
    for (int k = 0; k < R; ++k) numbers[k] = T(change[k]);
    view.functions.changed(view.functions, view.pool, i, numbers);
  } else if (view.form == FormOfW::bodies || view.crowded[i].meets_crowded) {
    for (const SetBlocksView<T>*set = view.set, *end = set + view.sets; set != end; ++set) {
      if (set->width == 6) add_change_of_bodies<R, 6>(*set, i, change);
      else add_change_of_bodies_otherwise<R>(*set, i, change);
    }
  }
}
template <int R, class T>
[[gnu::noinline]] void tell_change(const RowView<T>& view, Index i, const double* change) {
  if (view.form == FormOfW::bodies && view.sets == 1 && view.set->width == 6)
    add_change_of_bodies<R, 6>(*view.set, i, change);
  else
    tell_change_otherwise<R>(view, i, change);
}
template <int R, class T>
[[gnu::always_inline]] inline void impulse_changed(const RowView<T>& view, Index i, const Vec<R, double>& change) {
  if (view.is_matrix()) return;
  double numbers[R];
  store(change, numbers);
  tell_change<R>(view, i, numbers);
}

}  // namespace delassus::inner
