/// The shapes a body can have: eight kinds, in one plain tagged struct, and those that a collision backend keeps.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/core/fixed_array.hpp>
#include <delassus/math/linear.hpp>

#include <cstdint>
#include <string>

namespace delassus {

template <class Scalar>
class BasicConvexHull;
using ConvexHull = BasicConvexHull<double>;

namespace inner {

/// n / |n|, scaled first so that no square overflows or vanishes; zero stays zero.
inline Vec3 direction_of(const Vec3& n) {
  const double size = std::abs(n[largest_entry(n)]);
  if (!(size > 0)) return n;
  const Vec3 scaled = n / size;
  return scaled / norm(scaled);
}

}  // namespace inner

/// Ball around the origin of the body. m.
struct Sphere {
  double radius = 0;  ///< m, > 0
};

/// Box around the origin, its edges along the axes. `x`, `y`, `z` are full edge lengths, m.
struct Box {
  /// @var x
  /// Edge along x, m, > 0.
  /// @var y
  /// Edge along y, m, > 0.
  double x = 0, y = 0, z = 0;  ///< edge along z, m, > 0
};

/// All points within `radius` of a segment of length `height` along z, its middle at the origin. m.
struct Capsule {
  /// m, > 0.
  double radius = 0, height = 0;  ///< of the segment, without the round ends, m, > 0
};

/// Solid cylinder along z, its middle at the origin. `height` is the full height, m.
struct Cylinder {
  /// m, > 0.
  double radius = 0, height = 0;  ///< from base to base, m, > 0
};

/// Solid cone along z, its tip above: the base lies at z = −height/4 and the tip at z = 3/4 height, so that the
/// origin is the centre of mass. `radius` is that of the base, m.
struct Cone {
  /// Of the base, m, > 0.
  double radius = 0, height = 0;  ///< from base to tip, m, > 0
};

/// All points with (x/a)² + (y/b)² + (z/c)² ≤ 1: `a`, `b`, `c` are the semi-axes, m.
struct Ellipsoid {
  /// @var a
  /// Half the way through along x, m, > 0.
  /// @var b
  /// Along y, m, > 0.
  double a = 0, b = 0, c = 0;  ///< along z, m, > 0
};

/// Everything on one side of a plane, in the body's frame: the solid is normal · x ≤ offset.
/// `normal` points out of the solid and need not be given as a unit vector; `offset` is in m along the unit
/// normal.
struct HalfSpace {
  Vec3 normal = unit_axis(2);  ///< out of the solid, of any length but zero
  double offset = 0;           ///< of the plane from the origin, m, of either sign
};

/// A mesh and a compound are kept by a collision backend; none meets nothing.
enum class ShapeKind : std::uint8_t {
  none,
  sphere,
  box,
  capsule,
  cylinder,
  half_space,
  convex_hull,
  cone,
  ellipsoid,
  mesh,
  compound
};

/// A shape that its collision backend keeps, a mesh or a compound of parts (`WithMeshes`, `WithCompounds`). It has its
/// number there, and a box around the origin that holds it. Other backends take the box for the shape.
struct KeptShape {
  ShapeKind kind = ShapeKind::mesh;  ///< mesh or compound
  int number = 0;                    ///< the backend's, from 0
  Vec3 reach = zero<Vec3>();         ///< half edges of the box, m
};

/// Any of the shapes above, or none. Trivially copyable.
/// A hull is pointed at, not owned: it must outlive the shape. Sets of bodies copy it when a body is added.
struct Shape {
  ShapeKind kind = ShapeKind::none;  ///< of which shape the numbers are
  /// Half lengths, m: sphere (r) · box (x/2, y/2, z/2) · ellipsoid (a, b, c). Capsule, cylinder and cone
  /// (r, height/2) · half-space (unit normal, offset) · mesh and compound (half edges of its box, its number).
  FixedArray<double, 4> size{};
  const ConvexHull* hull = nullptr;  ///< of a convex hull alone

  constexpr Shape() = default;
  constexpr Shape(const Sphere& s) : kind(ShapeKind::sphere), size{s.radius} {}  ///< its radius
  /// Half edges.
  constexpr Shape(const Box& b) : kind(ShapeKind::box), size{0.5 * b.x, 0.5 * b.y, 0.5 * b.z} {}
  /// Radius and half the height.
  constexpr Shape(const Capsule& c) : kind(ShapeKind::capsule), size{c.radius, 0.5 * c.height} {}
  /// Radius and half the height.
  constexpr Shape(const Cylinder& c) : kind(ShapeKind::cylinder), size{c.radius, 0.5 * c.height} {}
  constexpr Shape(const Cone& c) : kind(ShapeKind::cone), size{c.radius, 0.5 * c.height} {}  ///< radius, height/2
  constexpr Shape(const Ellipsoid& e) : kind(ShapeKind::ellipsoid), size{e.a, e.b, e.c} {}  ///< semi-axes
  /// With the normal made a unit vector; a zero one stays zero, for `check` to refuse.
  Shape(const HalfSpace& h) : kind(ShapeKind::half_space) {
    const Vec3 n = inner::direction_of(h.normal);
    size = {n[0], n[1], n[2], h.offset};
  }
  constexpr Shape(const ConvexHull& h) : kind(ShapeKind::convex_hull), hull(&h) {}  ///< points at h
  /// Of the kind that k says; not checked.
  Shape(const KeptShape& k) : kind(k.kind), size{k.reach[0], k.reach[1], k.reach[2], double(k.number)} {}

  /// True for what a backend keeps; `number` says which.
  constexpr bool is_kept() const { return kind >= ShapeKind::mesh; }
  /// What takes the box for a kept shape asks this for the kind.
  constexpr ShapeKind outline() const { return is_kept() ? ShapeKind::box : kind; }
  constexpr int number() const { return int(size[3]); }  ///< of a kept shape alone
  /// Whether mass properties follow from it: not of none, a half-space or a kept shape.
  constexpr bool has_volume() const {
    return kind != ShapeKind::none && kind != ShapeKind::half_space && !is_kept();
  }
};

/// For messages, as "half-space".
constexpr const char* name(ShapeKind kind) {
  constexpr const char* names[] = {"no shape",   "sphere",      "box",  "capsule",  "cylinder",
                                   "half-space", "convex hull", "cone", "ellipsoid", "mesh", "compound"};
  return names[int(kind)];
}

/// Refuses a shape that cannot exist, in a sentence that begins with `where`. A hull was checked when it was
/// made.
inline void check(const Shape& s, const std::string& where) {
  using enum ShapeKind;
  const auto check_length = [&](double value, const std::string& what) {
    inner::expect_positive(where + ": " + what, value, "m");
    inner::expect_number(value <= 1e100, where + ": " + what, value, "must be <= 1e100 m, so that volumes are numbers", "m");
  };
  if (s.kind == sphere || s.kind == capsule || s.kind == cylinder || s.kind == cone)
    check_length(s.size[0], name(s.kind) + std::string(" radius"));
  if (s.kind == capsule || s.kind == cylinder || s.kind == cone)
    check_length(2 * s.size[1], name(s.kind) + std::string(" height"));
  for (int i = 0; i < 3; ++i) {
    if (s.kind == box) check_length(2 * s.size[i], std::string("box edge ") + "xyz"[i]);
    if (s.kind == ellipsoid) check_length(s.size[i], std::string("ellipsoid semi-axis ") + "abc"[i]);
  }
  if (s.kind == half_space) {
    const Vec3 n(s.size[0], s.size[1], s.size[2]);
    DELASSUS_EXPECT(is_finite(n) && squared_norm(n) > 0.5,
                    where + ": half-space normal is zero or not finite; it must point out of the solid");
    DELASSUS_EXPECT(std::isfinite(s.size[3]),
                    where + ": half-space offset " + inner::text(s.size[3]) + " m is not finite");
  }
  if (s.is_kept())
    DELASSUS_EXPECT(std::isfinite(s.size[0] + s.size[1] + s.size[2]) && s.size[3] >= 0,
                    where + ": this " + name(s.kind) + " is none that a backend keeps; take what its add(...) returns");
  if (s.kind == convex_hull)
    DELASSUS_EXPECT(s.hull != nullptr, where + ": convex hull is missing; pass a ConvexHull");
}

}  // namespace delassus
