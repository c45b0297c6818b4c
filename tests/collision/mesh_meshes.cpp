#include "catch.hpp"
#include "collision/mesh_scene.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <set>

namespace mesh_meshes_tests {

using namespace delassus;
using namespace scenes;

namespace {

/// Two surfaces, the second posed at x; contacts run from the first to the second.
MeshScene pair_of(TriangleMesh a, TriangleMesh b, const Vec3& x, const Mat3& R = Mat3::Identity(),
                  double margin = -1) {
  MeshScene scene;
  scene.collision.backend.margin = margin;
  const Shape first = scene.collision.add(std::move(a)), second = scene.collision.add(std::move(b));
  scene.add(first, {0, 0, 0}, Mat3::Identity(), false);
  scene.add(second, x, R);
  scene.detect();
  return scene;
}

double farthest_from(const std::vector<ContactPoint>& from, const std::vector<ContactPoint>& to) {
  double worst = 0;
  for (const ContactPoint& p : from) {
    double nearest = 1e9;
    for (const ContactPoint& q : to)
      nearest = std::min(
          nearest, (p.point_b - q.point_b).norm() + std::abs(p.gap - q.gap) + (p.normal - q.normal).norm());
    worst = std::max(worst, nearest);
  }
  return worst;
}

}  // namespace

TEST_CASE("a meshed box on a meshed box has the contacts of the two boxes") {
  // Aligned, turned so that the patch is an octagon, over the edge, past the corner, and on the rim alone,
  // where the way out to the side is short as well; touching, sunk and hovering; with two triangles a side
  // and with many.
  for (const int cells : {1, 3})
    for (const double turn : {0.0, 0.3})
      for (const Vec3& at : {Vec3(0.1, 0.05, 0.999), Vec3(0.7, 0.3, 1), Vec3(-0.6, 0.62, 1.001),
                             Vec3(0.1, 0.98, 0.9999), Vec3(0.98, 0.2, 0.9999)}) {
        const Mat3 R = turned(turn, {0, 0, 1});
        Scene solid;
        solid.add(Box{1, 1, 1}, {0, 0, 0}, Mat3::Identity(), false);
        solid.add(Box{1, 1, 1}, at, R);
        solid.collision.max_points = 8;
        solid.detect();
        MeshScene meshed;
        meshed.collision.backend.max_points = 8;
        const Shape box = meshed.collision.add(fine_box(1, 1, 1, cells));
        meshed.add(box, {0, 0, 0}, Mat3::Identity(), false);
        meshed.add(box, at, R);
        meshed.detect();
        CAPTURE(cells, turn, at.transpose());
        CHECK(meshed.contacts.size() == solid.contacts.size());
        // Coordinates of 1 m: a corner within 1e-7 of the size of a side counts as inside in the boxes'
        // patch.
        CHECK(farthest_from(meshed.contacts, solid.contacts) < 3e-7);
        CHECK(farthest_from(solid.contacts, meshed.contacts) < 3e-7);
      }
}

TEST_CASE("a meshed box pushed against the rim of another is pushed back sideways, not up") {
  const MeshScene scene = pair_of(box_mesh(1, 1, 1), box_mesh(1, 1, 1), {0.999, 0.1, 0.4});
  REQUIRE(!scene.contacts.empty());
  for (const ContactPoint& p : scene.contacts) {
    CHECK((p.normal - Vec3(1, 0, 0)).norm() < 1e-9);
    CHECK(std::abs(p.gap + 0.001) < 1e-9);
  }
}

TEST_CASE("two roofs touch where their ridges cross, along the normal to both") {
  // Roofs of 90°, ridges along x and along y turned by 0.7 rad; the upper one upside down.
  const std::vector<Vec3> v{{-2, 0, 0}, {2, 0, 0}, {-2, 1, -1}, {2, 1, -1}, {-2, -1, -1}, {2, -1, -1}};
  const TriangleMesh roof(v, std::vector<Corners>{{0, 1, 3}, {0, 3, 2}, {1, 0, 4}, {1, 4, 5}});
  const Mat3 R = turned(0.7, {0, 0, 1}) * turned(3.14159265358979, {1, 0, 0});
  for (const double gap : {0.01, -0.01}) {
    const MeshScene scene = pair_of(roof, roof, {0.1, 0.2, gap}, R);
    REQUIRE(scene.contacts.size() == 1);
    const ContactPoint& p = scene.contacts[0];
    CHECK((p.normal - Vec3(0, 0, 1)).norm() < 1e-12);  // products of lengths of 4 m, divided by sin 0.7
    CHECK(std::abs(p.gap - gap) < 1e-12);
    // The second ridge passes through (0.1, 0.2) at 0.7 rad: it crosses y = 0 at x = 0.1 − 0.2 / tan 0.7.
    CHECK((p.point_a - Vec3(0.1 - 0.2 / std::tan(0.7), 0, 0)).norm() < 1e-12);
  }
}

TEST_CASE("in a corner of a mesh a vertex touches floor and wall") {
  // A hollow edge along x: floor z = 0 for y > 0, wall y = 0 for z > 0. A needle of a tetrahedron in it.
  const std::vector<Vec3> v{{-2, 0, 0}, {2, 0, 0}, {-2, 2, 0}, {2, 2, 0}, {-2, 0, 2}, {2, 0, 2}};
  const TriangleMesh corner(v, std::vector<Corners>{{0, 1, 3}, {0, 3, 2}, {1, 0, 4}, {1, 4, 5}});
  const std::vector<Vec3> w{{0, 0, 0}, {-.3, .5, 1}, {.3, .5, 1}, {0, 1, .5}};
  const TriangleMesh spike(w, std::vector<Corners>{{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}});
  for (const double depth : {1e-3, 1e-6, -1e-4}) {
    const MeshScene scene = pair_of(corner, spike, {0.1, -depth, -0.1 * depth});
    REQUIRE(scene.contacts.size() == 2);
    for (const ContactPoint& p : scene.contacts) {
      const bool is_wall = p.normal[1] > 0.5;
      CHECK((p.normal - (is_wall ? Vec3(0, 1, 0) : Vec3(0, 0, 1))).norm() < 1e-12);
      CHECK(std::abs(p.gap + (is_wall ? depth : 0.1 * depth)) < 1e-12);
    }
  }
}

TEST_CASE("a blade that lies on a keel's deck does not meet the keel through it") {
  // Deck z = 0, the keel (.5 or so, 0, −.9) away from it; the blade's edge, along y, is 1 mm in the deck. Its
  // upper side looks the other way than the keel, 0.42 m below it, and the two edges cross.
  const std::vector<Vec3> v{{0, 0, -.6}, {.52, 0, -.3},  {1.04, .5, 0},
                            {0, .5, 0},  {1.04, -.5, 0}, {0, -.5, 0}};
  const TriangleMesh hull(
      v, std::vector<Corners>{
             {0, 3, 1}, {1, 3, 2}, {0, 1, 5}, {1, 4, 5}, {0, 5, 3}, {1, 2, 4}, {2, 3, 5}, {2, 5, 4}});
  const std::vector<Vec3> w{{0, -.3, 0}, {0, .3, 0}, {1, -.3, 0}, {1, .3, 0}, {1, -.3, .2}, {1, .3, .2}};
  const TriangleMesh blade(
      w, std::vector<Corners>{
             {0, 1, 3}, {0, 3, 2}, {0, 4, 5}, {0, 5, 1}, {2, 3, 5}, {2, 5, 4}, {0, 2, 4}, {1, 5, 3}});
  REQUIRE(hull.is_closed());
  REQUIRE(blade.is_closed());
  const MeshScene scene = pair_of(hull, blade, {0.2, 0, -1e-3});
  REQUIRE(scene.contacts.size() == 4);
  for (const ContactPoint& p : scene.contacts) {
    CHECK((p.normal - Vec3(0, 0, 1)).norm() < 1e-12);
    CHECK(std::abs(p.gap + 1e-3) < 1e-12);
  }
}

TEST_CASE(
    "a meshed box that slides over coplanar triangles stays in their plane, and its contacts keep their "
    "names") {
  MeshScene scene;
  scene.add(scene.collision.add(flat_grid(6, 32, 0.3, 7)), {0, 0, 0}, Mat3::Identity(), false);
  Collider& body = scene.add(scene.collision.add(fine_box(1, 1, 1, 2)), {0, 0, 0}, turned(0.4, {0, 0, 1}));
  body.velocity = {10, 1, 0};
  double hop = 0;
  std::size_t kept = 0, all = 0;
  std::set<std::uint32_t> last;
  for (int step = 0; step < 400; ++step) {
    const double way = 0.01 * step - 2;
    scene.colliders[1].pose.position = {way, 0.1 * way, 0.5};
    scene.detect(1e-3);
    REQUIRE(scene.contacts.size() == 4);
    std::set<std::uint32_t> now;
    for (const ContactPoint& p : scene.contacts) {
      hop = std::max({hop, std::abs(p.gap), (p.normal - Vec3(0, 0, 1)).norm()});
      now.insert(p.feature);
      kept += last.count(p.feature);
      ++all;
    }
    last = now;
  }
  CHECK(hop < 1e-15);  // one rounding of 0.5 m, halved
  CHECK(double(kept) > 0.98 * double(all));
}

TEST_CASE("random poses of meshed boxes: no gap within the margin is missed, and none is wrong") {
  // The distance of two boxes that are apart is that of their certified kernel. Depths are not compared: the
  // contacts of two surfaces are local.
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto draw = [&] {
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    return Vec3(x, y, z);
  };
  int touching = 0;
  for (int k = 0; k < 300; ++k) {
    const double angle = 3 * uniform(random);
    const Vec3 axis = draw(), way = draw().normalized();
    const Mat3 R = turned(angle, axis);
    const Pose pose{1.5 * way, R};
    const SignedPair far = GjkEpa::convex(Shape(Box{1, 0.8, 0.6}), Shape(Box{0.7, 1, 0.9}), pose, 2, way);
    REQUIRE(far.status == PairStatus::near);
    if (far.distance < 0) continue;
    // Moved along the normal until the gap is 0.02 m: then the margin of 0.05 m holds it.
    const Vec3 at = pose.position - (far.distance - 0.02) * far.normal;
    const MeshScene scene = pair_of(box_mesh(1, 0.8, 0.6), box_mesh(0.7, 1, 0.9), at, R, 0.05);
    REQUIRE(!scene.contacts.empty());
    double least = std::numeric_limits<double>::infinity();
    for (const ContactPoint& p : scene.contacts) least = std::min(least, p.gap);
    // Normals within 0.02 rad of a face's become the face's: the gap is less by 1 − cos 0.02 = 2e-4 of it,
    // and a foot may lie beside the face by 0.02 of the gap.
    CHECK(std::abs(least - 0.02) < 3e-4 * 0.02 + 1e-9);
    ++touching;
  }
  CHECK(touching > 200);
}

TEST_CASE("a needle among the triangles changes nothing; what is no surface is refused by its number") {
  // A floor with a triangle 2 m long and 1e-5 m high along the middle, beneath a box.
  const double e = 1e-5;
  const std::vector<Vec3> v{{-1, -1, 0}, {1, -1, 0}, {1, 0, 0}, {-1, 0, 0}, {0, e, 0}, {1, 1, 0}, {-1, 1, 0}};
  const TriangleMesh floor(
      v, std::vector<Corners>{{0, 1, 2}, {0, 2, 3}, {3, 2, 4}, {4, 2, 5}, {4, 5, 6}, {3, 4, 6}});
  const MeshScene scene = pair_of(floor, box_mesh(1, 1, 1), {0.05, 0.1, 0.4999});
  REQUIRE(scene.contacts.size() == 4);
  for (const ContactPoint& p : scene.contacts) {
    CHECK((p.normal - Vec3(0, 0, 1)).norm() < 1e-9);
    CHECK(std::abs(p.gap + 1e-4) < 1e-9);
  }
  using Catch::Matchers::Contains;
  const std::vector<Vec3> w{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5, 1e-7, 0}};
  CHECK_THROWS_WITH(TriangleMesh(w, std::vector<Corners>{{0, 1, 2}, {1, 0, 3}, {0, 4, 1}}),
                    Contains("triangle #2") && Contains("flat"));
  CHECK_THROWS_WITH(TriangleMesh(w, std::vector<Corners>{{0, 1, 2}, {1, 0, 3}, {0, 1, 3}}),
                    Contains("edge (0, 1)") && Contains("at most two"));
}

TEST_CASE("a mesh meets a height field, and groups, masks and what does not move hold for two surfaces") {
  const auto contacts = [](std::uint32_t group, bool is_movable) {
    MeshScene scene;
    const Shape hills = scene.collision.add(HeightField(9, 9, 0.5, 0.5, std::vector<double>(81, 0.1)));
    const Shape cube = scene.collision.add(box_mesh(1, 1, 1));
    scene.add(hills, {0, 0, 0}, Mat3::Identity(), false).collides_with = 1;
    scene.add(cube, {0.13, 0.07, 0.5999}, Mat3::Identity(), is_movable).group = group;
    scene.detect();
    for (const ContactPoint& p : scene.contacts) {
      CHECK((p.normal - Vec3(0, 0, 1)).norm() < 1e-12);
      CHECK(std::abs(p.gap + 1e-4) < 1e-12);
      CHECK(p.a == 0);
    }
    return scene.contacts.size();
  };
  CHECK(contacts(1, true) == 4);
  CHECK(contacts(2, true) == 0);
  CHECK(contacts(1, false) == 0);
}

}  // namespace mesh_meshes_tests
