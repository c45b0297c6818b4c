#include "catch.hpp"
#include "collision/acceptance.hpp"

#include <cmath>
#include <vector>

namespace gjk_epa_tests {

using namespace delassus;
using namespace samples;

namespace {

SignedPair ask(const Sample& s, double margin) {
  PairCache cache;
  return GjkEpa{}.pair(s.a, s.b, s.b_in_a, margin, cache);
}

Pose inverse(const Pose& p) {
  return {.position = -(p.rotation.transpose() * p.position), .rotation = p.rotation.transpose()};
}

}  // namespace

TEST_CASE("swapping the bodies turns the normal round", "[table]") {
  const Zoo zoo;
  std::mt19937 random(7);
  // The depth is unique: twice the kernel's promise, 1e-9 L. So is the normal of bodies apart: turned by θ it proves a
  // distance less by g θ²/2 at the gap g, so an error e of the distance is an angle of √(2e/g): 1.4e-3 for e = 1e-9 at
  // g = 1e-3, and 1.4e-5 for the relative bound of 1e-10 at wider gaps.
  for (const Depth depth : depths)
    for_each_pair(zoo.all, [&](const Shape& a, const Shape& b) {
      for (int k = 0; k < poses(10); ++k) {
        double apart = 0;
        const Sample s = any_pose(a, b, depth, k % 2 == 1, random, apart);
        const SignedPair r = ask(s, 10), back = ask({b, a, inverse(s.b_in_a)}, 10);
        CAPTURE(name(a.kind), name(b.kind), int(depth), k);
        CHECK(std::abs(r.distance - back.distance) < 2e-9 * scale_of(s));
        const double turn = (r.normal + s.b_in_a.rotation * back.normal).norm();
        if (depth >= Depth::gap_thousandth) CHECK(turn < (depth == Depth::gap_half ? 3e-5 : 3e-3));
      }
    });
}

TEST_CASE("a change of units changes nothing but the units") {
  const Zoo one, big(1024);
  for (std::size_t i = 0; i < one.all.size(); ++i)
    for (std::size_t j = i; j < one.all.size(); ++j)
      for (const Depth depth : depths) {
        std::mt19937 random(5), again(5);
        double apart = 0;
        const Sample s = any_pose(one.all[i], one.all[j], depth, false, random, apart);
        const Sample t = any_pose(big.all[i], big.all[j], depth, false, again, apart);
        const SignedPair r = ask(s, 10), q = ask(t, 10240);
        CHECK(std::abs(r.distance - q.distance / 1024) <= 2e-9);
      }
}

// On a floor the answer is known: n = z, distance = −penetration. Within rounding, h(z) = penetration
// exactly, so the kernel may only answer a depth lower than that by its own tolerance, 1e-9 of the smaller
// body; and a normal that is off by θ costs at least θ r for a corner r away from the patch's centre. 0.5° is
// what a stack forgives.
TEST_CASE("exact touching, and all that rounding makes of it, gives the floor's normal") {
  const Zoo zoo;
  std::mt19937 random(3);
  const ConvexHull slab(std::vector<Vec3>{{-9, -9, -0.5}, {9, -9, -0.5}, {9, 9, -0.5}, {-9, 9, -0.5}, {0, 0, -2},
                                          {-9, -9, 0.5}, {9, -9, 0.5}, {9, 9, 0.5}, {-9, 9, 0.5}});
  for (const Shape& floor : {Shape(Box{20, 20, 1}), Shape(Cylinder{8, 1}), Shape(slab)})
    for (const Shape& body : zoo.all)
      for (const double size : {0.0, 1e-16, 1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10})
        for (const double penetration : {size, -size})
          for (int turn = 0; turn < 4; ++turn) {
            Sample s{floor, body, {}};
            if (turn == 1) s.b_in_a.rotation = Eigen::AngleAxisd(0.5, Vec3::UnitZ()).toRotationMatrix();
            if (turn == 2) s.b_in_a.rotation = Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX()).toRotationMatrix();
            if (turn == 3) s.b_in_a.rotation = any_rotation(random);
            const Mat3& R = s.b_in_a.rotation;
            const double low = (R * support(body, Vec3(-R.row(2).transpose())))[2];
            s.b_in_a.position = {0.1, 0.2, 0.5 - low - penetration};
            SignedPair r = ask(s, 1);
            CAPTURE(name(floor.kind), name(body.kind), penetration, turn);
            REQUIRE(certify(s.a, s.b, s.b_in_a, 1, scale_of(s), r));
            CHECK(r.normal[2] > std::cos(0.5 * M_PI / 180));
            CHECK(std::abs(r.distance + penetration) < 1e-9);
          }
}

TEST_CASE("concentric bodies get a finite unit normal and the least sum of their thicknesses", "[table]") {
  const Zoo zoo;
  std::mt19937 random(9);
  for_each_pair(zoo.all, [&](const Shape& a, const Shape& b) {
    for (int turn = 0; turn < 4; ++turn) {
      Sample s{a, b, {}};
      if (turn > 0) s.b_in_a.rotation = any_rotation(random);
      SignedPair r = ask(s, 1);
      CAPTURE(name(a.kind), name(b.kind), turn, r.distance);
      REQUIRE(certify(s.a, s.b, s.b_in_a, 1, scale_of(s), r));
      CHECK(std::abs(-r.distance - std::min(true_depth(s, random), s.reach(r.normal))) < 1e-6);
      CHECK(ask(s, 1).normal == ask(s, 1).normal);
    }
  });
}

TEST_CASE("the distance holds its digits from a gap of 1e-9 to 1") {
  const Zoo zoo;
  std::mt19937 random(8);
  // GJK's bounds meet to 1e-10 of the distance of the cores, which is the gap and both radii. On round rims
  // it may stop before, where the simplex has shrunk to rounding: 1e-8 of the size, as promised of EPA.
  for_each_pair(zoo.all, [&](const Shape& a, const Shape& b) {
    for (double gap = 1e-9; gap < 1.5; gap *= 10)
      for (int k = 0; k < 10; ++k) {
        const Mat3 rotation = any_rotation(random);
        const SignedPair r = ask(at_distance(a, b, rotation, any_direction(random), gap), 10);
        CAPTURE(name(a.kind), name(b.kind), gap, r.distance - gap);
        CHECK(std::abs(r.distance - gap) <= 1e-6 * gap + 1e-8);
      }
  });
}

TEST_CASE("a pair beyond the margin is far, whatever its distance") {
  const Zoo zoo;
  std::mt19937 random(6);
  for_each_pair(zoo.all, [&](const Shape& a, const Shape& b) {
    double apart = 0;
    const Sample s = any_pose(a, b, Depth::gap_half, false, random, apart);
    SignedPair r = ask(s, 0.5 * apart);
    CHECK(r.status == PairStatus::far);
    CHECK(certify(s.a, s.b, s.b_in_a, 0.5 * apart, scale_of(s), r));
  });
}

// An ellipsoid sunk into the face z = 0.5 touches it at its lowest point, its support of −z, and the face above that. The bounds of the
// depth meet to 3e-10 of its size of 0.3 m, e = 9e-11 m; a point of the ellipsoid that lies e above the lowest is within √(2 e R) = 8e-6 m
// beside it, with the largest radius of curvature R = 0.15²/0.07 m.
TEST_CASE("a curved body that dips into a face touches it at its lowest point") {
  const Shape egg = Ellipsoid{0.15, 0.1, 0.07};
  std::mt19937 random(3);
  for (int k = 0; k < 1000; ++k)
    for (const double depth : {1e-7, 1e-6, 1e-4}) {
      const double side = 1 + k % 20;
      Sample s{Box{side, side, 1}, egg, {}};
      s.b_in_a.rotation = any_rotation(random);
      const Vec3 low = s.b_in_a.rotation * support(egg, Vec3(-s.b_in_a.rotation.row(2).transpose()));
      s.b_in_a.position = {0.05, 0.02, 0.5 - low[2] - depth};
      const SignedPair r = ask(s, 1);
      CAPTURE(k, depth);
      const Vec3 deepest = s.b_in_a.position + low;
      CHECK((r.point_b - deepest).norm() < 1e-5);
      CHECK((r.point_a - deepest - depth * Vec3::UnitZ()).norm() < 1e-5);
    }
}

}  // namespace gjk_epa_tests
