/// The face, edge or vertex with which a shape meets a plane: what contact patches are cut from.
#pragma once

#include <delassus/core/fixed_array.hpp>
#include <delassus/core/slice.hpp>
#include <delassus/geometry/support.hpp>

#include <cstdint>

namespace delassus {

/// Up to 16 corners in order around the face; 2 for an edge, 0 when the shape only offers a point. Body
/// frame, m. `corner` names each corner: the same material point keeps its name in every face it belongs to.
/// The lowest point of a rim, which moves on the body as that leans, has a name of its own. The line of a leaning capsule
/// reaches beyond its end to over the point where the ball there is touched.
struct Face {
  static constexpr int capacity = 16;
  static constexpr int lowest_of_rim = 0x8000;
  FixedArray<Vec3, capacity> point;
  FixedArray<std::uint16_t, capacity> corner;
  int count = 0;
  Vec3 normal = zero<Vec3>();  ///< outward and unit when count ≥ 3, else zero

  void add(const Vec3& p, int name) {
    point[count] = p;
    corner[count] = std::uint16_t(name);
    ++count;
  }
};

namespace inner {

/// A lying cylinder or capsule meets a plane in a segment up to this slope (about 3°).
inline constexpr double line_slope = 0.05;

inline void box_face(const Shape& s, const Vec3& d, Face& face) {
  const int k = largest_entry(d), i = (k + 1) % 3, j = (k + 2) % 3, side = d[k] < 0 ? -1 : 1;
  face.normal = side * unit_axis(k);
  constexpr int signs[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
  for (const auto& [u, v] : signs) {
    Vec3 p;
    p[k] = side * s.size[k];
    p[i] = side * u * s.size[i];
    p[j] = v * s.size[j];
    face.add(p, (p[0] > 0) + 2 * (p[1] > 0) + 4 * (p[2] > 0));
  }
}

/// A segment of the mantle, from the upper end (`name`) to the lower (`name` + 1).
inline void mantle_line(double radius, double half, const Vec3& d, int name, Face& face) {
  const double across = std::hypot(d[0], d[1]);
  const double x = d[0] / across * radius, y = d[1] / across * radius;
  face.add({x, y, half}, name);
  face.add({x, y, -half}, name + 1);
}

/// The line of the mantle of a capsule, for the unit vector d. The line along d through the ball's farthest point meets it
/// r tan(lean) beyond the end.
inline void capsule_line(double radius, double half, const Vec3& d, Face& face) {
  mantle_line(radius, half, d, 16, face);
  face.point[d[2] < 0 ? 1 : 0][2] += radius * d[2] / std::hypot(d[0], d[1]);
}

/// A cap that leans by less lies on its face: its corners stay where they are on the body.
inline constexpr double flat_slope = 2e-3;
/// One that leans by less, as what rests does, has no lowest point.
inline constexpr double level_slope = 1e-6;

/// The disc of radius r at height z as an octagon, counter-clockwise seen from `side`, and the farthest point
/// of its rim along d. What rolls touches there, not at a corner nearby. The octagon is turned with the body
/// where the disc lies flat across d, else so that this point is its first corner, for corners beside it
/// would catch a rim that rolls. Of two within 1e-3 r of each other the corner goes.
inline void octagon(double r, double z, const Vec3& d, int side, int name, Face& face) {
  face.normal = side * unit_axis(2);
  constexpr double c = 0.70710678118654752440;
  constexpr double corners[8][2] = {{1, 0}, {c, c}, {0, 1}, {-c, c}, {-1, 0}, {-c, -c}, {0, -1}, {c, -c}};
  const double across = std::hypot(d[0], d[1]);
  const bool is_flat = across <= flat_slope * std::abs(d[2]),
             is_level = across <= level_slope * std::abs(d[2]);
  const double x = is_level ? 1 : d[0] / across, y = is_level ? 0 : side * d[1] / across;
  int nearest = 0;
  if (is_flat)
    for (int k = 1; k < 8; ++k)
      if (corners[k][0] * x + corners[k][1] * y > corners[nearest][0] * x + corners[nearest][1] * y)
        nearest = k;
  const double past =
      is_flat ? corners[nearest][0] * y - corners[nearest][1] * x : 0;  // sine of the angle to there
  for (int k = 0; k < 8; ++k) {
    const auto [along, beside] = corners[k];
    const double u = is_flat ? along : x * along - y * beside, v = is_flat ? beside : y * along + x * beside;
    const bool has_lowest = k == nearest && !is_level;
    if (has_lowest && past < 0) face.add({r * x, side * r * y, z}, Face::lowest_of_rim);
    if (!has_lowest || std::abs(past) >= 1e-3) face.add({r * u, side * r * v, z}, name + k);
    if (has_lowest && past >= 0) face.add({r * x, side * r * y, z}, Face::lowest_of_rim);
  }
}

/// A cap (corners 0–7 above, 8–15 below), or a line of the mantle (16, 17).
inline void cylinder_face(const Shape& s, const Vec3& d, Face& face) {
  const double across = std::hypot(d[0], d[1]);
  if (across > std::abs(d[2])) return mantle_line(s.size[0], s.size[1], d, 16, face);
  const int side = d[2] < 0 ? -1 : 1;
  octagon(s.size[0], side * s.size[1], d, side, side > 0 ? 0 : 8, face);
}

/// The base (corners 8–15), or the line of the mantle from the tip (16) to the rim (17), up to 45° off its
/// normal m = (2 half, r) / slant in the plane of d.
inline void cone_face(const Shape& s, const Vec3& d, Face& face) {
  const double radius = s.size[0], half = s.size[1], slant = std::hypot(radius, 2 * half);
  const double across = std::hypot(d[0], d[1]), along_mantle = (2 * half * across + radius * d[2]) / slant;
  if (-d[2] >= along_mantle) return octagon(radius, -0.5 * half, d, -1, 8, face);
  if (!(along_mantle > 0.7 && across > 0)) return;
  face.add({0, 0, 1.5 * half}, 16);
  face.add({d[0] / across * radius, d[1] / across * radius, -0.5 * half}, 17);
}

/// Among the faces around the support vertex the one most nearly normal to d; of more than 16 corners an even
/// sample.
inline void hull_face(const ConvexHull& h, const Vec3& d, Face& face) {
  Index best = -1;
  for (const Index f : Slice<const Index>(h.faces_around(support_vertex(h, d))))
    if (best < 0 || dot(h.normal(f), d) > dot(h.normal(best), d)) best = f;
  if (best < 0) return;
  const Slice<const Index> loop = h.face(best);
  const std::size_t count = std::min(loop.size(), std::size_t(Face::capacity));
  for (std::size_t k = 0; k < count; ++k) {
    const Index v = loop[k * loop.size() / count];
    face.add(h.vertices()[v], int(v & 0x7fff));
  }
  face.normal = h.normal(best);
}

}  // namespace inner

/// The face that looks most along the unit vector `d`, body frame.
inline Face face_towards(const Shape& s, const Vec3& d) {
  Face face;
  switch (s.outline()) {
    case ShapeKind::box:
      inner::box_face(s, d, face);
      break;
    case ShapeKind::cylinder:
      inner::cylinder_face(s, d, face);
      break;
    case ShapeKind::cone:
      inner::cone_face(s, d, face);
      break;
    case ShapeKind::convex_hull:
      inner::hull_face(*s.hull, d, face);
      break;
    case ShapeKind::capsule:
      if (std::abs(d[2]) <= inner::line_slope) inner::capsule_line(s.size[0], s.size[1], d, face);
      break;
    default:
      break;
  }
  return face;
}

}  // namespace delassus
