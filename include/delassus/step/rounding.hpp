/// Whether what an island asks for is rounding of where its bodies are, and of how fast.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/math/twist.hpp>
#include <delassus/rows/body_set.hpp>
#include <delassus/solvers/island.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <type_traits>

namespace delassus::inner {

/// Redundant joints that agree contradict each other in the last digit, and where nothing moves there is
/// nothing else. Rounding is 16 ε ((|x| + L)/h + |v| + L |ω|), by the farthest and fastest of the bodies, x
/// and v of which are known to ε, and L the length of the island.
template <class World, class T>
bool is_all_rounding(const World& world, const Island<T>& island) {
  double place = 0, speed = 0, asked = 0;
  T u[most_rows];
  for (const Span<T>& span : island)
    for (const Index i : span) {
      island.velocity(span, i, u);
      asked = std::max({asked, island.square_of_velocity(span, u),
                        island.square_of_velocity(span, island.free_of_impulses(span, i))});
      world.each([&](const auto& set, auto s) {
        const auto& blocks = span.pool->set[s];
        for (Index e = blocks.offset[i]; e < blocks.offset[i + 1]; ++e) {
          const Index b = blocks.block[e];
          const auto v = converted<double>(set.velocity()[b]);
          if constexpr (requires { set.pose(b).position; })
            place = std::max(place, norm(set.pose(b).position));
          double faster = norm(linear_part(v));
          if constexpr (std::remove_cvref_t<decltype(set)>::width == 6)
            faster += island.length() * norm(angular_part(v));
          speed = std::max(speed, faster);
        }
      });
    }
  const double rounding =
      16 * double(std::numeric_limits<T>::epsilon()) * ((place + island.length()) / island.h() + speed);
  return std::sqrt(asked) <= rounding;
}

}  // namespace delassus::inner
