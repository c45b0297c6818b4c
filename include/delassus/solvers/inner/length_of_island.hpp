/// The length at which an island counts turns as motions.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/index.hpp>
#include <delassus/solvers/law_table.hpp>

#include <cstddef>

namespace delassus::inner {

/// L, m: L² is the mean (H A⁻¹ Hᵀ)_kk of rows in m/s over that of rows in rad/s. It is as large as the arms of the joints and the
/// radii of gyration. 1 where one of the units is missing: what is summed then has one unit anyway.
struct LengthOfRows {
  double sum[2] = {}, count[2] = {};

  void add(bool turns, double response) {
    if (response > 0) sum[turns] += response, ++count[turns];
  }
  template <class T>
  void add(const RowView<T>& pool, Index i) {
    for (int k = 0; k < pool.rows; ++k) {
      const std::ptrdiff_t row = std::ptrdiff_t(pool.rows) * i + k;
      const double whole = double(pool.own_block(i)[k * (pool.rows + 1)]);
      add(pool.turn(k), (whole - double(pool.compliance[row])) / (1 + double(pool.relative_compliance[row])));
    }
  }
  double square() const {
    const double square = (sum[0] / count[0]) / (sum[1] / count[1]);
    return square > 0 && std::isfinite(square) ? square : 1;
  }
  double length() const { return std::sqrt(square()); }
};

template <class T>
double length_of_island(const Span<T>* begin, const Span<T>* end) {
  bool has_turns = false;
  for (const Span<T>* span = begin; span != end; ++span) has_turns = has_turns || span->pool->turns != 0;
  if (!has_turns) return 1;
  LengthOfRows rows;
  for (const Span<T>* span = begin; span != end; ++span)
    for (const Index i : *span) rows.add(*span->pool, i);
  return rows.length();
}

}  // namespace delassus::inner
