/// One front's share of a solve with L Lᵀ.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/linear/inner/dense_kernel.hpp>
#include <delassus/linear/supernodes.hpp>
#include <delassus/math/long_vectors.hpp>

#include <algorithm>

namespace delassus::inner {

// x is the supernode, w numbers a node, and L its columns. y is by places. `gather` has room for as many
// numbers as L has rows, which it takes there so that columns of L are read from end to end.

/// y ← L⁻¹ y in the front's own places. What it adds to those of its other rows waits in `gather`.
template <int w, class T>
void solve_forward(const Supernode& x, Columns<const T> L, T* y, T* gather) {
  const Index height = w * Index(x.rows.size()), width = w * x.width;
  std::copy_n(y + w * x.first, width, gather);
  std::fill_n(gather + width, height - width, T(0));
  for (Index j = 0; j < width; ++j) {
    const T at = gather[j] /= *L.at(j, j);
    add_multiple<T>(-at, L.at(j, j) + 1, gather + j + 1, height - j - 1);
  }
  std::copy_n(gather, width, y + w * x.first);
}
/// The front's rows first … last − 1 of y += what waits for them, row by row.
template <int w, class T>
void add_rows(const Supernode& x, Index first, Index last, const T* waits, T* y) {
  for (Index k = first; k < last; ++k)
    for (int c = 0; c < w; ++c) y[w * x.rows[k] + c] += *waits++;
}
/// y ← L⁻ᵀ y in the front's own places.
template <int w, class T>
void solve_backward(const Supernode& x, Columns<const T> L, T* y, T* gather) {
  const Index rows = Index(x.rows.size()), height = w * rows;
  for (Index k = 0; k < rows; ++k)
    for (int c = 0; c < w; ++c) gather[w * k + c] = y[w * x.rows[k] + c];
  for (Index j = w * x.width; j-- > 0;) {
    const T below = delassus::sum_of_products<T>(L.at(j, j) + 1, gather + j + 1, height - j - 1);
    gather[j] = (gather[j] - below) / *L.at(j, j);
  }
  std::copy_n(gather, w * x.width, y + w * x.first);
}

}  // namespace delassus::inner
