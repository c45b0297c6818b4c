/// Rows that are laws of their own.
#pragma once

#include <delassus/rows/row_kind.hpp>

namespace delassus::inner {

/// Each row is an equality, or λ ≥ 0 with its complement, by itself.
constexpr bool has_rows_alone(const RowKind* kinds, int rows) {
  for (int k = 0; k < rows; ++k)
    if (kinds[k] != RowKind::equality && kinds[k] != RowKind::lower) return false;
  return true;
}
/// All rows are equalities.
constexpr bool are_equalities(const RowKind* kinds, int rows) {
  for (int k = 0; k < rows; ++k)
    if (kinds[k] != RowKind::equality) return false;
  return true;
}

}  // namespace delassus::inner
