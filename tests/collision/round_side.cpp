#include <delassus/collision/native.hpp>

#include "catch.hpp"
#include "collision/acceptance.hpp"
#include "collision/scene.hpp"

#include <algorithm>
#include <limits>
#include <random>

namespace round_side_tests {

using namespace scenes;
using namespace samples;

// The distance of two convex bodies is least along one direction, so no line along it is longer inside of both. Corners of a
// cap and the settling of a patch may each miss it by 5e-5 L. A line that leaves a cone far from the patch is rare: hence so
// many poses.
TEST_CASE("no contact of cylinders and cones is deeper than the bodies") {
  const std::vector<Shape> round{Cylinder{0.35, 0.8}, Cone{0.4, 0.9}, Cone{0.2, 1.2}};
  std::mt19937 random(11);
  int seen = 0;
  for (const Depth depth : {Depth::deep, Depth::touch})
    for (const Shape& a : round)
      for (const Shape& b : round)
        for (int k = 0; k < 2000; ++k) {
          double apart = 0;
          const Sample s = any_pose(a, b, depth, k % 2 == 1, random, apart);
          Scene scene;
          scene.add(a, Vec3::Zero());
          scene.add(b, s.b_in_a.position, s.b_in_a.rotation);
          scene.detect();
          PairCache cache;
          const double distance = GjkEpa{}.pair(a, b, s.b_in_a, 10, cache).distance;
          double deepest = std::numeric_limits<double>::infinity();
          for (const ContactPoint& c : scene.contacts) deepest = std::min(deepest, c.gap);
          seen += !scene.contacts.empty();
          CAPTURE(name(a.kind), name(b.kind), int(depth), k, distance);
          CHECK(deepest > distance - 1.1e-4 * scale_of(s));
        }
  CHECK(seen > 30000);
}

}  // namespace round_side_tests
