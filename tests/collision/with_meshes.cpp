#include "catch.hpp"
#include "collision/mesh_scene.hpp"

#include <cmath>
#include <cstdlib>
#include <set>

namespace with_meshes_tests {

using namespace delassus;
using namespace scenes;

namespace {

/// The one contact of a ball with one triangle, the ball's centre at c.
ContactPoint touch(const Vec3& c, double radius) {
  MeshScene scene;
  const std::vector<Vec3> v{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  const Shape triangle = scene.collision.add(TriangleMesh(v, std::vector<Corners>{{0, 1, 2}}));
  scene.add(triangle, {0, 0, 0}, Mat3::Identity(), false);
  scene.add(Sphere{radius}, c);
  scene.collision.backend.margin = 0.5;
  scene.detect();
  REQUIRE(scene.contacts.size() == 1);
  return scene.contacts[0];
}

}  // namespace

// Products of lengths below 4 m in double: errors of a few 1e-16 m², distances above 0.3 m: 1e-14 is ten
// times that.
TEST_CASE("a ball touches a triangle over its inside, at its edges and at its corners where geometry says") {
  const double e = 1e-14;
  const ContactPoint inside = touch({0.5, 0.5, 0.45}, 0.5);
  CHECK(std::abs(inside.gap + 0.05) < e);
  CHECK((inside.normal - Vec3(0, 0, 1)).norm() < e);
  CHECK((inside.point_a - Vec3(0.5, 0.5, 0)).norm() < e);

  // Beyond the edge along x: the nearest point is straight below and behind, the distance √(0.3² + 0.4²) =
  // 0.5.
  const ContactPoint edge = touch({1, -0.3, 0.4}, 0.4);
  CHECK(std::abs(edge.gap - 0.1) < e);
  CHECK((edge.normal - Vec3(0, -0.6, 0.8)).norm() < e);
  CHECK((edge.point_a - Vec3(1, 0, 0)).norm() < e);

  // Beyond the corner at the origin: √(0.2² + 0.1² + 0.2²) = 0.3.
  const ContactPoint corner = touch({-0.2, -0.1, 0.2}, 0.25);
  CHECK(std::abs(corner.gap - 0.05) < e);
  CHECK((corner.normal - Vec3(-2, -1, 2) / 3).norm() < e);
  CHECK(corner.point_a.norm() < e);

  // The long edge x + y = 2: from (1.2, 1.2, 0.3) it is √2 · 0.2 away in the plane.
  const ContactPoint slanted = touch({1.2, 1.2, 0.3}, 0.4);
  CHECK(std::abs(slanted.gap - (std::sqrt(0.08 + 0.09) - 0.4)) < e);
}

TEST_CASE("the solid is behind the triangles: what has its middle there does not meet them") {
  MeshScene scene;
  const Shape floor = scene.collision.add(flat_grid(1, 2));
  scene.add(floor, {0, 0, 0}, Mat3::Identity(), false);
  scene.add(Sphere{0.5}, {0.1, 0.2, -0.01});
  scene.detect();
  CHECK(scene.contacts.empty());
}

TEST_CASE("a box on a meshed floor has the contacts it has on a half-space") {
  for (const double height : {0.5, 0.4999, 0.5004}) {
    Scene flat;
    flat.add(HalfSpace{}, {0, 0, 0}, Mat3::Identity(), false);
    flat.add(Box{1, 1, 1}, {0.13, 0.07, height});
    flat.detect();
    MeshScene meshed;
    meshed.add(meshed.collision.add(flat_grid(3, 11, 0.2)), {0, 0, 0}, Mat3::Identity(), false);
    meshed.add(Box{1, 1, 1}, {0.13, 0.07, height});
    meshed.detect();
    REQUIRE(flat.contacts.size() == 4);
    REQUIRE(meshed.contacts.size() == 4);
    for (const ContactPoint& p : meshed.contacts) {
      double nearest = 1;
      for (const ContactPoint& q : flat.contacts)
        nearest = std::min(nearest, (p.point_b - q.point_b).norm() + std::abs(p.gap - q.gap));
      CHECK(nearest < 1e-15);  // sums of two numbers below 1 m, no products: one rounding each
      CHECK(p.normal == Vec3(0, 0, 1));
    }
  }
}

TEST_CASE("a box on a meshed box has the contacts it has on a box") {
  // Rotated by 45°, so that the patch is an octagon of which four are taken, and pushed over the edge.
  const Mat3 turn = Eigen::AngleAxisd(0.3, Vec3(0, 0, 1)).toRotationMatrix();
  for (const Vec3& at : {Vec3(0.1, 0.05, 0.999), Vec3(0.7, 0.3, 0.9995), Vec3(-0.6, 0.62, 1.001)}) {
    Scene solid;
    solid.add(Box{1, 1, 1}, {0, 0, 0}, Mat3::Identity(), false);
    solid.add(Box{1, 1, 1}, at, turn);
    solid.collision.max_points = 8;
    solid.detect();
    MeshScene meshed;
    meshed.add(meshed.collision.add(box_mesh(1, 1, 1)), {0, 0, 0}, Mat3::Identity(), false);
    meshed.add(Box{1, 1, 1}, at, turn);
    meshed.collision.backend.max_points = 8;
    meshed.detect();
    CHECK(solid.contacts.size() == meshed.contacts.size());
    REQUIRE(!meshed.contacts.empty());
    for (const ContactPoint& p : meshed.contacts) {
      double nearest = 1;
      for (const ContactPoint& q : solid.contacts)
        nearest = std::min(nearest, (p.point_b - q.point_b).norm() + std::abs(p.gap - q.gap));
      CHECK(nearest < 3e-7);  // a corner within 1e-7 of the size of a side counts as inside, in either patch
      CHECK((p.normal - Vec3(0, 0, 1)).norm() < 1e-12);
    }
  }
}

TEST_CASE("a shape deep in a plain of triangles is as deep as in a half-space, however it lies") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const std::vector<Shape> shapes{Box{0.3, 0.2, 0.2}, Capsule{0.1, 0.2}, Cylinder{0.1, 0.25}, Cone{0.12, 0.3},
                                  Sphere{0.15}};
  for (const int cells : {2, 5, 16})
    for (int n = 0; n < 200; ++n) {
      const Shape& shape = shapes[std::size_t(n) % shapes.size()];
      const Quat turn{uniform(random), uniform(random), uniform(random), uniform(random)};
      const Mat3 R = turn.normalized().toRotationMatrix();
      const double half =
          -support(shape, Vec3(-R.transpose() * Vec3(0, 0, 1))).dot(R.transpose() * Vec3(0, 0, 1));
      // The middle of the shape stays above, its lowest point goes down to nine tenths of the way there.
      const double depth = 0.45 * half * (1 + uniform(random));
      const Vec3 at{0.6 * uniform(random), 0.6 * uniform(random), half - depth};
      MeshScene scene;
      scene.add(scene.collision.add(flat_grid(1, cells, 0.2, unsigned(n))), {0, 0, 0}, Mat3::Identity(),
                false);
      scene.add(shape, at, R);
      scene.detect();
      INFO("cells " << cells << ", scene " << n);
      double deepest = 1;
      for (const ContactPoint& p : scene.contacts) {
        deepest = std::min(deepest, p.gap);
        CHECK((p.normal - Vec3(0, 0, 1)).norm() < 1e-9);
      }
      CHECK(deepest > -depth - 1e-9);
      // Of points nearer than 1e-3 L one stays: 5e-5 L at the most. A cone's tip may be below a triangle that
      // the cone does not cross, and has the depth of those it does.
      CHECK(deepest < -depth + (shape.kind == ShapeKind::cone ? 0.1 * depth : 2e-5));
    }
}

TEST_CASE("a box pushed against the rim of a meshed box is pushed back sideways, not up") {
  MeshScene scene;
  scene.add(scene.collision.add(box_mesh(1, 1, 1)), {0, 0, 0}, Mat3::Identity(), false);
  scene.add(Box{1, 1, 1}, {0.999, 0.1, 0.4});
  scene.detect();
  REQUIRE(!scene.contacts.empty());
  for (const ContactPoint& p : scene.contacts) {
    CHECK((p.normal - Vec3(1, 0, 0)).norm() < 1e-9);
    CHECK(std::abs(p.gap + 0.001) < 1e-9);
  }
}

TEST_CASE(
    "a box in the side of a cliff of many triangles is told the way out of the side, and no depth below the "
    "top") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  const TriangleMesh cliff = fine_box(1, 1, 1, 20);
  for (int n = 0; n < 200; ++n) {
    const Mat3 turn = Eigen::AngleAxisd(M_PI * uniform(random), Vec3(0, 0, 1)).toRotationMatrix();
    const double reach = 0.15 * std::abs(turn(0, 0)) + 0.1 * std::abs(turn(0, 1));
    // Its middle is above the top, so it has 1 dm less 5 cm and more below it.
    const double depth = 0.0015 + 0.03 * uniform(random), over = 0.005 + 0.045 * uniform(random);
    MeshScene scene;
    scene.add(scene.collision.add(cliff), {0, 0, 0}, Mat3::Identity(), false);
    scene.add(Box{0.3, 0.2, 0.2}, {0.5 + reach - depth, 0.2 * uniform(random), 0.5 + over}, turn);
    scene.detect();
    CAPTURE(n, depth);
    REQUIRE(!scene.contacts.empty());
    for (const ContactPoint& p : scene.contacts) CHECK(p.gap > -depth - 1e-9);
  }
}

TEST_CASE("what slides over coplanar triangles never leaves their plane, and keeps its contacts' names",
          "[table]") {
  // 100 m over 20 000 triangles where DELASSUS_SLIDE is set; a tenth of both else.
  const bool is_long = std::getenv("DELASSUS_SLIDE") != nullptr;
  const int cells = is_long ? 100 : 32, steps = is_long ? 10000 : 1000;
  const double half = is_long ? 55 : 6;
  for (const bool is_ball : {true, false}) {
    MeshScene scene;
    scene.add(scene.collision.add(flat_grid(half, cells, 0.3, 7)), {0, 0, 0}, Mat3::Identity(), false);
    const Mat3 turn = Eigen::AngleAxisd(0.4, Vec3(0, 0, 1)).toRotationMatrix();
    Collider& body = is_ball ? scene.add(Sphere{0.5}, {0, 0, 0}) : scene.add(Box{1, 1, 1}, {0, 0, 0}, turn);
    body.velocity = {10, 1, 0};
    double hop = 0;
    std::size_t kept = 0, all = 0;
    std::set<std::uint32_t> last;
    for (int step = 0; step < steps; ++step) {
      const double way = 0.01 * step - 0.005 * steps;
      scene.colliders[1].pose.position = {way, 0.1 * way, 0.5};
      scene.detect(1e-3);
      REQUIRE(scene.contacts.size() == (is_ball ? 1u : 4u));
      std::set<std::uint32_t> now;
      for (const ContactPoint& p : scene.contacts) {
        hop = std::max(hop, std::abs(p.gap));
        hop = std::max(hop, (p.normal - Vec3(0, 0, 1)).norm());
        now.insert(p.feature);
        kept += last.count(p.feature);
        ++all;
      }
      last = now;
    }
    CHECK(hop < 1e-15);
    CHECK(double(kept) > 0.98 * double(all));
  }
}

TEST_CASE("a convex edge carries, a hollow one does not") {
  // A roof with its ridge along y at z = 0, falling by 45° on both sides, and the same turned into a valley.
  for (const double side : {1.0, -1.0}) {
    MeshScene scene;
    const std::vector<Vec3> v{{0, -2, 0},        {0, 2, 0},           {2, -2, -2 * side},
                              {2, 2, -2 * side}, {-2, -2, -2 * side}, {-2, 2, -2 * side}};
    const Shape roof = scene.collision.add(
        TriangleMesh(v, std::vector<Corners>{{0, 2, 3}, {0, 3, 1}, {0, 1, 5}, {0, 5, 4}}));
    scene.add(roof, {0, 0, 0}, Mat3::Identity(), false);
    const double z = side > 0 ? 0.499 : 0.7;  // in the valley the ball of 0.5 m rests at √2 / 2
    scene.add(Sphere{0.5}, {0, 0.3, z});
    scene.detect();
    if (side > 0) {
      REQUIRE(scene.contacts.size() == 1);
      CHECK((scene.contacts[0].normal - Vec3(0, 0, 1)).norm() < 1e-12);
      CHECK(std::abs(scene.contacts[0].gap + 0.001) < 1e-12);
    } else {
      REQUIRE(scene.contacts.size() == 2);
      for (const ContactPoint& p : scene.contacts) {
        CHECK(std::abs(std::abs(p.normal[0]) - std::sqrt(0.5)) < 1e-12);
        CHECK(std::abs(p.gap - (0.7 * std::sqrt(0.5) - 0.5)) < 1e-12);
      }
    }
  }
}

TEST_CASE("a ball over an edge that is nearly flat touches it") {
  // Both sides fall by 3e-3 rad: seen along either normal, the ball's lowest point is beside that triangle.
  const double slope = 3e-3;
  const std::vector<Vec3> v{{0, -2, 0},           {0, 2, 0},          {2, -2, -2 * slope}, {2, 2, -2 * slope},
                            {-2, -2, -2 * slope}, {-2, 2, -2 * slope}};
  for (const double x : {0.0, 5e-4, 4e-3}) {
    MeshScene scene;
    const Shape roof = scene.collision.add(
        TriangleMesh(v, std::vector<Corners>{{0, 2, 3}, {0, 3, 1}, {0, 1, 5}, {0, 5, 4}}));
    scene.add(roof, {0, 0, 0}, Mat3::Identity(), false);
    scene.add(Sphere{0.5}, {x, 0.3, 0.499});
    scene.detect();
    REQUIRE(scene.contacts.size() == 1);
    // The normal is between those of the sides; the depth is 1e-3 m but for cosines of 3e-3.
    CHECK((scene.contacts[0].normal - Vec3(0, 0, 1)).norm() < 1.001 * slope);
    CHECK(std::abs(scene.contacts[0].gap + 1e-3) < 2e-5);
  }
}

TEST_CASE("a meshed box on a half-space has the contacts of the box") {
  const Mat3 tilt = Eigen::AngleAxisd(0.01, Vec3(0.3, 1, 0).normalized()).toRotationMatrix();
  Scene solid;
  solid.add(HalfSpace{}, {0, 0, 0}, Mat3::Identity(), false);
  solid.add(Box{1, 2, 3}, {1, 2, 1.5}, tilt);
  solid.collision.margin = 0.1;
  solid.detect();
  MeshScene meshed;
  const Shape box = meshed.collision.add(box_mesh(1, 2, 3));
  meshed.add(HalfSpace{}, {0, 0, 0}, Mat3::Identity(), false);
  meshed.add(box, {1, 2, 1.5}, tilt);
  meshed.collision.backend.margin = 0.1;
  for (int step = 0; step < 2; ++step) meshed.detect();
  REQUIRE(solid.contacts.size() == 4);
  REQUIRE(meshed.contacts.size() == 4);
  for (const ContactPoint& p : meshed.contacts) {
    double nearest = 1;
    for (const ContactPoint& q : solid.contacts)
      nearest = std::min(
          nearest, (p.point_b - q.point_b).norm() + (p.normal - q.normal).norm() + std::abs(p.gap - q.gap));
    CHECK(nearest < 1e-14);  // coordinates of a few metres, turned and turned back
  }
}

TEST_CASE("groups, masks and what does not move hold for meshes") {
  const auto contacts = [](std::uint32_t group, bool is_movable) {
    MeshScene scene;
    const Shape floor = scene.collision.add(flat_grid(1, 2));
    scene.add(floor, {0, 0, 0}, Mat3::Identity(), false).collides_with = 1;
    scene.add(Sphere{0.5}, {0, 0, 0.499}, Mat3::Identity(), is_movable).group = group;
    scene.detect();
    CHECK(scene.report.points == Index(scene.contacts.size()));
    return scene.contacts.size();
  };
  CHECK(contacts(1, true) == 1);
  CHECK(contacts(2, true) == 0);
  CHECK(contacts(1, false) == 0);
}

TEST_CASE("contacts with meshes come sorted by pair and feature, from the lower key to the higher") {
  for (const bool is_last : {false, true}) {
    MeshScene scene;
    const Shape floor = scene.collision.add(flat_grid(3, 7, 0.3));
    if (!is_last) scene.add(floor, {0, 0, 0}, Mat3::Identity(), false);
    for (int i = 0; i < 3; ++i) scene.add(Box{1, 1, 1}, {0.2 + i, 0.1, 0.499});
    if (is_last) scene.add(floor, {0, 0, 0}, Mat3::Identity(), false);
    scene.detect();
    CHECK(scene.contacts.size() >= 12);
    for (std::size_t i = 0; i < scene.contacts.size(); ++i) {
      const ContactPoint& p = scene.contacts[i];
      CHECK(scene.colliders[p.a].key < scene.colliders[p.b].key);
      CHECK(p.pair == pair_key(scene.colliders[p.a].key, scene.colliders[p.b].key));
      CHECK((p.point_b - p.point_a - p.gap * p.normal).norm() < 1e-14);
      if (i == 0) continue;
      const ContactPoint& q = scene.contacts[i - 1];
      CHECK((q.pair < p.pair || (q.pair == p.pair && q.feature < p.feature)));
    }
  }
}

}  // namespace with_meshes_tests
