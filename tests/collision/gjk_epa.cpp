#include "catch.hpp"
#include "collision/samples.hpp"

#include <delassus/collision/certificate.hpp>
#include <delassus/collision/gjk_epa.hpp>

#include <cmath>
#include <vector>

using namespace delassus;
using namespace samples;

namespace {

struct Zoo {
  explicit Zoo(double size = 1)
      : hull(ball_hull(20, 7, 0.5 * size)),
        all{Sphere{0.4 * size}, Box{size, 0.6 * size, 0.8 * size}, Capsule{0.25 * size, 0.8 * size},
            Cylinder{0.35 * size, 0.8 * size}, hull} {}
  ConvexHull hull;
  std::vector<Shape> all;
};

SignedPair ask(const Sample& s, double margin) {
  PairCache cache;
  return GjkEpa{}.pair(s.a, s.b, s.b_in_a, margin, cache);
}

double scale_of(const Sample& s) { return std::min(length_scale(s.a), length_scale(s.b)); }

Pose inverse(const Pose& p) {
  return {.position = -(p.rotation.transpose() * p.position), .rotation = p.rotation.transpose()};
}

template <class F>
void for_each_pair(const Zoo& zoo, const F& f) {
  for (std::size_t i = 0; i < zoo.all.size(); ++i)
    for (std::size_t j = i; j < zoo.all.size(); ++j) f(zoo.all[i], zoo.all[j]);
}

}  // namespace

// Tolerances: the kernel promises 1e-8 of the smaller body for EPA, and 1e-10 relative for GJK. Its own
// answer is certified (h(n) is a strict upper bound of the depth), so |depth − truth| and h(n) − truth are
// the same test; the brute-force truth may itself be too large for round shapes, never too small. 1e-6 L
// leaves room for its steps.
TEST_CASE("the native kernel finds the true depth of every pair, deep, shallow, touching and apart") {
  for (const double size : {1.0, 1e-3, 1e3}) {
    const Zoo zoo(size);
    std::mt19937 random(2026);
    const int count = size == 1.0 ? 40 : 10;
    int missed = 0, not_certified = 0;
    double worst = 0;
    for (const Depth depth : depths)
      for_each_pair(zoo, [&](const Shape& a, const Shape& b) {
        for (int k = 0; k < count; ++k) {
          double apart = 0;
          const Sample s = any_pose(a, b, depth, k % 2 == 1, random, apart);
          const double L = scale_of(s), margin = 10 * L;
          SignedPair r = ask(s, margin);
          const double claimed = r.distance;
          if (!certify(s.a, s.b, s.b_in_a, margin, L, r)) {
            ++not_certified;
            continue;
          }
          const bool is_exact = depth >= Depth::touch;
          const double truth = is_exact ? apart : -std::min(true_depth(s, random), s.reach(r.normal));
          if (depth < Depth::touch && claimed >= 0) ++missed;
          worst = std::max({worst, std::abs(claimed - truth) / L, std::abs(r.distance - truth) / L});
        }
      });
    CAPTURE(size, worst);
    CHECK(missed == 0);
    CHECK(not_certified == 0);
    CHECK(worst < 1e-6);
  }
}

TEST_CASE("swapping the bodies turns the normal round") {
  const Zoo zoo;
  std::mt19937 random(7);
  // The depth is unique. The normal is where the nearest points are: apart by 1e-3 or more, to the GJK bound
  // of 1e-10, that is an angle of sqrt(2e-10) = 1.4e-5.
  for (const Depth depth :
       {Depth::deep, Depth::hundredth, Depth::touch, Depth::gap_thousandth, Depth::gap_half})
    for_each_pair(zoo, [&](const Shape& a, const Shape& b) {
      for (int k = 0; k < 10; ++k) {
        double apart = 0;
        const Sample s = any_pose(a, b, depth, k % 2 == 1, random, apart);
        const SignedPair r = ask(s, 10), back = ask({b, a, inverse(s.b_in_a)}, 10);
        CHECK(std::abs(r.distance - back.distance) < 1e-7);
        if (depth >= Depth::gap_thousandth) CHECK((r.normal + s.b_in_a.rotation * back.normal).norm() < 3e-5);
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
        CHECK(std::abs(r.distance - q.distance / 1024) < 1e-7);
      }
}

// On a floor the answer is known: n = z, distance = −penetration. Within rounding, h(z) = penetration
// exactly, so the kernel may only answer a depth lower than that by its own tolerance, 1e-8 of the smaller
// body; and a normal that is off by θ costs at least θ r for a corner r away from the patch's centre. 0.5° is
// what a stack forgives.
TEST_CASE("exact touching, and all that rounding makes of it, gives the floor's normal") {
  const Zoo zoo;
  std::mt19937 random(3);
  for (const Shape& floor : {Shape(Box{20, 20, 1}), Shape(Cylinder{8, 1})})
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
            CHECK(std::abs(r.distance + penetration) < 1e-7);
          }
}

TEST_CASE("concentric bodies get a finite unit normal and the least sum of their thicknesses") {
  const Zoo zoo;
  std::mt19937 random(9);
  for_each_pair(zoo, [&](const Shape& a, const Shape& b) {
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

// Size ratios of 1e4 and plates of 1e-3: errors relative to the smaller body, 100 times the promised 1e-8
// because a difference of sizes costs digits: 1e-16 · 1e4 / 1e-8 is still below.
TEST_CASE("needles, plates and giants are bodies like any other") {
  const std::vector<Shape> shapes{Sphere{1e-4},    Sphere{1},        Box{1, 1, 1e-3},   Box{1000, 1000, 1},
                                  Box{1e-3, 1, 1}, Capsule{1e-3, 1}, Cylinder{1e-3, 1}, Cylinder{1, 1e-3}};
  std::mt19937 random(4);
  for (const Shape& a : shapes)
    for (const Shape& b : shapes)
      for (const Depth depth : {Depth::touch, Depth::gap_thousandth, Depth::gap_half})
        for (int k = 0; k < 6; ++k) {
          double apart = 0;
          const Sample s = any_pose(a, b, depth, k % 2 == 1, random, apart);
          const double L = scale_of(s);
          SignedPair r = ask(s, 10 * L);
          REQUIRE(certify(s.a, s.b, s.b_in_a, 10 * L, L, r));
          CHECK(std::abs(r.distance - apart) < 1e-6 * L);
        }
}

TEST_CASE("the distance holds its digits from a gap of 1e-9 to 1") {
  const Zoo zoo;
  std::mt19937 random(8);
  // GJK's bounds meet to 1e-10 of the distance of the cores, which is the gap and both radii. On round rims
  // it may stop before, where the simplex has shrunk to rounding: 1e-8 of the size, as promised of EPA.
  for_each_pair(zoo, [&](const Shape& a, const Shape& b) {
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
  for_each_pair(zoo, [&](const Shape& a, const Shape& b) {
    double apart = 0;
    const Sample s = any_pose(a, b, Depth::gap_half, false, random, apart);
    SignedPair r = ask(s, 0.5 * apart);
    CHECK(r.status == PairStatus::far);
    CHECK(certify(s.a, s.b, s.b_in_a, 0.5 * apart, scale_of(s), r));
  });
}
