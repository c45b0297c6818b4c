#include "catch.hpp"

#include <delassus/geometry/inertia.hpp>
#include <delassus/geometry/shape.hpp>

#include <limits>
#include <type_traits>
#include <vector>

using namespace delassus;
using Catch::Matchers::Contains;

static_assert(std::is_trivially_copyable_v<Shape>);
static_assert(std::is_convertible_v<Sphere, Shape> && std::is_convertible_v<Box, Shape> &&
              std::is_convertible_v<Capsule, Shape> && std::is_convertible_v<Cylinder, Shape> &&
              std::is_convertible_v<HalfSpace, Shape> && std::is_convertible_v<const ConvexHull&, Shape>);
static_assert(Shape{}.kind == ShapeKind::none && !Shape{}.has_volume());

TEST_CASE("a shape keeps half lengths and a unit normal") {
  const Shape box = Box{1, 2, 3};
  CHECK(box.size == FixedArray<double, 4>{0.5, 1, 1.5, 0});
  const Shape ground = HalfSpace{{0, 3, 4}, 2};
  CHECK(ground.size == FixedArray<double, 4>{0, 0.6, 0.8, 2});
  CHECK_FALSE(ground.has_volume());
}

TEST_CASE("a shape that cannot exist is refused by name") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH(check(Sphere{0}, "rigid body #3"),
                    Contains("rigid body #3: sphere radius 0 m must be finite and > 0"));
  CHECK_THROWS_WITH(check(Sphere{nan}, "x"), Contains("sphere radius"));
  CHECK_THROWS_WITH(check(Box{1, -1, 1}, "x"), Contains("box edge y -1 m"));
  CHECK_THROWS_WITH(check(Box{1, 1, inf}, "x"), Contains("box edge z inf m"));
  CHECK_THROWS_WITH(check(Capsule{1, 0}, "x"), Contains("capsule height 0 m"));
  CHECK_THROWS_WITH(check(Cylinder{-2, 1}, "x"), Contains("cylinder radius -2 m"));
  CHECK_THROWS_WITH(check(Cone{0, 1}, "x"), Contains("cone radius 0 m"));
  CHECK_THROWS_WITH(check(Cone{1, inf}, "x"), Contains("cone height inf m"));
  CHECK_THROWS_WITH(check(Ellipsoid{1, -1, 1}, "x"), Contains("ellipsoid semi-axis b -1 m"));
  CHECK_THROWS_WITH(check(HalfSpace{Vec3::Zero(), 0}, "x"), Contains("half-space normal"));
  CHECK_THROWS_WITH(check(HalfSpace{{0, 0, 1}, nan}, "x"), Contains("half-space offset"));
  CHECK_THROWS_AS(check(Sphere{-1}, "x"), InvalidArgument);
}

TEST_CASE("a good shape, and none at all, pass") {
  for (const Shape& s :
       std::vector<Shape>{Sphere{1}, Box{1e-9, 1, 1e9}, Capsule{1, 2}, Cylinder{1, 2}, Cone{1, 2}, Ellipsoid{1, 2, 3},
                          HalfSpace{}, Shape{}})
    CHECK_NOTHROW(check(s, "x"));
}

TEST_CASE("a shape without volume has no mass properties") {
  CHECK_THROWS_WITH(mass_properties(HalfSpace{}, 1), Contains("a half-space has no finite volume"));
}
