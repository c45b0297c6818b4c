#include "collision/acceptance.hpp"
#include "catch.hpp"
#include "collision/scene.hpp"

#include <vector>

using namespace delassus;
using namespace samples;
using namespace scenes;

// Every claim here holds for as many poses as one has time for: DELASSUS_POSES=1000 in the environment.

// EPA's bounds meet to 3e-10 of the smaller body's box, whose diagonal is below 3 L, GJK's to 1e-10.
// 1e-8 L leaves room for the few whose points are spent before that; what is asked is 1e-4 L.
TEST_CASE("no overlap is missed, and every depth is the least one, for all convex pairs in all classes") {
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

TEST_CASE("needles, plates and giants are bodies like any other, apart, touching and overlapping") {
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

// The pose is what a double keeps of it at 1e6 m, 1.2e-10; the truth is asked for that very pose.
TEST_CASE("a million metres from the origin the deepest contact is as deep as at home") {
  const Zoo zoo;
  std::mt19937 random(11);
  const Vec3 far(1e6, -1e6, 1e6);
  for (const Depth depth : {Depth::deep, Depth::ten_thousandth, Depth::touch, Depth::gap_thousandth})
    for_each_pair(zoo.all, [&](const Shape& a, const Shape& b) {
      for (int k = 0; k < poses(3); ++k) {
        double apart = 0;
        const Sample s = any_pose(a, b, depth, k % 2 == 1, random, apart);
        Scene scene;
        scene.collision.margin = 0.1;
        scene.add(a, far);
        scene.add(b, far + s.b_in_a.position, s.b_in_a.rotation);
        scene.detect();
        const Pose kept{.position = scene.colliders[1].pose.position - far, .rotation = s.b_in_a.rotation};
        PairCache cache;
        const double truth = GjkEpa{}.pair(a, b, kept, 10, cache).distance;
        double deepest = 1;
        for (const ContactPoint& c : scene.contacts) deepest = std::min(deepest, c.gap);
        CAPTURE(name(a.kind), name(b.kind), int(depth), deepest, truth);
        CHECK(std::abs(deepest - truth) <
              1.1e-4 * scale_of(s));  // settling and the corners: 5e-5 L each, and a bit
      }
    });
}
