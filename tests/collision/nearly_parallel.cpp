#include <delassus/collision/native.hpp>
#include <delassus/geometry/convex_hull.hpp>

#include "catch.hpp"
#include "collision/scene.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace nearly_parallel_tests {

using namespace delassus;
using namespace scenes;

namespace {

/// How far x (body frame) is outside of the solid, m; zero on its surface. Written from the definitions of the shapes.
double outside(const Shape& s, const ConvexHull* hull, const Vec3& x) {
  const double across = std::hypot(x[0], x[1]);
  switch (s.kind) {
    case ShapeKind::half_space: return x.dot(Vec3(s.size[0], s.size[1], s.size[2])) - s.size[3];
    case ShapeKind::box: return std::max({std::abs(x[0]) - s.size[0], std::abs(x[1]) - s.size[1], std::abs(x[2]) - s.size[2]});
    case ShapeKind::capsule: return std::hypot(across, x[2] - std::clamp(x[2], -s.size[1], s.size[1])) - s.size[0];
    case ShapeKind::cylinder: return std::max(across - s.size[0], std::abs(x[2]) - s.size[1]);
    case ShapeKind::cone: {
      const double height = 2 * s.size[1], slant = std::hypot(s.size[0], height);
      return std::max((height * across + s.size[0] * (x[2] - 0.75 * height)) / slant, -0.25 * height - x[2]);
    }
    default: {
      double most = -1e9;
      for (Index f = 0; f < hull->face_count(); ++f)
        most = std::max(most, hull->normal(f).dot(x - hull->vertices()[hull->face(f)[0]]));
      return most;
    }
  }
}

/// max n · x over the body, m.
double reach(const Shape& s, const ConvexHull* hull, const Vec3& n) {
  const double across = std::hypot(n[0], n[1]);
  switch (s.kind) {
    case ShapeKind::half_space: return s.size[3];  // n is its normal
    case ShapeKind::box: return s.size[0] * std::abs(n[0]) + s.size[1] * std::abs(n[1]) + s.size[2] * std::abs(n[2]);
    case ShapeKind::capsule: return s.size[0] + s.size[1] * std::abs(n[2]);
    case ShapeKind::cylinder: return s.size[0] * across + s.size[1] * std::abs(n[2]);
    case ShapeKind::cone: return std::max(1.5 * s.size[1] * n[2], s.size[0] * across - 0.5 * s.size[1] * n[2]);
    default: {
      double most = -1e9;
      for (const Vec3& v : hull->vertices()) most = std::max(most, n.dot(v));
      return most;
    }
  }
}

struct Posed {
  Shape shape;
  const ConvexHull* hull;  ///< null: none
  Pose pose;
  double outside(const Vec3& x) const { return nearly_parallel_tests::outside(shape, hull, pose.rotation.transpose() * (x - pose.position)); }
  double reach(const Vec3& n) const {
    return n.dot(pose.position) + nearly_parallel_tests::reach(shape, hull, pose.rotation.transpose() * n);
  }
};

/// The body above lies on the one below, but for a turn of up to 3° about any axis, at the distance `gap` along z.
struct Pair {
  Posed below, above;
};

struct Kind {
  Shape shape;
  const ConvexHull* hull;
  Mat3 lying;
  bool is_line;  ///< a line of its side is below
};

struct Failures {
  double off_surface = 0, off_line = 0, off_depth = 0;
};

/// Of a pair apart both points prove the distance: no points are nearer than n · (b − a), and these are so near. The least
/// gap is then the signed distance. Bodies that overlap have the depth that n proves.
Failures failures(const Pair& pair) {
  Scene scene;
  scene.collision.margin = 0.05;
  scene.add(pair.below.shape, pair.below.pose.position, pair.below.pose.rotation, false);
  scene.add(pair.above.shape, pair.above.pose.position, pair.above.pose.rotation);
  scene.detect();
  REQUIRE(!scene.contacts.empty());
  Failures f;
  double least = 1e9;
  for (const ContactPoint& c : scene.contacts) {
    f.off_surface = std::max({f.off_surface, std::abs(pair.below.outside(c.point_a)), std::abs(pair.above.outside(c.point_b))});
    f.off_line = std::max(f.off_line, (c.point_b - c.point_a - c.gap * c.normal).norm());
    least = std::min(least, c.gap);
  }
  const Vec3& n = scene.contacts[0].normal;
  const double proven = -pair.above.reach(-n) - pair.below.reach(n);
  f.off_depth = std::abs(least - proven);
  return f;
}

}  // namespace

// Sizes are about 1 m, so 1e-9 of them is 1e-9 m. Of faces a patch may miss the least gap by 5e-5 L, and a face's normal is
// taken where it proves 1e-5 L less; the kernel's point between two rims is as good as its normal, 1e-5.
TEST_CASE("the contacts of nearly parallel bodies are points of their surfaces, and the least gap is the distance") {
  const Mat3 upright = Mat3::Identity(), over = turned(std::acos(-1.0), Vec3::UnitX()), across = turned(std::acos(0.0), Vec3::UnitY());
  const ConvexHull cube = cube_hull();
  std::vector<Vec3> corners;
  for (int k = 0; k < 6; ++k)
    for (const double z : {-0.3, 0.3}) corners.push_back({0.6 * std::cos(k * M_PI / 3), 0.6 * std::sin(k * M_PI / 3), z});
  const ConvexHull prism{corners};
  const Mat3 on_mantle = turned(std::acos(0.0) + std::atan2(0.3, 1.0), Vec3::UnitY());
  const std::vector<Kind> kinds{{Box{1, 0.8, 0.6}, nullptr, upright, false},   {cube, &cube, upright, false},
                                {prism, &prism, upright, false},              {Capsule{0.05, 1}, nullptr, across, true},
                                {Capsule{0.3, 0.7}, nullptr, across, true},   {Cylinder{0.2, 1}, nullptr, across, true},
                                {Cylinder{0.4, 0.5}, nullptr, upright, false}, {Cone{0.4, 0.8}, nullptr, upright, false},
                                {Cone{0.3, 1}, nullptr, on_mantle, true}};
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double degree = M_PI / 180;
  for (std::size_t i = 0; i <= kinds.size(); ++i)
    for (const Kind& top : kinds)
      for (int sample = 0; sample < 60; ++sample) {
        const bool is_plane = i == kinds.size();
        if (!is_plane && kinds[i].shape.kind == ShapeKind::cone && kinds[i].lying == upright) continue;  // the tip
        Pair pair;
        const double x = uniform(random), y = uniform(random), z = uniform(random), lean = 3 * degree * uniform(random),
                     yaw = (sample % 2 ? 3 * degree : 180 * degree) * uniform(random), dx = uniform(random), dy = uniform(random);
        const double gap = sample % 3 == 0 ? -1e-5 : 1e-4;
        if (is_plane) pair.below = {HalfSpace{}, nullptr, {Vec3::Zero(), upright}};
        else pair.below = {kinds[i].shape, kinds[i].hull, {Vec3::Zero(), kinds[i].is_line ? Mat3(over * kinds[i].lying) : kinds[i].lying}};
        const Mat3 R = turned(lean, Vec3(x, y, 0.1 * z)) * turned(yaw, Vec3::UnitZ()) * top.lying;
        pair.above = {top.shape, top.hull, {Vec3(0.2 * dx, 0.02 * dy, 0), R}};
        pair.above.pose.position.z() = gap + pair.above.reach(-Vec3::UnitZ()) + pair.below.reach(Vec3::UnitZ());
        CAPTURE(is_plane ? "plane" : name(kinds[i].shape.kind), i, name(top.shape.kind), sample, lean / degree, yaw / degree);
        const Failures f = failures(pair);
        const bool are_lines = !is_plane && kinds[i].is_line && top.is_line, is_exact = is_plane || are_lines;
        CHECK(f.off_surface < (is_exact || kinds[i].is_line || top.is_line ? 1e-9 : 1e-5));
        CHECK(f.off_line < 1e-9);
        CHECK(f.off_depth < (is_exact ? 1e-9 : 6e-5));
      }
}

// The foot of the capsule is under the middle of its lower ball, the higher end of its line on its mantle.
TEST_CASE("a capsule that leans is touched at its foot") {
  const double r = 0.05, L = 1;
  for (const double degrees : {-2.8, -1.9, -0.5, -0.01, 0.0, 0.01, 0.5, 1.9, 2.8}) {
    const double lean = degrees * M_PI / 180;
    Scene scene;
    scene.add(HalfSpace{}, Vec3::Zero(), Mat3::Identity(), false);
    scene.add(Capsule{r, L}, {0, 0, r + 0.5 * L * std::abs(std::sin(lean)) - 1e-6}, turned(std::acos(0.0) + lean, Vec3::UnitY()));
    scene.detect(1);
    CAPTURE(degrees);
    const auto lowest = std::min_element(scene.contacts.begin(), scene.contacts.end(), [](const auto& p, const auto& q) { return p.gap < q.gap; });
    REQUIRE(lowest != scene.contacts.end());
    CHECK(std::abs(lowest->gap + 1e-6) < 1e-15);
    if (lean != 0) CHECK(std::abs(lowest->point_b.x() - std::copysign(0.5 * L * std::cos(lean), lean)) < 1e-14);
  }
}

// A line that leaves the side beyond the base, or beyond the tip, and has not come through the base on its way, misses the solid.
TEST_CASE("no contact of cones and cylinders deep in each other is deeper than they overlap along it") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const Mat3 lying = turned(std::acos(0.0), Vec3::UnitX());
  for (const Shape& shape : {Shape{Cone{1, 1}}, Shape{Cone{0.4, 1.5}}, Shape{Cylinder{0.5, 1}}})
    for (int sample = 0; sample < 300; ++sample) {
      const double x = uniform(random), y = uniform(random), z = uniform(random), aside = 0.02 * uniform(random),
                   angle = sample % 3 ? 0.02 * uniform(random) : 0;
      const Posed a{shape, nullptr, {Vec3::Zero(), Mat3::Identity()}},
          b{shape, nullptr, {Vec3(aside, 0, 0), turned(angle, Vec3(x, y, z)) * (sample % 2 ? lying : Mat3::Identity())}};
      Scene scene;
      scene.add(shape, a.pose.position, a.pose.rotation, false);
      scene.add(shape, b.pose.position, b.pose.rotation);
      scene.detect();
      CAPTURE(name(shape.kind), sample);
      REQUIRE(!scene.contacts.empty());
      // Rounding of numbers of about 1 m.
      for (const ContactPoint& c : scene.contacts) CHECK(-c.gap <= a.reach(c.normal) + b.reach(-c.normal) + 1e-9);
    }
}

}  // namespace nearly_parallel_tests
