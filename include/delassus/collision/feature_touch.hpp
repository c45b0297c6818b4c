/// The two ways in which triangles touch: a point and a triangle, an edge and an edge.
#pragma once

#include <delassus/collision/triangle_patch.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/geometry/triangle.hpp>

#include <algorithm>

namespace delassus {

/// x = foot + gap · normal. The foot is inside the triangle, or on the edge or the corner named.
struct PointTouch {
  Vec3 foot, normal;
  double gap = 0;
  int edge = -1, corner = -1;
};

/// How near two features must be to be looked at: up to `before` in front and `behind` behind, m; L is the
/// size of the pair.
struct TouchRange {
  double before = 0, behind = 0, scale = 1;
};

/// Sine of the angle by which a normal may leave the cone of a corner or an edge: 0.02 rad, as of the patches
/// of convex bodies, so that all corners of flat patches count while these rock.
inline constexpr double cone_slack = 0.02;

/// Whether and where the point x touches the triangle.
///
/// Over the triangle, or beside it by 1e-5 L or 0.02 rad, n is the triangle's and the gap is the height.
/// In front of it, beside it, n = (x − foot) / |x − foot|, the foot nearest.
///
/// Behind a hollow edge the plane goes on, to 5e-3 L. Beside an edge n must be in its cone
/// (`Triangle::lean`).
inline bool touches(const Triangle& t, const Vec3& x, const TouchRange& range, PointTouch& out) {
  const double height = t.height(x);
  if (!(height <= range.before && height >= -range.behind)) return false;
  const double slack = 1e-5 * range.scale + cone_slack * std::max(0.0, height);
  bool is_over = true;
  for (int k = 0; k < 3; ++k) {
    const double overhang = dot(t.outward(k), x - t.point[k]);
    is_over = is_over && overhang <= (height < 0 && t.lean[k] == 0 ? 5e-3 * range.scale : slack);
  }
  out = {x - height * t.normal, t.normal, height};
  if (is_over) return true;
  if (height < 0) return false;
  out.foot = inner::nearest_on(t, x);
  const Vec3 apart = x - out.foot;
  out.gap = norm(apart);
  if (!(out.gap <= range.before && out.gap > 0)) return false;
  out.normal = apart / out.gap;
  const inner::Rim rim(t, out.normal);
  if (rim.count == 3 || (rim.count == 2 && !inner::is_allowed(t, rim, out.normal))) return false;
  for (int k = 0; k < 3; ++k)
    if (rim.count == 2 && !rim.has[k]) out.edge = (k + 1) % 3;
  if (rim.count == 1) out.corner = rim.corner[0];
  return true;
}

/// An edge with what its surface says about normals there: unit ones of both triangles, and directions in
/// them, out of each across the edge. At a border the second ones are zero.
struct SharpEdge {
  Vec3 from, to;
  Vec3 normal[2], outward[2];

  /// Edge k of t; across it there is a triangle with this normal.
  SharpEdge(const Triangle& t, int k, const Vec3& across)
      : from(t.point[k]),
        to(t.point[(k + 1) % 3]),
        normal{t.normal, across},
        outward{t.outward(k), Vec3(cross(from - to, across) / norm(from - to))} {}

  /// Out of the solid, between the two triangles.
  Vec3 away() const { return normal[0] + normal[1] + outward[0] + outward[1]; }
  /// Whether n, normal to the edge, lies between the normals of the two triangles.
  bool allows(const Vec3& n) const {
    return dot(n, away()) > 0 && dot(n, outward[0]) >= -cone_slack && dot(n, outward[1]) >= -cone_slack &&
           (!is_zero(normal[1]) || dot(n, normal[0]) >= -1e-6);
  }
};

/// b − a = gap · normal, a on the first edge, b on the second.
struct EdgeTouch {
  Vec3 a, b, normal;
  double gap = 0;
};

/// Whether two edges cross, seen along the normal to both, at an angle above 0.02 rad, the normal in the
/// cones of both. Where it is within 0.02 rad of that of a triangle at one of them, it becomes that one.
/// Nearest points of lines: [Ericson2005], §5.1.8.
inline bool touches(const SharpEdge& e, const SharpEdge& f, const TouchRange& range, EdgeTouch& out) {
  const Vec3 u = e.to - e.from, v = f.to - f.from, r = e.from - f.from;
  const Vec3 across = cross(u, v);
  const double uu = squared_norm(u), vv = squared_norm(v), uv = dot(u, v), size2 = squared_norm(across);
  if (!(size2 > cone_slack * cone_slack * uu * vv)) return false;
  const double ur = dot(u, r), vr = dot(v, r);
  const double s = (uv * vr - ur * vv) / size2, q = (vr * uu - uv * ur) / size2;
  if (!(s >= 0 && s <= 1 && q >= 0 && q <= 1)) return false;
  const Vec3 a = e.from + s * u, b = f.from + q * v;
  Vec3 n = across / std::sqrt(size2);
  if (dot(n, e.away()) < 0) n = -n;
  if (!e.allows(n) || !f.allows(-n)) return false;
  for (const Vec3& face : {Vec3(-f.normal[1]), Vec3(-f.normal[0]), e.normal[1], e.normal[0]})
    if (dot(n, face) > 1 - 0.5 * cone_slack * cone_slack) n = face;
  const double gap = dot(n, b - a);
  if (!(gap <= range.before && gap >= -range.behind)) return false;
  const Vec3 middle = 0.5 * (a + b);
  out = {middle - 0.5 * gap * n, middle + 0.5 * gap * n, n, gap};
  return true;
}

}  // namespace delassus
