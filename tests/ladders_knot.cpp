// The knot of examples/ladders/rope.cpp: that it is one, that it is loose, and that what tells knots apart
// does.
#include "../examples/ladders/knot.hpp"

#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace ladders_knot_tests {

using delassus::Vec3;
using ladders::equal_chords, ladders::knot_determinant, ladders::overhand_knot;
using std::numbers::pi;

/// The least distance of the points of a line that are further than `apart` from each other along it.
double least_distance(const std::vector<Vec3>& points, std::size_t apart) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t k = i + apart; k < points.size(); ++k)
      least = std::min(least, (points[i] - points[k]).norm());
  return least;
}

/// A closed curve, opened where t = 0, whose ends are led away at the side where nothing of it lies.
template <class F>
std::vector<Vec3> opened(const F& curve) {
  std::vector<Vec3> out;
  for (int k = 1; k < 400; ++k) out.push_back(curve(2 * pi * k / 400));
  const Vec3 aside(20, 0, 0);
  out.insert(out.begin(), {out.front() + aside + Vec3(0, 0, 20), out.front() + aside});
  out.insert(out.end(), {out.back() + aside, out.back() + aside - Vec3(0, 0, 20)});
  return out;
}

TEST_CASE("links are as far apart as they are long, and the joints of two halves lie alike") {
  const std::vector<Vec3> joints = equal_chords(overhand_knot(20), 0.25);
  for (std::size_t k = 1; k < joints.size(); ++k)
    CHECK((joints[k] - joints[k - 1]).norm() == Approx(0.25).epsilon(1e-12));
  CHECK(joints.front().z() == Approx(20));
  CHECK(joints.back().z() < -19.7);  // the last chord may be missing
}

TEST_CASE("strands of the overhand knot keep 1.65 apart") {
  // Points 0.01 apart miss the nearest place of two strands by at most 0.005 along each, and its distance
  // of 1.65 by at most 0.01²/(2 · 1.65) = 3e-5. Of what is nearer than 2.5 along the line nothing comes back
  // as near.
  const double seen = least_distance(equal_chords(overhand_knot(12), 0.01), 250);
  CHECK(seen > 1.65);
  CHECK(seen < 1.7);
}

TEST_CASE("the determinant tells a straight line, a coil, an overhand knot and a figure of eight apart") {
  CHECK(knot_determinant({{0, 0, 1}, {0, 0, 0}, {0, 0, -1}}) == 1);
  std::vector<Vec3> coil;
  for (int k = 0; k <= 400; ++k) coil.push_back({std::cos(0.1 * k), std::sin(0.1 * k), 10 - 0.05 * k});
  CHECK(knot_determinant(coil) == Approx(1));
  CHECK(knot_determinant(equal_chords(overhand_knot(20), 0.7)) == Approx(3));
  CHECK(knot_determinant(opened([](double t) {
          return Vec3((2 + std::cos(2 * t)) * std::cos(3 * t), (2 + std::cos(2 * t)) * std::sin(3 * t),
                      std::sin(4 * t));
        })) == Approx(5));
}

TEST_CASE("an overhand knot of which one strand has passed through another is none") {
  std::vector<Vec3> line = equal_chords(overhand_knot(20), 0.1);
  REQUIRE(knot_determinant(line) == Approx(3));
  for (Vec3& x : line)  // what goes over the upper crossing goes under it
    if (x.z() > 1 && x.z() < 3.2 && x.y() < -0.5) x.y() += 4;
  CHECK(knot_determinant(line) == Approx(1));
}

}  // namespace ladders_knot_tests
