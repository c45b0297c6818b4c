/// What couples two nodes of a body alike in every direction.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>

#include <algorithm>
#include <cstddef>

namespace delassus::inner {

/// Ψ = ½ k |x_i − x_j|², i < j: K_ij = −k 1. Single ones may have k < 0 where all together do not.
struct Tie {
  Index i, j;
  double k;  ///< N/m
};

/// The same by ascending pairs, each once.
inline Array<Tie> merged(Array<Tie> ties) {
  std::stable_sort(ties.begin(), ties.end(),
                   [](const Tie& a, const Tie& b) { return a.i != b.i ? a.i < b.i : a.j < b.j; });
  std::size_t count = 0;
  for (const Tie& t : ties)
    if (count > 0 && ties[count - 1].i == t.i && ties[count - 1].j == t.j)
      ties[count - 1].k += t.k;
    else
      ties[count++] = t;
  ties.resize(count);
  return ties;
}

}  // namespace delassus::inner
