/// The point of a simplex nearest to the origin, and the smallest face that carries it.
#pragma once

#include <delassus/collision/inner/difference.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/fixed_array.hpp>


namespace delassus::inner {

/// Up to four points of a Minkowski difference; `weight` are the barycentric coordinates of the nearest
/// point.
template <class Scalar>
struct BasicSimplex {
  using Vec3 = Vec<3, Scalar>;

  FixedArray<DifferencePoint, 4> p;
  FixedArray<Scalar, 4> weight{};
  int count = 0;

  void add(const DifferencePoint& q) { p[count++] = q; }
  void keep(int i) {
    p[0] = p[i];
    weight[0] = 1;
    count = 1;
  }
  void keep(int i, int j, Scalar weight_j) {
    const DifferencePoint second = p[j];
    p[0] = p[i];
    p[1] = second;
    weight[0] = 1 - weight_j;
    weight[1] = weight_j;
    count = 2;
  }
  Vec3 mix(Vec3 DifferencePoint::*member) const {
    Vec3 sum = zero<Vec3>();
    for (int i = 0; i < count; ++i) sum += weight[i] * (p[i].*member);
    return sum;
  }
};

using Simplex = BasicSimplex<double>;

/// Nearest point of the segment (p₀, p₁).
Vec3 nearest_on_segment(std::same_as<Simplex> auto& s) {
  const Vec3 ab = s.p[1].w - s.p[0].w;
  const double t = -dot(s.p[0].w, ab), length2 = squared_norm(ab);
  if (!(t > 0)) {
    s.keep(0);
  } else if (t >= length2) {
    s.keep(1);
  } else {
    s.keep(0, 1, t / length2);
  }
  return s.mix(&DifferencePoint::w);
}

/// Begins the triangle at the vertex opposite its longest edge: of a needle, only the product of the two shorter edges
/// is a normal that holds its digits.
void begin_with_short_edges(std::same_as<Simplex> auto& s) {
  int first = 0;
  double longest = -1;
  for (int i = 0; i < 3; ++i) {
    const double length2 = squared_norm(s.p[(i + 1) % 3].w - s.p[(i + 2) % 3].w);
    if (length2 > longest) longest = length2, first = i;
  }
  const auto old = s.p;
  for (int i = 0; i < 3; ++i) s.p[i] = old[(first + i) % 3];
}

/// Nearest point of the triangle (p₀, p₁, p₂) by its Voronoi regions. Source: [Ericson2005], §5.1.5.
/// Inside, the point is taken along the triangle's normal, so that its direction keeps all digits when it is
/// short.
Vec3 nearest_on_triangle(std::same_as<Simplex> auto& s) {
  begin_with_short_edges(s);
  const Vec3 a = s.p[0].w, b = s.p[1].w, c = s.p[2].w, ab = b - a, ac = c - a;
  const double d1 = -dot(ab, a), d2 = -dot(ac, a), d3 = -dot(ab, b), d4 = -dot(ac, b), d5 = -dot(ab, c),
               d6 = -dot(ac, c);
  const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  if (d1 <= 0 && d2 <= 0) {
    s.keep(0);
  } else if (d3 >= 0 && d4 <= d3) {
    s.keep(1);
  } else if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    s.keep(0, 1, d1 - d3 > 0 ? d1 / (d1 - d3) : 0.0);
  } else if (d6 >= 0 && d5 <= d6) {
    s.keep(2);
  } else if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    s.keep(0, 2, d2 - d6 > 0 ? d2 / (d2 - d6) : 0.0);
  } else if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const double sum = (d4 - d3) + (d5 - d6);
    s.keep(1, 2, sum > 0 ? (d4 - d3) / sum : 0.0);
  } else {
    const double sum = va + vb + vc;
    const Vec3 normal = cross(ab, ac);
    const double area2 = squared_norm(normal);
    if (!(sum > 0) || !(area2 > 0)) {
      s.count = 2;
      return nearest_on_segment(s);
    }
    s.weight = {1 - vb / sum - vc / sum, vb / sum, vc / sum, 0};
    return normal * (dot(normal, a) / area2);
  }
  return s.mix(&DifferencePoint::w);
}

/// Nearest point of the tetrahedron: the best of the faces that have the origin on their outer side.
/// Sets `is_inside` and leaves the simplex whole when there is none.
Vec3 nearest_on_tetrahedron(std::same_as<Simplex> auto& s, bool& is_inside) {
  constexpr int faces[4][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 3, 2, 0}};
  Simplex best;
  Vec3 nearest = zero<Vec3>();
  is_inside = true;
  for (const auto& f : faces) {
    const Vec3 a = s.p[f[0]].w;
    const Vec3 normal = cross(s.p[f[1]].w - a, s.p[f[2]].w - a);
    const double origin = -dot(a, normal), opposite = dot(s.p[f[3]].w - a, normal);
    if (origin * opposite > 0) continue;
    Simplex face{.p = {s.p[f[0]], s.p[f[1]], s.p[f[2]]}, .count = 3};
    const Vec3 v = nearest_on_triangle(face);
    if (is_inside || squared_norm(v) < squared_norm(nearest)) best = face, nearest = v;
    is_inside = false;
  }
  if (!is_inside) s = best;
  return nearest;
}

/// Reduces `s` to the smallest face that carries its point nearest to the origin, and returns that point.
Vec3 nearest(std::same_as<Simplex> auto& s, bool& is_inside) {
  is_inside = false;
  if (s.count == 2) return nearest_on_segment(s);
  if (s.count == 3) return nearest_on_triangle(s);
  if (s.count == 4) return nearest_on_tetrahedron(s, is_inside);
  s.weight[0] = 1;
  return s.p[0].w;
}

}  // namespace delassus::inner
