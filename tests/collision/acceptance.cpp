#include "collision/acceptance.hpp"
#include "catch.hpp"

#include <vector>

namespace acceptance_tests {

using namespace delassus;
using namespace samples;

// Every claim here holds for as many poses as one has time for: DELASSUS_POSES=1000 in the environment.

// EPA's bounds meet to 3e-10 of the smaller body's box, whose diagonal is below 3 L, GJK's to 1e-10.
// 1e-8 L leaves room for the few whose points are spent before that; what is asked is 1e-4 L.
TEST_CASE("no overlap is missed, and every depth is the least one, for all convex pairs in all classes",
          "[table]") {
  for (const double size : {1.0, 1e-3, 1e3}) {
    const Zoo zoo(size);
    for (const Depth depth : depths) {
      const Figures f = accept<GjkEpa>(zoo.all, depth, poses(size == 1.0 ? 12 : 4), 2026);
      CAPTURE(size, int(depth), f.poses, f.depth_error, f.excess);
      CHECK(f.missed == 0);
      CHECK(f.rejected == 0);
      CHECK(f.depth_error < 1e-8);
      CHECK(f.excess < 1e-8);
    }
  }
}

TEST_CASE("needles, plates and giants are bodies like any other, apart, touching and overlapping",
          "[table]") {
  const std::vector<Shape> shapes{
      Sphere{1e-4},          Box{1, 1, 1e-3},         Box{1000, 1000, 1}, Capsule{1e-3, 1},
      Cylinder{1e-3, 1},     Cylinder{1, 1e-3},       Cone{1e-3, 1},      Cone{1, 1e-3},
      Ellipsoid{1, 1, 1e-3}, Ellipsoid{1e-3, 1, 1e-3}};
  for (const Depth depth : depths) {
    if (depth == Depth::hundredth) continue;  // deeper than a plate is thick
    const Figures f = accept<GjkEpa>(shapes, depth, poses(4), 4);
    CAPTURE(int(depth), f.poses, f.depth_error, f.excess);
    CHECK(f.missed == 0);
    CHECK(f.rejected == 0);
    CHECK(f.depth_error < 1e-4);
    CHECK(f.excess < 1e-4);
  }
}

}  // namespace acceptance_tests
