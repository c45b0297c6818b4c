/// What a row asks of its violation.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace delassus {

/// equality φ = 0, λ free · lower φ ≥ 0, λ ≥ 0 · upper φ ≤ 0, λ ≤ 0 · friction: bounded by its law, with no φ but a spring's.
enum class RowKind : std::uint8_t { equality, lower, upper, friction };

/// Rows of one constraint, at most.
inline constexpr int most_rows = 32;

/// The kinds of a law's rows: its own `kinds`, else all equalities when it says `bilateral`, else all `lower`.
template <class Law>
constexpr std::array<RowKind, Law::rows> row_kinds() {
  if constexpr (requires { Law::kinds; }) {
    return Law::kinds;
  } else {
    constexpr bool is_bilateral = requires { requires Law::bilateral; };
    std::array<RowKind, Law::rows> kinds{};
    for (RowKind& kind : kinds) kind = is_bilateral ? RowKind::equality : RowKind::lower;
    return kinds;
  }
}

/// Bit k: row k is in rad/s and its impulse in N·m·s, by the law's own `turns`. The others are in m/s and N·s.
template <class Law>
constexpr unsigned turning_rows() {
  if constexpr (requires { Law::turns; }) return Law::turns & (~0u >> (most_rows - Law::rows));
  else return 0;
}

namespace inner {

/// Whether some of so many rows turn, and not all.
constexpr bool are_mixed(int rows, unsigned turns) { return turns != 0 && turns != ~0u >> (most_rows - rows); }

template <std::size_t rows>
constexpr bool are_equalities(const std::array<RowKind, rows>& kinds) {
  for (const RowKind kind : kinds)
    if (kind != RowKind::equality) return false;
  return true;
}

}  // namespace inner
}  // namespace delassus
