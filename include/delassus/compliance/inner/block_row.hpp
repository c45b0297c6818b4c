/// One row of a block-sparse matrix times a vector of blocks.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/math/two_lanes.hpp>

#include <cstring>

namespace delassus::inner {

/// r += Σ_e W_e x_{column(e)}, e = 0 … count − 1, in the scalar of r.
template <int Ra, int Rb, class Sum, class S, class T>
inline void add_row(Vec<Ra, Sum>& r, Index count, const Mat<Ra, Rb, S>* W, const Index* column,
                    const Vec<Rb, T>* x) {
  for (Index e = 0; e < count; ++e)
    r += Mat<Ra, Rb, Sum>(W[e].template cast<Sum>()) * Vec<Rb, Sum>(x[column[e]].template cast<Sum>());
}

/// Σ_e (W_e x_{column(e)})₀: the first of those rows alone, at a third of the products. Entries take turns
/// with two sums, since an addition takes as long as the loads of two.
template <int Rb, class S, class T>
inline double first_of_row(Index count, const Mat<3, Rb, S>* W, const Index* column, const Vec<Rb, T>* x) {
  double even[Rb] = {}, odd[Rb] = {};
  const auto add = [&](double* sum, Index e) {
    for (int k = 0; k < Rb; ++k) sum[k] += double(W[e](0, k)) * double(x[column[e]][k]);
  };
  Index e = 0;
  for (; e + 1 < count; e += 2) {
    add(even, e);
    add(odd, e + 1);
  }
  if (e < count) add(even, e);
  double all = 0;
  for (int k = 0; k < Rb; ++k) all += even[k] + odd[k];
  return all;
}

#ifdef __AVX__
/// Where four numbers fit in a register, a column of the block at a time: the fourth number of the first two
/// is the next column's, and the third column is read from the entry before it, so that nothing outside of
/// the block is touched.
typedef double Four __attribute__((vector_size(4 * sizeof(double))));

struct ColumnSums {
  Four first{}, second{}, third{};

  void add(const double* w, const double* y) {
    Four a, b, c;
    std::memcpy(&a, w, sizeof a);
    std::memcpy(&b, w + 3, sizeof b);
    std::memcpy(&c, w + 5, sizeof c);
    first += a * y[0];
    second += b * y[1];
    third += c * y[2];
  }
};

inline void add_row(Vec<3>& r, Index count, const Mat<3, 3>* W, const Index* column, const Vec<3>* x) {
  ColumnSums even, odd;
  Index e = 0;
  for (; e + 1 < count; e += 2) {
    even.add(W[e].data(), x[column[e]].data());
    odd.add(W[e + 1].data(), x[column[e + 1]].data());
  }
  if (e < count) even.add(W[e].data(), x[column[e]].data());
  for (int k = 0; k < 3; ++k)
    r[k] += (even.first[k] + odd.first[k]) + (even.second[k] + odd.second[k]) +
            (even.third[k + 1] + odd.third[k + 1]);
}
#else
/// The same for the 3 × 3 blocks of contacts, two entries at a time as they lie, column by column:
///
///   (w₀₀ w₁₀) x₀,  (w₂₀ w₀₁) (x₀ x₁),  (w₁₁ w₂₁) x₁,  (w₀₂ w₁₂) x₂,  w₂₂ x₂,
///
/// each into a sum of its own, so that no addition waits for the one before it. Of arrays and loops compilers made
/// nine scalar products of a 3 × 3 block.
inline void add_row(Vec<3>& r, Index count, const Mat<3, 3>* W, const Index* column, const Vec<3>* x) {
  TwoLanes first{}, across{}, second{}, third{};
  double last = 0;
  for (Index e = 0; e < count; ++e) {
    const double* w = W[e].data();
    const double* y = x[column[e]].data();
    first += two_lanes_at(w) * y[0];
    across += two_lanes_at(w + 2) * two_lanes_at(y);
    second += two_lanes_at(w + 4) * y[1];
    third += two_lanes_at(w + 6) * y[2];
    last += w[8] * y[2];
  }
  r[0] += (first[0] + across[1]) + third[0];
  r[1] += (first[1] + second[0]) + third[1];
  r[2] += (across[0] + second[1]) + last;
}
#endif

}  // namespace delassus::inner
