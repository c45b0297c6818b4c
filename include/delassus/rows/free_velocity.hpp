/// What W says of one item: its free velocity, its velocity, and what a change of its impulse does.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>
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
/// The same where it lies, if the type asks for no more than numbers have.
template <int R, class T>
[[gnu::always_inline]] inline decltype(auto) as_square(const T* at) {
  if constexpr (std::is_same_v<T, double> && alignof(Mat<R, R, double>) <= __STDCPP_DEFAULT_NEW_ALIGNMENT__)
    return (*reinterpret_cast<const Mat<R, R, double>*>(at));
  else
    return load_square<R>(at);
}
template <int R, class T>
[[gnu::always_inline]] inline void store(const Vec<R, double>& x, T* at) {
  DELASSUS_UNROLL
  for (int k = 0; k < R; ++k) at[k] = T(x.data()[k]);
}

/// r = d_i + Σ_{j ≠ i} W_ij λ_j over square blocks. Large terms cancel here: the sum runs in double whatever is stored.
template <int R, class T>
[[gnu::always_inline]] inline void sum_of_squares(const RowView<T>& view, Index i, double* r) {
  DELASSUS_UNROLL
  for (int k = 0; k < R; ++k) r[k] = double(view.d[std::ptrdiff_t(R) * i + k]);
  for (const BlockRowsView<T>*W = view.blocks, *end = W + view.block_rows; W != end; ++W)
    add_row<R>(r, W->start[i], W->start[i + 1], W->block, W->column, W->lambda);
}
/// The same over all blocks.
template <int R, class T>
[[gnu::noinline]] void sum_of_blocks(const RowView<T>& view, Index i, double* r) {
  for (int k = 0; k < R; ++k) r[k] = double(view.d[std::ptrdiff_t(R) * i + k]);
  for (const BlockRowsView<T>*W = view.blocks, *end = W + view.block_rows; W != end; ++W) {
    if (W->columns == R) add_row<R>(r, W->start[i], W->start[i + 1], W->block, W->column, W->lambda);
    else add_wide_row<R>(r, W->start[i], W->start[i + 1], W->block, W->column, W->lambda, W->columns);
  }
}

/// u = (d + W λ)_i from A⁻¹ Hᵀ λ of the bodies, or by W's own function.
template <int R, class T>
void residual_without_blocks(const RowView<T>& view, Index i, double* r) {
  if (view.form == FormOfW::functions) {
    T u[R];
    view.functions.residual(view.functions, view.pool, i, u);
    for (int k = 0; k < R; ++k) r[k] = double(u[k]);
  } else {
    for (int k = 0; k < R; ++k) r[k] = double(view.d[std::ptrdiff_t(R) * i + k]);
    for (const SetBlocksView<T>*set = view.set, *end = set + view.sets; set != end; ++set)
      for (Index e = set->offset[i]; e < set->offset[i + 1]; ++e) {
        const T* H = set->H + std::ptrdiff_t(R * set->width) * e;
        const double* y = set->y + std::ptrdiff_t(set->width) * set->block[e];
        double product[R];
        for (int k = 0; k < R; ++k) product[k] = double(H[k]) * y[0];
        for (int j = 1; j < set->width; ++j)
          for (int k = 0; k < R; ++k) product[k] += double(H[k + R * j]) * y[j];
        for (int k = 0; k < R; ++k) r[k] += product[k];
      }
    for (int k = 0; k < R; ++k)
      r[k] += double(view.on_diagonal[std::ptrdiff_t(R) * i + k] * view.lambda[std::ptrdiff_t(R) * i + k]);
  }
}

/// d_i + Σ_{j ≠ i} W_ij λ_j: what the rows would do without this constraint; of a W that is not square blocks.
template <int R, class T>
[[gnu::noinline]] Vec<R, double> free_velocity_otherwise(const RowView<T>& view, Index i) {
  Vec<R, double> u;
  if (view.is_matrix() || (view.form == FormOfW::mixed && !view.crowded[i].is_crowded)) {
    sum_of_blocks<R>(view, i, u.data());
  } else {
    residual_without_blocks<R>(view, i, u.data());
    u -= load_square<R>(view.own_diagonal + std::ptrdiff_t(R * R) * i) * load<R>(view.lambda + std::ptrdiff_t(R) * i);
  }
  return u;
}
template <int R, class T>
[[gnu::always_inline]] inline Vec<R, double> free_velocity(const RowView<T>& view, Index i) {
  if (view.form != FormOfW::square_blocks) return free_velocity_otherwise<R>(view, i);
  double r[R];
  sum_of_squares<R>(view, i, r);
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
    residual_without_blocks<R>(view, i, u.data());
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
[[gnu::always_inline]] inline double free_normal_velocity(const RowView<T>& view, Index i) {
  double sum = double(view.d[3 * std::ptrdiff_t(i)]);
  for (const BlockRowsView<T>*W = view.blocks, *end = W + view.block_rows; W != end; ++W)
    sum += first_of_row(W->start[i], W->start[i + 1], W->block, W->column, W->lambda, W->columns);
  return sum;
}

/// What W hears of a change of λ_i where it is no matrix.
template <int R, class T>
[[gnu::noinline]] void tell_change(const RowView<T>& view, Index i, const double* change) {
  if (view.form == FormOfW::functions) {
    T numbers[R];
    for (int k = 0; k < R; ++k) numbers[k] = T(change[k]);
    view.functions.changed(view.functions, view.pool, i, numbers);
  } else if (view.form == FormOfW::bodies || view.crowded[i].meets_crowded) {
    for (const SetBlocksView<T>*set = view.set, *end = set + view.sets; set != end; ++set)
      for (Index e = set->offset[i]; e < set->offset[i + 1]; ++e) {
        const int w = set->width;
        const T* G = set->G + std::ptrdiff_t(R * w) * e;
        double* y = set->y + std::ptrdiff_t(w) * set->block[e];
        for (int j = 0; j < w; ++j) {
          double sum = double(G[j]) * change[0];
          for (int k = 1; k < R; ++k) sum += double(G[j + w * k]) * change[k];
          y[j] += sum;
        }
      }
  }
}
template <int R, class T>
[[gnu::always_inline]] inline void impulse_changed(const RowView<T>& view, Index i, const Vec<R, double>& change) {
  if (!view.is_matrix()) tell_change<R>(view, i, change.data());
}

}  // namespace delassus::inner
