/// Laws whose rows know nothing of each other.
#pragma once

#include <delassus/rows/row_kind.hpp>

namespace delassus::inner {

/// Each row of pool p is an equality, or λ ≥ 0 with its complement, by itself.
template <class Problem, int p>
constexpr bool has_rows_alone() {
  for (const RowKind kind : Problem::BookType::template kinds<p>())
    if (kind != RowKind::equality && kind != RowKind::lower) return false;
  return true;
}

}  // namespace delassus::inner
