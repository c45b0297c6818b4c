/// One triangle of a surface, with what it must know of its neighbours when something touches its rim.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>

#include <array>

namespace delassus {

/// Counter-clockwise seen from outside; the solid is behind it. Edge k runs from point k to the next. m.
struct Triangle {
  std::array<Vec3, 3> point;  ///< its corners, m
  std::array<Index, 3> corner{};  ///< names of the points, the same in every triangle they belong to
  Vec3 normal = zero<Vec3>();     ///< unit, outward
  /// Sine of the angle up to which a contact normal at edge k may lean outward over it: 0 where the neighbour
  /// lies in the same plane or rises, 1 at a border and where the surface bends by a right angle or more.
  std::array<double, 3> lean{1, 1, 1};

  /// Unit, in the plane, out of the triangle across edge k.
  Vec3 outward(int k) const {
    const Vec3 edge = point[(k + 1) % 3] - point[k];
    const Vec3 out = cross(edge, normal);
    return out / norm(out);
  }
  /// Above its plane, m; < 0 behind it.
  double height(const Vec3& x) const { return dot(normal, x - point[0]); }
};

/// A triangle is its own core.
inline Vec3 core_support(const Triangle& t, const Vec3& d) {
  int best = 0;
  double reach = dot(t.point[0], d);
  for (int k = 1; k < 3; ++k) {
    const double r = dot(t.point[k], d);
    if (r > reach) reach = r, best = k;
  }
  return t.point[best];
}
inline double core_radius(const Triangle&) { return 0; }  ///< no rounding, 0 m

namespace inner {

/// n = e₁ × e₂ / |…| by the corner opposite the longest edge, whose product keeps most digits; zero for a
/// triangle whose height is not above 1e-6 of its longest edge.
inline Vec3 triangle_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 corner[3] = {a, b, c};
  int apex = 0;
  double longest = 0;
  for (int k = 0; k < 3; ++k) {
    const double length2 = squared_norm(corner[(k + 2) % 3] - corner[(k + 1) % 3]);
    if (length2 > longest) longest = length2, apex = k;
  }
  const Vec3 area2 = cross(corner[(apex + 1) % 3] - corner[apex], corner[(apex + 2) % 3] - corner[apex]);
  const double size = norm(area2);
  return size > 1e-6 * longest ? Vec3(area2 / size) : Vec3(zero<Vec3>());
}

/// How far normals may lean over the edge towards a neighbour with this normal: `Triangle::lean`.
inline double lean_towards(const Vec3& normal, const Vec3& neighbour, const Vec3& outward) {
  const double bend = dot(neighbour, outward), along = dot(neighbour, normal);
  if (along < -0.9999) return 1;
  if (!(bend > 0)) return 0;
  return along > 0 ? bend : 1;
}

/// Fills in `lean` of triangle t of a surface, from the normals across its edges.
template <class Surface>
void find_leans(const Surface& surface, Index t, Triangle& out) {
  for (int k = 0; k < 3; ++k) {
    const Index other = surface.neighbour(t, k);
    out.lean[k] = other < 0 ? 1 : lean_towards(out.normal, surface.normal(other), out.outward(k));
  }
}

/// The point of the triangle nearest to p. Source: [Ericson2005], §5.1.5.
inline Vec3 nearest_on(const Triangle& t, const Vec3& p) {
  const Vec3 &a = t.point[0], &b = t.point[1], &c = t.point[2];
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
               d6 = dot(ac, cp);
  if (d1 <= 0 && d2 <= 0) return a;
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ab * (d1 / (d1 - d3));
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ac * (d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  return p - t.height(p) * t.normal;
}

/// True when p, seen along the normal, lies over the triangle or within `slack` m of it.
inline bool is_over(const Triangle& t, const Vec3& p, double slack) {
  for (int k = 0; k < 3; ++k)
    if (dot(t.outward(k), p - t.point[k]) > slack) return false;
  return true;
}

}  // namespace inner
}  // namespace delassus
