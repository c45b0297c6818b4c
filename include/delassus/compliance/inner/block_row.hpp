/// One row of a block-sparse matrix times a vector of blocks.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>

#include <Eigen/Core>

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
  using Lanes = Eigen::Array<double, 4, 1>;
  using Columns = Eigen::Map<const Lanes>;
  Lanes first = Lanes::Zero(), second = Lanes::Zero(), third = Lanes::Zero();
  for (Index e = 0; e < count; ++e) {
    const double* w = W[e].data();
    const double* y = x[column[e]].data();
    first += Columns(w) * y[0];
    second += Columns(w + 3) * y[1];
    third += Columns(w + 5) * y[2];
  }
  const Lanes both = first + second;
  r[0] += both[0] + third[1], r[1] += both[1] + third[2], r[2] += both[2] + third[3];
}

}  // namespace delassus::inner
