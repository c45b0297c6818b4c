/// Surfaces of triangles that are deeper in each other than their features are looked for: whether they are,
/// and the way out.
#pragma once

#include <delassus/collision/inner/surface_crossing.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace delassus::inner {

/// Where the stretch from p to q passes through the triangle.
inline bool passes(const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& t, Vec3& x) {
  const Vec3 n = cross(t[1] - t[0], t[2] - t[0]);
  const double from = dot(n, p - t[0]), to = dot(n, q - t[0]);
  if ((from > 0) == (to > 0) || !(from != to)) return false;
  x = p + (from / (from - to)) * (q - p);
  for (int k = 0; k < 3; ++k)
    if (dot(n, cross(t[(k + 1) % 3] - t[k], x - t[k])) < 0) return false;
  return true;
}

/// Whether all corners of s are on one side of the plane of t.
inline bool is_beside(const std::array<Vec3, 3>& s, const std::array<Vec3, 3>& t) {
  const Vec3 n = cross(t[1] - t[0], t[2] - t[0]);
  const bool is_above = dot(n, s[0] - t[0]) > 0;
  return (dot(n, s[1] - t[0]) > 0) == is_above && (dot(n, s[2] - t[0]) > 0) == is_above;
}

/// The curve in which two surfaces cut each other: stretches along n_A × n_B, one of every two triangles that
/// cross.
struct Cut {
  Vec3 from, to;
  Index triangle_a, triangle_b;
};
template <class A, class B>
void find_cuts(const PosedSurface<A>& a, const PosedSurface<B>& b, Array<Cut>& cuts) {
  cuts.clear();
  const auto meets = [](const Bounds& x, const Bounds& y) { return x.meets(y); };
  each_pair(a, b, meets, [&](const auto& x, const auto& y) {
    const std::array<Vec3, 3>&T = x.point, &S = y.point;
    if (is_beside(S, T) || is_beside(T, S)) return;
    Vec3 end[2], at;
    int count = 0;
    const auto add = [&](const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& through) {
      if (count < 2 && passes(p, q, through, at)) end[count++] = at;
    };
    for (int k = 0; k < 3; ++k) {
      add(T[k], T[(k + 1) % 3], S);
      add(S[k], S[(k + 1) % 3], T);
    }
    if (count < 2) return;
    const Vec3 along = cross(cross(T[1] - T[0], T[2] - T[0]), cross(S[1] - S[0], S[2] - S[0]));
    const bool is_forward = dot(along, end[1] - end[0]) > 0;
    cuts.push_back({end[is_forward ? 0 : 1], end[is_forward ? 1 : 0], x.t, y.t});
  });
}

/// The point of a surface next to x, m, and the normal there: of the triangles that have it, the one that
/// looks most towards x or away, which tells the two sides apart also beside edges and corners.
struct NearestPoint {
  Vec3 foot = zero<Vec3>(), normal = zero<Vec3>();
  double distance = std::numeric_limits<double>::infinity(), height = 0;
};
template <class Surface>
NearestPoint nearest_point(const PosedSurface<Surface>& of, const Vec3& x) {
  const Vec3 local = of.pose.to_local(x);
  NearestPoint best;
  const auto meets = [&](const Bounds& box) {
    return !(squared_norm(box.beyond(local)) > best.distance * best.distance);
  };
  of.surface.visit(meets, [&](Index t) {
    const Triangle triangle = of.plain(t);
    const Vec3 foot = nearest_on(triangle, local);
    const double distance = norm(local - foot), height = triangle.height(local);
    const double same = 1e-12 * distance;
    if (distance > best.distance + same ||
        (distance >= best.distance - same && std::abs(height) <= std::abs(best.height)))
      return;
    best = {foot, triangle.normal, distance, height};
  });
  best.foot = of.pose.to_world(best.foot);
  best.normal = of.pose.rotation * best.normal;
  return best;
}

/// f(x, t, k) for every vertex, corner k of the triangle t that owns it.
template <class Surface, class F>
void each_vertex(const PosedSurface<Surface>& of, const F& f) {
  for (Index t = 0; t < of.surface.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k)
      if (of.surface.owns_corner(t, k)) f(of.points_of(t)[k], t, k);
}

/// One surface wholly inside another that is closed: it leaves by the point next to its middle. Adds the
/// vertices that have the longest way to the plane there, to 2e-2 L. False, and nothing added, where it is
/// not inside.
template <class Inside, class Around>
bool add_enclosed(const PosedSurface<Inside>& inside, const PosedSurface<Around>& around, bool is_inside_a,
                  double scale, std::vector<FeatureContact>& out) {
  if constexpr (requires { around.surface.is_closed(); }) {
    const Bounds box = inside.bounds(inside.surface.bounds()), hall = around.bounds(around.surface.bounds());
    for (int k = 0; k < 3; ++k)
      if (!(box.low[k] >= hall.low[k] && box.high[k] <= hall.high[k])) return false;
    const Vec3 corner = inside.points_of(0)[0], middle = 0.5 * (box.low + box.high);
    const NearestPoint first = nearest_point(around, corner);
    if (!(first.height < 0) || !around.surface.is_closed()) return false;
    const NearestPoint central = nearest_point(around, middle);
    const bool is_middle_in = central.height < 0;
    const NearestPoint& gate = is_middle_in ? central : first;
    const Vec3 way = gate.foot - (is_middle_in ? middle : corner);
    const Vec3 n = gate.distance > 1e-9 * scale ? Vec3(way / gate.distance) : gate.normal;

    const std::size_t begin = out.size();
    double deepest = 0;
    each_vertex(inside, [&](const Vec3& x, Index t, int k) {
      const double gap = dot(n, x - gate.foot);
      deepest = std::min(deepest, gap);
      const Index v = inside.surface.triangle(t).corner[k];
      out.push_back(vertex_contact(is_inside_a, v, x, x - gap * n, gap, n, t, 0));
    });
    const auto is_high = [&](const FeatureContact& c) { return c.point.gap > deepest + 2e-2 * scale; };
    out.erase(std::remove_if(out.begin() + std::ptrdiff_t(begin), out.end(), is_high), out.end());
    return true;
  }
  return false;
}

/// How far the vertices of one surface that are inside the other reach along n.
template <class Inside, class Around>
void stretch(const PosedSurface<Inside>& inside, const PosedSurface<Around>& around, const Vec3& n,
             double& low, double& high) {
  const Bounds hall = around.bounds(around.surface.bounds());
  each_vertex(inside, [&](const Vec3& x, Index, int) {
    const double along = dot(n, x);
    if ((along >= low && along <= high) || !hall.meets({x, x}) || !(nearest_point(around, x).height < 0))
      return;
    low = std::min(low, along);
    high = std::max(high, along);
  });
}

/// Two surfaces that have cut each other are parted across the curve C in which they do, whose area
///
///   n ∝ ½ ∮ x × dx
///
/// is how the volume they share, w long along n, shrinks as A moves back. Contacts −w deep along the curve; a
/// curve that ends at a border says nothing.
template <class A, class B>
void add_cut(const PosedSurface<A>& a, const PosedSurface<B>& b, const Array<Cut>& cuts, double scale,
             std::vector<FeatureContact>& out) {
  Vec3 area = zero<Vec3>(), open = zero<Vec3>();
  for (const Cut& c : cuts) {
    area += 0.5 * cross(c.from - cuts[0].from, c.to - cuts[0].from);
    open += c.to - c.from;
  }
  if (!(norm(area) > 0) || norm(open) > 1e-6 * scale) return;
  const Vec3 n = area / norm(area);
  double low = dot(n, cuts[0].from), high = low;
  for (const Cut& c : cuts) {
    low = std::min({low, dot(n, c.from), dot(n, c.to)});
    high = std::max({high, dot(n, c.from), dot(n, c.to)});
  }
  stretch(a, b, n, low, high);
  stretch(b, a, n, low, high);
  if (!(high > low)) return;
  for (const Cut& c : cuts) {
    const Vec3 x = c.from - dot(n, c.from) * n;
    out.push_back({{x + high * n, x + low * n, low - high, edges_name(c.triangle_a, 0, c.triangle_b, 0)},
                   n,
                   c.triangle_a,
                   c.triangle_b});
  }
}

/// What two surfaces say whose features are farther apart than these are looked for: where one has cut the
/// other, or is inside it, the way out.
template <class A, class B>
void collect_deep(const PosedSurface<A>& a, const PosedSurface<B>& b, double scale, Array<Cut>& cuts,
                  std::vector<FeatureContact>& out) {
  find_cuts(a, b, cuts);
  if (!cuts.empty())
    add_cut(a, b, cuts, scale, out);
  else if (!add_enclosed(a, b, true, scale, out))
    add_enclosed(b, a, false, scale, out);
}

}  // namespace delassus::inner
