/// GJK: the distance of two convex cores, or the news that they overlap.
#pragma once

#include <delassus/collision/inner/simplex.hpp>
#include <delassus/collision/signed_pair.hpp>

#include <algorithm>
#include <limits>

namespace delassus::inner {

/// A simplex of A − B with the origin's nearest point on it, and the best separating direction seen.
struct GjkResult {
  Simplex simplex;
  Vec3 normal = zero<Vec3>();  ///< unit, from A to B
  double separation = 0;       ///< −h(normal) of the cores: a proven lower bound of their distance, m
  bool is_apart = false;       ///< separation > 0 and clear of rounding
};

/// Walks v, the point of A − B nearest to the origin; with n = −v/|v| each support point w proves
///
///   v·w/|v| = −h(n) ≤ distance ≤ |v|.
///
/// Ends when the bounds meet to 1e-10, when −h exceeds `margin`, or when the origin lies within 1e-10 of the
/// size of the difference. Then the direction of v holds no digits, and EPA goes on from the simplex. Source:
/// [GilbertJohnsonKeerthi1988]; the stopping bound is that of [VanDenBergen2003].
template <class D>
GjkResult gjk(const D& difference, Vec3 direction, double margin) {
  GjkResult r;
  r.separation = -std::numeric_limits<double>::infinity();
  r.simplex.add(difference.core(direction));
  r.simplex.weight[0] = 1;
  Vec3 v = r.simplex.p[0].w;
  double size = norm(v), length = size;
  // A bound that is open by ε of the length lets the normal lean by √2ε; below the rounding of A − B nothing
  // is seen.
  const auto slack = [&](double l) { return std::max(1e-14 * l, 2e-16 * size); };
  const auto prove = [&](const Vec3& n) {
    const DifferencePoint q = difference.core(n);
    size = std::max(size, norm(q.w));
    const double separation = -dot(n, q.w);
    if (separation > r.separation) r.separation = separation, r.normal = n;
    r.is_apart = r.separation > 1e-10 * size;
    return q;
  };
  int stuck = 0;
  for (int iteration = 0; iteration < 128 && length > 1e-10 * size; ++iteration) {
    const Vec3 n = -v / length;
    const DifferencePoint q = prove(n);
    if (r.separation > margin || length + dot(n, q.w) <= slack(length)) return r;
    for (int i = 0; i < r.simplex.count; ++i)
      if (squared_norm(q.w - r.simplex.p[i].w) <= 1e-28 * size * size) return r;
    const Simplex before = r.simplex;
    r.simplex.add(q);
    bool is_inside = false;
    v = nearest(r.simplex, is_inside);
    if (is_inside) {
      r.is_apart = false;
      return r;
    }
    const double next = norm(v);
    if (next >= length) {
      // As short as can be seen, but not yet as straight: a bound that is open by g across a simplex of the
      // length D shortens v by g² / D² only, which rounding hides.
      const double proven = r.separation;
      prove(-v / next);
      stuck = r.separation > proven ? 0 : stuck + 1;
      if (stuck == 8 || next > (1 + 1e-8) * length) {
        r.simplex = before;
        return r;
      }
    }
    length = next;
  }
  return r;
}

}  // namespace delassus::inner
