/// The pairs of an element's nodes, in the order in which its stiffness is made.
#pragma once

#include <array>

namespace delassus::inner {

/// The pairs of an element's n nodes: (0, 1), (0, 2), … (n − 2, n − 1).
template <int n>
inline constexpr auto pairs_of_nodes = [] {
  std::array<std::array<int, 2>, n*(n - 1) / 2> pairs{};
  for (int a = 0, k = 0; a < n; ++a)
    for (int b = a + 1; b < n; ++b, ++k) pairs[k] = {a, b};
  return pairs;
}();

}  // namespace delassus::inner
