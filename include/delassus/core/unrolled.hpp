/// Loops whose index is a constant.
#pragma once

#include <utility>

namespace delassus {

/// `unrolled<3>([&]<int k>() { … })`: f for k = 0 … n − 1. What is reached through constants alone stays in
/// registers, where g++ 12 keeps what a loop has indexed in memory.
template <int n, class F>
[[gnu::always_inline]] constexpr void unrolled(F&& f) {
  [&]<int... k>(std::integer_sequence<int, k...>) __attribute__((always_inline)) { (f.template operator()<k>(), ...); }
  (std::make_integer_sequence<int, n>{});
}

}  // namespace delassus
