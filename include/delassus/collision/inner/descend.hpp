/// A lower depth near a direction that is nearly least: what EPA ends with when its points are spent.
#pragma once

#include <delassus/collision/inner/polytope.hpp>
#include <delassus/core/fixed_array.hpp>

namespace delassus::inner {

/// Whether the ray from the origin along d passes the triangle, whose corners run counter-clockwise about d.
bool is_pierced(const FixedArray<DifferencePoint, 3>& corner, const std::same_as<Vec3> auto& d) {
  for (int k = 0; k < 3; ++k)
    if (dot(d, cross(corner[k].w, corner[(k + 1) % 3].w)) < 0) return false;
  return true;
}

/// Three points of A − B whose triangle the ray from the origin along `d` pierces; of several, which rounding makes of
/// slivers, the nearest. Where rounding leaves none: the face with the least offset / (normal · d).
FixedArray<DifferencePoint, 3> pierced_face(const std::same_as<Polytope> auto& polytope, const Vec3& d) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  int best = 0;
  double least = infinity;
  bool is_through = false;
  for (int f = 0; f < polytope.face_count(); ++f) {
    const auto& face = polytope.face(f);
    const double slope = dot(face.normal, d);
    if (!(slope > 0) || face.offset == infinity) continue;
    const bool passes = is_pierced(polytope.corners(f), d);
    if (passes < is_through || (passes == is_through && face.offset / slope >= least)) continue;
    least = face.offset / slope;
    best = f;
    is_through = passes;
  }
  return polytope.corners(best);
}

/// Of the triangles that q makes with the sides of `portal`, keeps the one that the ray along d pierces.
/// Sides run counter-clockwise about d. False when there is none.
template <class Scalar>
bool narrow(const DifferencePoint& q, const Vec<3, Scalar>& d, FixedArray<DifferencePoint, 3>& portal) {
  FixedArray<Scalar, 3> side;
  for (int k = 0; k < 3; ++k) side[k] = dot(d, cross(q.w, portal[k].w));
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    if (side[k] < 0 || side[next] > 0) continue;
    portal[(k + 2) % 3] = q;
    return true;
  }
  return false;
}

/// Takes the ray along d to where it leaves A − B, and d to the normal found there, again and again: with the
/// depth h and a surface of radius r ≥ h this brings d to the least depth nearby by the factor h/r each time.
/// Calls visit(triangle, normal, q) for every plane it meets; q is the support point of the normal.
template <class D, class Visit>
void descend(const D& difference, Vec3 d, FixedArray<DifferencePoint, 3> portal, double tolerance,
             const Visit& visit) {
  for (int turn = 0; turn < 12; ++turn) {
    Vec3 normal = d;
    for (int iteration = 0; iteration < 40; ++iteration) {
      const Vec3 across = cross(portal[1].w - portal[0].w, portal[2].w - portal[0].w);
      const double area2 = norm(across);
      const double edge2 =
          std::max(squared_norm(portal[1].w - portal[0].w), squared_norm(portal[2].w - portal[0].w));
      if (!(area2 > 1e-12 * edge2)) break;
      normal = dot(across, d) < 0 ? Vec3(-across / area2) : Vec3(across / area2);
      const DifferencePoint q = difference.core(normal);
      visit(portal, normal, q);
      if (dot(normal, q.w - portal[0].w) <= tolerance || !narrow(q, d, portal)) break;
    }
    if (squared_norm(normal - d) < 1e-20) return;
    d = normal;
  }
}

}  // namespace delassus::inner
