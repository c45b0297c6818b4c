/// The point of an ellipsoid nearest to a given point, inside or outside: one root of a monotone function.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/math/linear.hpp>

#include <algorithm>

namespace delassus::inner {

/// `distance` < 0 inside; `normal` is the unit outward direction from the surface to the point (or out, when
/// inside).
struct NearestSurface {
  Vec3 normal;
  double distance;
};

/// The root s of Σ (aᵢ pᵢ / (s + δᵢ))² = 1. With f(s) the sum, 1/√f is concave and increasing, so Newton's
/// steps on 1/√f = 1 come from the left and never pass the root; `start` itself when f(start) ≤ 1.
/// The same function is solved for the step of a trust region: [MoreSorensen1983].
double secular_root(const std::same_as<Vec3> auto& a, const Vec3& p, const Vec3& delta, double start) {
  double s = start;
  for (int iteration = 0; iteration < 60; ++iteration) {
    double f = 0, slope = 0;  // slope = −f'/2
    for (int k = 0; k < 3; ++k) {
      const double x = p[k] > 0 ? a[k] * p[k] / (s + delta[k]) : 0.0;
      f += x * x;
      if (x > 0) slope += x * x / (s + delta[k]);
    }
    const double step = f * (std::sqrt(f) - 1) / slope;
    if (!(step > 1e-16 * s)) break;
    s += step;
  }
  return s;
}

/// The nearest point x of the surface has p − x = t D⁻² x, so xᵢ = aᵢ² pᵢ / (t + aᵢ²); with the least
/// semi-axis a_m, s = t + a_m² ≥ 0 and δᵢ = aᵢ² − a_m² it lies on the surface when
///
///   Σ (aᵢ pᵢ / (s + δᵢ))² = 1.
///
/// When the sum is below 1 at s = 0, p is inside, in the plane across the least axis, and x rises from it
/// along that axis: either way is right, the one of `wish` is taken. Lengths relative to the largest
/// semi-axis. The equation is that of [Eberly2013].
NearestSurface nearest_surface_of_ellipsoid(const Vec3& axes, const std::same_as<Vec3> auto& point, const Vec3& wish) {
  const double size = max_entry(axes);
  const Vec3 a = axes / size, p = Vec3(std::abs(point[0]), std::abs(point[1]), std::abs(point[2])) / size;
  int least = 0;
  for (const int k : {1, 2})
    if (a[k] < a[least]) least = k;
  Vec3 delta, x;
  double start = 0;
  for (int k = 0; k < 3; ++k) {
    delta[k] = (a[k] - a[least]) * (a[k] + a[least]);
    start = std::max(start, a[k] * p[k] - delta[k]);
  }
  const double s = secular_root(a, p, delta, start);
  double rest = 1;
  for (int k = 0; k < 3; ++k) {
    x[k] = s + delta[k] > 0 ? a[k] * (a[k] * p[k] / (s + delta[k])) : 0.0;
    if (k != least) rest -= (x[k] / a[k]) * (x[k] / a[k]);
  }
  if (!(s > 0)) x[least] = a[least] * std::sqrt(std::max(0.0, rest));
  Vec3 gradient;
  for (int k = 0; k < 3; ++k)
    gradient[k] = std::copysign(x[k] / (a[k] * a[k]), point[k] != 0 ? point[k] : wish[k]);
  const double steepness = norm(gradient);
  return {gradient / steepness, size * (s - a[least] * a[least]) * steepness};
}

}  // namespace delassus::inner
