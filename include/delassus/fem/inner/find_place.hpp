/// Where a point is in the coordinates of an element whose shape functions are not linear.
#pragma once

#include <delassus/math/linear.hpp>

#include <array>
#include <cstddef>

namespace delassus::inner {

/// ξ with Σ_a N_a(ξ) x_a = point by Newton's method from `xi`; false where it finds none, as far outside of
/// the box around the nodes. `shape(a, ξ)` is N_a, `slope(x, ξ)` ∂x/∂ξ.
template <std::size_t nodes>
bool find_place(const std::array<Vec3, nodes>& x, const Vec3& point, auto&& shape, auto&& slope, Vec3& xi) {
  Vec3 low = x[0], high = x[0];
  for (const Vec3& p : x) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const double slack = 1e-3 * (high - low).norm();
  for (int i = 0; i < 3; ++i)
    if (!(point[i] >= low[i] - slack && point[i] <= high[i] + slack)) return false;
  double step = 1;
  for (int n = 0; n < 30 && step > 1e-15; ++n) {
    Vec3 rest = point;
    for (int a = 0; a < int(nodes); ++a) rest -= shape(a, xi) * x[a];
    const Vec3 by = inverse(slope(x, xi)) * rest;
    xi += by;
    step = by.norm();
  }
  return step < 1e-9;
}

}  // namespace delassus::inner
