#include <delassus/core/array.hpp>
#include <delassus/geometry/aabb.hpp>

#include "catch.hpp"

namespace aabb_tests {

using namespace delassus;

TEST_CASE("an empty box becomes what it is extended by") {
  Aabb box;
  CHECK(box.is_empty());
  box.extend(Vec3(1, 2, 3));
  CHECK_FALSE(box.is_empty());
  CHECK(box.min() == Vec3(1, 2, 3));
  CHECK(box.max() == Vec3(1, 2, 3));
  box.extend(Aabb(Vec3(0, 5, 3), Vec3(0, 6, 4)));
  CHECK(box.min() == Vec3(0, 2, 3));
  CHECK(box.max() == Vec3(1, 6, 4));
  box.extend(Aabb());
  CHECK(box.max() == Vec3(1, 6, 4));
  CHECK(box.sizes() == Vec3(1, 4, 1));
  CHECK(box.center() == Vec3(0.5, 4, 3.5));
}

TEST_CASE("boxes meet where a face, an edge or a corner is in both") {
  const Aabb unit(Vec3(0, 0, 0), Vec3(1, 1, 1));
  for (int k = 0; k < 3; ++k)
    for (const double side : {-1.0, 1.0}) {
      Vec3 way(0.5, 0.5, 0.5);
      way[k] = side;
      CHECK(unit.intersects(Aabb(way, way + Vec3(1, 1, 1))));
      way[k] = side * 1.001;
      CHECK(unit.is_apart(Aabb(way, way + Vec3(1, 1, 1))));
      CHECK(Aabb(way, way + Vec3(1, 1, 1)).is_apart(unit));
    }
  CHECK(unit.intersects(Aabb(Vec3(1, 1, 1), Vec3(2, 2, 2))));
  CHECK(unit.is_apart(Aabb()));
}

TEST_CASE("a box holds what is nowhere beyond it") {
  const Aabb unit(Vec3(0, 0, 0), Vec3(1, 1, 1));
  CHECK(unit.contains(unit));
  CHECK(unit.contains(Aabb()));
  for (int k = 0; k < 3; ++k) {
    Vec3 low(0, 0, 0), high(1, 1, 1);
    low[k] = -0.1;
    CHECK_FALSE(unit.contains(Aabb(low, high)));
    low[k] = 0, high[k] = 1.1;
    CHECK_FALSE(unit.contains(Aabb(low, high)));
  }
}

TEST_CASE("the distance of a point is that of the nearest point of the box") {
  const Aabb unit(Vec3(0, 0, 0), Vec3(1, 1, 1));
  CHECK(unit.distance(Vec3(0.2, 0.3, 0.4)) == 0);
  CHECK(unit.distance(Vec3(0.5, 0.5, 3)) == 2);
  CHECK(unit.distance(Vec3(-3, 0.5, 5)) == 5);
}

TEST_CASE("lists of boxes are flat") {
  Array<Aabb> boxes(2);
  CHECK(boxes[1].is_empty());
}

}  // namespace aabb_tests
