/// One row of a block-sparse matrix times a vector of blocks.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>

namespace delassus::inner {

/// r += Σ_e W_e x_{column(e)}, e = 0 … count − 1, in the scalar of r.
template <int Ra, int Rb, class Sum, class S, class T>
inline void add_row(Vec<Ra, Sum>& r, Index count, const Mat<Ra, Rb, S>* W, const Index* column,
                    const Vec<Rb, T>* x) {
  for (Index e = 0; e < count; ++e)
    r.noalias() += W[e].template cast<Sum>() * x[column[e]].template cast<Sum>();
}

/// The same for the 3 × 3 blocks of contacts, column by column in four lanes: the columns of W begin at its
/// entries 0, 3 and 6; four entries from 0, 3 and 5 on hold them, the last with its first lane idle, and none
/// lies outside of the block. Three sums, one a column, so that no addition waits for the one before it.
inline void add_row(Vec<3>& r, Index count, const Mat<3, 3>* W, const Index* column, const Vec<3>* x) {
  double first[4] = {}, second[4] = {}, third[4] = {};
  for (Index e = 0; e < count; ++e) {
    const double* w = W[e].data();
    const double* y = x[column[e]].data();
    for (int k = 0; k < 4; ++k) first[k] += w[k] * y[0];
    for (int k = 0; k < 4; ++k) second[k] += w[k + 3] * y[1];
    for (int k = 0; k < 4; ++k) third[k] += w[k + 5] * y[2];
  }
  for (int k = 0; k < 3; ++k) r[k] += (first[k] + second[k]) + third[k + 1];
}

}  // namespace delassus::inner
