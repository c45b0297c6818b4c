/// EPA: the depth of two overlapping or touching cores, from the simplex where GJK stopped.
#pragma once

#include <delassus/collision/inner/descend.hpp>
#include <delassus/collision/inner/polytope.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/fixed_array.hpp>

#include <algorithm>
#include <limits>

namespace delassus::inner {

/// The best supporting plane found and the witnesses on it. h = h(normal) is the depth of the cores, m.
struct EpaResult {
  Vec3 normal = zero<Vec3>(), point_a = zero<Vec3>(), point_b = zero<Vec3>();
  double h = std::numeric_limits<double>::infinity();
};

/// A unit vector perpendicular to the unit vector `axis`, as near to `wish` as can be.
Vec3 perpendicular(const std::same_as<Vec3> auto& axis, const Vec3& wish) {
  const Vec3 across = wish - axis * dot(axis, wish);
  const double length = norm(across);
  if (length > 1e-6 * norm(wish)) return across / length;
  int k = 0;
  for (const int j : {1, 2})
    if (std::abs(axis[j]) < std::abs(axis[k])) k = j;
  return normalized(cross(axis, unit_axis(k)));
}

/// Grows the simplex to one more dimension: takes the support point that lies farthest from its hull.
/// False when the difference is flat there, to 1e-9 of `size`.
template <class D>
bool grow(const D& difference, FixedArray<DifferencePoint, 4>& p, int& count, double size) {
  DifferencePoint best{};
  double best_height = 0;
  const auto consider = [&](const Vec3& direction, const auto& height) {
    const DifferencePoint q = difference.core(direction);
    const double value = height(q.w - p[0].w);
    if (value > best_height) best = q, best_height = value;
  };
  if (count == 1) {
    for (int k = 0; k < 6; ++k)
      consider((k < 3 ? 1.0 : -1.0) * unit_axis(k % 3), [](const Vec3& d) { return norm(d); });
  } else if (count == 2) {
    const Vec3 axis = normalized(p[1].w - p[0].w), x = perpendicular(axis, unit_axis(0)),
               y = cross(axis, x);
    constexpr double c = 0.5, s = 0.86602540378443864676;
    constexpr double hexagon[6][2] = {{1, 0}, {c, s}, {-c, s}, {-1, 0}, {-c, -s}, {c, -s}};
    for (const auto& [u, v] : hexagon)
      consider(u * x + v * y, [&](const Vec3& d) { return norm(cross(d, axis)); });
  } else {
    const Vec3 normal = normalized(cross(p[1].w - p[0].w, p[2].w - p[0].w));
    for (const double sign : {1.0, -1.0})
      consider(sign * normal, [&](const Vec3& d) { return std::abs(dot(d, normal)); });
  }
  if (!(best_height > 1e-9 * size)) return false;
  p[count++] = best;
  return true;
}

/// The depth of a flat difference is that of its plane, line or point: any normal perpendicular to it will
/// do.
template <class D>
EpaResult flat_depth(const D& difference, const FixedArray<DifferencePoint, 4>& p, int count,
                     const Vec3& guess) {
  EpaResult r;
  r.point_a = p[0].a;
  r.point_b = p[0].b;
  if (count == 3) {
    const Vec3 normal = normalized(cross(p[1].w - p[0].w, p[2].w - p[0].w));
    const double up = dot(normal, difference.core(normal).w), down = -dot(normal, difference.core(-normal).w);
    const bool is_up = up != down ? up < down : dot(normal, guess) >= 0;
    r.normal = is_up ? normal : Vec3(-normal);
    r.h = is_up ? up : down;
    return r;
  }
  r.normal = count == 2 ? perpendicular(normalized(p[1].w - p[0].w), guess) : normalized(guess);
  r.h = dot(r.normal, difference.core(r.normal).w);
  return r;
}

/// The points of the simplex that span it: each adds a dimension of at least 1e-9 of `size`.
int independent(const std::same_as<Simplex> auto& s, double size, FixedArray<DifferencePoint, 4>& p) {
  int count = 0;
  for (int i = 0; i < s.count; ++i) {
    const Vec3 d = count > 0 ? Vec3(s.p[i].w - p[0].w) : zero<Vec3>();
    double height = size;
    if (count == 1) height = norm(d);
    if (count == 2) height = norm(cross(d, normalized(p[1].w - p[0].w)));
    if (count == 3) height = std::abs(dot(d, normalized(cross(p[1].w - p[0].w, p[2].w - p[0].w))));
    if (height > 1e-9 * size) p[count++] = s.p[i];
  }
  return count;
}

/// min over unit n of h(n), by outer approximation: the nearest face of the polytope bounds it below, the
/// support plane in that face's direction above. Every h(n) met is a valid depth, and the least of them is
/// the answer, so rounding in the polytope cannot make it wrong, only less than minimal. Ends when the bounds
/// meet to 3e-10 of the size; when points or faces are spent before (round bodies about one axis or centre), it
/// descends from the best normal. The origin may lie a little outside: then h < 0 is minus the distance.
/// Source: [VanDenBergen2001].
template <class D>
EpaResult epa(const D& difference, const Simplex& start, const Vec3& guess) {
  double size = 0, size_a = 0, size_b = 0;
  for (int k = 0; k < 3; ++k) {
    const DifferencePoint high = difference.core(unit_axis(k)), low = difference.core(-unit_axis(k));
    size = std::max(size, norm(high.w - low.w));
    size_a = std::max(size_a, norm(high.a - low.a));
    size_b = std::max(size_b, norm(high.b - low.b));
  }
  FixedArray<DifferencePoint, 4> corner;
  int count = independent(start, size, corner);
  while (count < 4)
    if (!grow(difference, corner, count, size)) return flat_depth(difference, corner, count, guess);

  const double tolerance = std::max(3e-10 * std::min(size_a, size_b), 1e-14 * size);
  Polytope polytope(corner);
  EpaResult best;
  FixedArray<DifferencePoint, 3> best_face;
  const auto consider = [&](const FixedArray<DifferencePoint, 3>& face, const Vec3& normal,
                            const DifferencePoint& q) {
    const double h = dot(normal, q.w);
    if (!(h < best.h)) return;
    best.h = h;
    best.normal = normal;
    best_face = face;
  };
  bool do_bounds_meet = false;
  while (!do_bounds_meet && !polytope.is_full()) {
    const int f = polytope.nearest_face();
    if (f < 0) break;
    const Polytope::Face& face = polytope.face(f);
    do_bounds_meet = best.h - face.offset <= tolerance;
    if (do_bounds_meet) break;
    const DifferencePoint q = difference.core(face.normal);
    consider(polytope.corners(f), face.normal, q);
    do_bounds_meet = dot(face.normal, q.w) - face.offset <= tolerance;
    if (!do_bounds_meet && !polytope.extend(q, 1e-14 * size)) polytope.retire(f);
  }
  if (best.h == std::numeric_limits<double>::infinity()) return best;
  // The foot h n lies in one triangle of the plane, which need not be the one that gave the plane.
  best_face = pierced_face(polytope, best.normal);
  if (!do_bounds_meet) descend(difference, best.normal, best_face, tolerance, consider);
  Simplex carrier{.p = {best_face[0], best_face[1], best_face[2]}, .count = 3};
  nearest_on_triangle(carrier);
  best.point_a = carrier.mix(&DifferencePoint::a);
  best.point_b = carrier.mix(&DifferencePoint::b);
  return best;
}

}  // namespace delassus::inner
