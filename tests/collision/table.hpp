/// Rows of the table of acceptance about distances and normals, for every backend: docs/evidence/collision.md lists
/// them.
#pragma once

#include "catch.hpp"
#include "collision/acceptance.hpp"
#include "collision/scene.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace scenes {

using namespace samples;

inline double deepest_gap(const std::vector<ContactPoint>& contacts) {
  double deepest = std::numeric_limits<double>::infinity();
  for (const ContactPoint& c : contacts) deepest = c.gap < deepest || std::isnan(c.gap) ? c.gap : deepest;
  return deepest;
}

inline bool is_smooth(const Shape& s) {
  return s.kind == ShapeKind::sphere || s.kind == ShapeKind::ellipsoid || s.kind == ShapeKind::capsule;
}

inline bool has_flat_faces(const Shape& s) { return s.kind == ShapeKind::box || s.kind == ShapeKind::convex_hull; }

/// The least depth is unique, to 1e-9 L, and so is the normal, to 1e-6 rad: unless both touch with corners or
/// edges, then any normal that both have there will do. Coordinates of 1 m keep 2e-16, which turns the normal
/// of such bodies by 2e-16 m / distance: below 1e-9 L it has no six digits. Nor is there one normal where two
/// flat faces of their difference are as deep, to the same 1e-9 L.
template <class Kernel>
void check_swap() {
  const Zoo zoo;
  std::mt19937 random(7);
  Kernel kernel;
  double distance = 0, lean = 0;
  int touching = 0, tied = 0, count = 0;
  const auto larger = [](double worst, double x) { return x <= worst ? worst : x; };  // NaN is the largest
  for (const Depth depth : depths)
    for_each_pair(zoo.all, [&](const Shape& a, const Shape& b) {
      for (int k = 0; k < poses(10); ++k) {
        double apart = 0;
        const Sample s = any_pose(a, b, depth, k % 2 == 1, random, apart);
        const Mat3 R = s.b_in_a.rotation;
        const Pose a_in_b{.position = -(R.transpose() * s.b_in_a.position), .rotation = R.transpose()};
        const double L = scale_of(s);
        const SignedPair r = certified_pair(kernel, a, b, s.b_in_a, 10 * L, L, Vec3::Zero()).pair,
                         back = certified_pair(kernel, b, a, a_in_b, 10 * L, L, Vec3::Zero()).pair;
        distance = larger(distance, std::abs(r.distance - back.distance) / L);
        const bool touches = std::abs(r.distance) < 1e-9 * L && !is_smooth(a) && !is_smooth(b);
        if (depth != Depth::touch) ++count, touching += touches;
        const Vec3 of_back = -(R * back.normal);
        const bool is_tied = has_flat_faces(a) && has_flat_faces(b) && (r.normal - of_back).norm() > 1e-6 &&
                             std::abs(s.reach(r.normal) - s.reach(of_back)) < 1e-9 * L;
        tied += is_tied && !touches;
        if (!touches && !is_tied) lean = larger(lean, (r.normal - of_back).norm());
      }
    });
  CAPTURE(distance, lean, touching, tied, count);
  CHECK(distance < 1e-9);
  CHECK(lean < 1e-6);
  CHECK(tied <= count / 10000);
  CHECK(touching <= count / 100);  // by chance: a corner on a face's rim
}

/// On a floor the answer is known: normal z, gap −penetration. No normal may lean by 0.5°, and no gap may lie
/// more than 1e-9 m under the truth; above it the corners of a cap may lie by 5e-5 L.
template <class Backend>
void check_touch_ladder() {
  const Zoo zoo;
  std::mt19937 random(3);
  const ConvexHull slab(std::vector<Vec3>{{-9, -9, -0.5},
                                          {9, -9, -0.5},
                                          {9, 9, -0.5},
                                          {-9, 9, -0.5},
                                          {0, 0, -2},
                                          {-9, -9, 0.5},
                                          {9, -9, 0.5},
                                          {9, 9, 0.5},
                                          {-9, 9, 0.5}});
  for (const Shape& floor :
       {Shape(Box{20, 20, 1}), Shape(Cylinder{8, 1}), Shape(slab), Shape(HalfSpace{{0, 0, 1}, 0.5})})
    for (const Shape& body : zoo.all)
      for (const double size : {0.0, 1e-16, 1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10})
        for (const double penetration : {size, -size})
          for (int way = 0; way < 4; ++way) {
            Mat3 R = Mat3::Identity();
            if (way == 1) R = turned(0.5, Vec3::UnitZ());
            if (way == 2) R = turned(M_PI / 2, Vec3::UnitX());
            if (way == 3) R = any_rotation(random);
            const double low = (R * support(body, Vec3(-R.row(2).transpose())))[2];
            SceneOf<Backend> scene;
            scene.add(floor, {0, 0, 0}, Mat3::Identity(), false);
            scene.add(body, {0.1, 0.2, 0.5 - low - penetration}, R);
            for (int step = 0; step < 2; ++step) scene.detect();
            CAPTURE(name(floor.kind), name(body.kind), penetration, way);
            REQUIRE(!scene.contacts.empty());
            for (const ContactPoint& c : scene.contacts) CHECK(c.normal[2] > std::cos(0.5 * M_PI / 180));
            const double gap = deepest_gap(scene.contacts);
            CHECK(gap > -penetration - 1e-9);
            CHECK(gap < -penetration + 5.1e-5 * length_scale(body));
          }
}

/// One in the other, middle on middle: a unit normal, and the least depth over all directions to 1e-6 m.
template <class Kernel>
void check_concentric() {
  const Zoo zoo;
  std::mt19937 random(9);
  Kernel kernel;
  for_each_pair(zoo.all, [&](const Shape& a, const Shape& b) {
    for (int way = 0; way < 4; ++way) {
      Sample s{a, b, {}};
      if (way > 0) s.b_in_a.rotation = any_rotation(random);
      const SignedPair r = certified_pair(kernel, a, b, s.b_in_a, 1, scale_of(s), Vec3::Zero()).pair;
      CAPTURE(name(a.kind), name(b.kind), way, r.distance);
      CHECK(std::abs(r.normal.norm() - 1) < 1e-9);
      CHECK(std::abs(-r.distance - std::min(true_depth(s, random), s.reach(r.normal))) < 1e-6);
    }
  });
}

/// Gaps from 1e-9 to 1 m: distances to 1e-6 of them, but for the rounding of coordinates of 1 m, and normals
/// to 0.1°.
template <class Kernel>
void check_gaps() {
  const Zoo zoo;
  std::mt19937 random(8);
  Kernel kernel;
  for_each_pair(zoo.all, [&](const Shape& a, const Shape& b) {
    for (double gap = 1e-9; gap < 1.5; gap *= 10)
      for (int k = 0; k < poses(10); ++k) {
        const Mat3 rotation = any_rotation(random);
        const Vec3 n = any_direction(random);
        const Sample s = at_distance(a, b, rotation, n, gap);
        const SignedPair r = certified_pair(kernel, a, b, s.b_in_a, 10, scale_of(s), Vec3::Zero()).pair;
        CAPTURE(name(a.kind), name(b.kind), gap, r.distance - gap, (r.normal - n).norm());
        CHECK(std::abs(r.distance - gap) <= 1e-6 * gap + 2e-15);
        CHECK((r.normal - n).norm() < 0.1 * M_PI / 180);
      }
  });
}

/// Needles, plates and giants, of 1e4 times the other's size: no overlap is missed; the depth of what
/// overlaps by 1e-4 L or less is right to 1e-4 L, a deeper one to `deep`.
template <class Kernel>
void check_extremes(double deep) {
  const std::vector<Shape> shapes{
      Sphere{1e-4},          Box{1, 1, 1e-3},         Box{1000, 1000, 1}, Capsule{1e-3, 1},
      Cylinder{1e-3, 1},     Cylinder{1, 1e-3},       Cone{1e-3, 1},      Cone{1, 1e-3},
      Ellipsoid{1, 1, 1e-3}, Ellipsoid{1e-3, 1, 1e-3}};
  for (const Depth depth : depths) {
    if (depth == Depth::hundredth) continue;  // deeper than a plate is thick
    const Figures f = accept<Kernel>(shapes, depth, poses(4), 4);
    CAPTURE(int(depth), f.poses, f.rejected, f.deeper, f.depth_error, f.excess);
    CHECK(f.missed == 0);
    CHECK(f.depth_error < (depth == Depth::deep ? deep : 1e-4));
    CHECK(f.excess < (depth == Depth::deep ? deep : 1e-4));
  }
}

/// The pose is what a double keeps of it at 1e6 m, 1.2e-10; the truth is asked for that very pose. Settling
/// and the corners may miss 5e-5 L each; a portal may be `deeper` by so much.
template <class Backend>
void check_far_away(double deeper) {
  const Zoo zoo;
  std::mt19937 random(11);
  const Vec3 far(1e6, -1e6, 1e6);
  for (const Depth depth : {Depth::deep, Depth::ten_thousandth, Depth::touch, Depth::gap_thousandth})
    for_each_pair(zoo.all, [&](const Shape& a, const Shape& b) {
      for (int k = 0; k < poses(3); ++k) {
        double apart = 0;
        const Sample s = any_pose(a, b, depth, k % 2 == 1, random, apart);
        SceneOf<Backend> scene;
        scene.collision.margin = 0.1;
        scene.add(a, far);
        scene.add(b, far + s.b_in_a.position, s.b_in_a.rotation);
        scene.detect();
        const Pose kept{.position = scene.colliders[1].pose.position - far, .rotation = s.b_in_a.rotation};
        PairCache cache;
        const double truth = GjkEpa{}.pair(a, b, kept, 10, cache).distance,
                     deepest = deepest_gap(scene.contacts);
        CAPTURE(name(a.kind), name(b.kind), int(depth), deepest, truth);
        CHECK(deepest < truth + 1.1e-4 * scale_of(s));
        CHECK(deepest > truth - (1.1e-4 + (depth == Depth::deep ? deeper : 0)) * scale_of(s));
      }
    });
}

}  // namespace scenes
