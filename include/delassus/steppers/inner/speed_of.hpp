/// How fast a body goes, as the unit of what a stepper may miss by.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/index.hpp>
#include <delassus/math/twist.hpp>
#include <delassus/rows/anchor.hpp>
#include <delassus/rows/row_system.hpp>

#include <algorithm>
#include <limits>

namespace delassus::inner {

/// Of its centre, m/s. Where that stands, a thousandth of the speed at the radius of gyration √(tr I/2m): a
/// shaft that turns in its bearings has a unit too.
template <class Set, class Velocity>
double speed_of(const Set& set, Index b, const Velocity& v) {
  const double along = norm(linear_part(v));
  if constexpr (requires { set.inertia(b)(0, 0) / set.mass(b); }) {
    const auto& inertia = set.inertia(b);
    const double mass = double(set.mass(b)), sum = double(inertia(0, 0) + inertia(1, 1) + inertia(2, 2));
    if (mass > 0) return std::max(along, 1e-3 * std::sqrt(sum / (2 * mass)) * double(norm(angular_part(v))));
  }
  return along;
}

/// What rounding may leave of φ, m: rows are differences of places and of arms, each of which is rounded.
template <class T, class World, class Laws, class Rows>
double rounding_of_places(World& world, const Laws& laws, const Rows& rows) {
  double reach = 0;
  world.each([&](auto& set, auto) {
    for (const Index b : set.active()) reach = std::max(reach, double(norm(set.pose(b).position)));
  });
  each_pool(rows, [&](auto p, const auto& pool) {
    for (Index i = 0; i < pool.items(); ++i)
      each_end(laws.template pool<p>().item(i), [&](const Anchor& end) { reach = std::max(reach, norm(end.local)); });
  });
  return 64 * std::numeric_limits<T>::epsilon() * reach;
}

}  // namespace delassus::inner
