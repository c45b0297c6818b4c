#include "catch.hpp"
#include "collision/mesh_scene.hpp"

#include <delassus/collision/with_compounds.hpp>

#include <cmath>
#include <limits>

namespace with_compounds_tests {

using namespace delassus;
using namespace scenes;
using Catch::Matchers::Contains;

namespace {

using CompoundScene = SceneOf<WithCompounds<WithMeshes<NativeCollision>>>;

/// A table: a top of 2 × 1 × 0.1 m, its upper side at z = 0, and four legs of 0.1 × 0.1 × 1 m.
Compound table() {
  std::vector<CompoundPart> parts{{.shape = Box{2, 1, 0.1}, .position = {0, 0, -0.05}}};
  for (const double x : {-0.9, 0.9})
    for (const double y : {-0.4, 0.4}) parts.push_back({.shape = Box{0.1, 0.1, 1}, .position = {x, y, -0.6}});
  return Compound(parts);
}

}  // namespace

TEST_CASE("a box cut into parts has the mass and the inertia of the box, turned parts and hulls too") {
  // 2 × 1 × 1 m from a cube hull about (3, 0, 0) and a box turned by 90° about y, of 1 m each: centre (3.5,
  // 0, 0).
  const ConvexHull cube = cube_hull();
  const Quat turn(Eigen::AngleAxisd(1.5707963267948966, Vec3(0, 1, 0)));
  const Compound c(std::vector<CompoundPart>{
      {.shape = cube, .position = {3, 0, 0}, .density = 600},
      {.shape = Box{1, 1, 1}, .position = {4, 0, 0}, .orientation = turn, .density = 600}});
  const MassProperties whole = mass_properties(Box{2, 1, 1}, 600);
  CHECK(std::abs(c.mass() - whole.mass) < 1e-12 * whole.mass);
  CHECK((c.centre() - Vec3(3.5, 0, 0)).norm() < 1e-14);
  CHECK((c.inertia() - whole.inertia).norm() < 1e-13 * whole.inertia.norm());
  CHECK((c.reach() - Vec3(1, 0.5, 0.5)).norm() < 1e-14);
  CHECK((c.pose(0).position - Vec3(-0.5, 0, 0)).norm() < 1e-14);
}

TEST_CASE("a compound that cannot be is refused by the number of its part") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto make = [](const CompoundPart& second) {
    return Compound(std::vector<CompoundPart>{{.shape = Sphere{1}}, second});
  };
  CHECK_THROWS_WITH(Compound(std::vector<CompoundPart>{}), Contains("at least one part"));
  // 4/3 π (1e-120)³ is no number but zero, and the middle would be 0/0.
  CHECK_THROWS_WITH(Compound(std::vector<CompoundPart>{{.shape = Sphere{1e-120}}}),
                    Contains("compound of 0 kg"));
  CHECK_THROWS_WITH(Compound(std::vector<CompoundPart>{{.shape = Sphere{1}, .density = 1e308}}),
                    Contains("compound of inf kg"));
  CHECK_THROWS_WITH(make({.shape = Box{1, 0, 1}}), Contains("compound part #1: box edge y"));
  CHECK_THROWS_WITH(make({.shape = HalfSpace{}}), Contains("compound part #1: a half-space has no volume"));
  CHECK_THROWS_WITH(make({.shape = Sphere{1}, .density = 0}), Contains("compound part #1: density 0"));
  CHECK_THROWS_WITH(make({.shape = Sphere{1}, .position = {nan, 0, 0}}),
                    Contains("compound part #1: its pose"));
}

TEST_CASE("a table stands on its legs, on a half-space and on a mesh, and its contacts are the body's") {
  for (const bool is_meshed : {false, true}) {
    CompoundScene scene;
    const Compound compound = table();
    const Shape floor = is_meshed ? scene.collision.backend.add(flat_grid(3, 13, 0.2)) : Shape(HalfSpace{});
    scene.add(floor, {0, 0, 0}, Mat3::Identity(), false);
    scene.add(scene.collision.add(compound), {0.1, 0.2, 1.0999 + compound.centre()[2]});
    scene.add(Box{0.2, 0.2, 0.2}, {0.1, 0.2, 1.1998});
    for (int step = 0; step < 3; ++step) scene.detect();
    REQUIRE(scene.contacts.size() == 20);  // four legs and a box, four corners each
    for (std::size_t i = 0; i < 20; ++i) {
      const ContactPoint& p = scene.contacts[i];
      CHECK(p.a == (i < 16 ? 0 : 1));
      CHECK(p.b == (i < 16 ? 1 : 2));
      CHECK(std::abs(p.gap + 1e-4) < 1e-14);
      CHECK((p.normal - Vec3(0, 0, 1)).norm() < 1e-14);
      CHECK((p.point_b - p.point_a - p.gap * p.normal).norm() < 1e-14);
      if (i > 0 && i != 16) CHECK(scene.contacts[i - 1].feature < p.feature);
    }
  }
}

// The gap is linear over faces that adjoin in one plane: what is inside of their hull holds nothing that its corners do not.
TEST_CASE("parts side by side are one face, under a compound and on one") {
  const auto tiles = [](double drop) {
    std::vector<CompoundPart> parts;
    for (int k = 0; k < 9; ++k)
      parts.push_back({.shape = Box{0.2, 0.2, 0.1}, .position = {0.2 * (k % 3 - 1), 0.2 * (k / 3 - 1), k == 4 ? -drop : 0}});
    return Compound(parts);
  };
  for (const bool is_below : {false, true}) {
    CompoundScene scene;
    const Shape shape = scene.collision.add(tiles(0)), plate = Box{0.4, 0.4, 0.1};
    scene.add(is_below ? shape : Shape(HalfSpace{}), {0, 0, is_below ? -0.05 : 0}, Mat3::Identity(), false);
    scene.add(is_below ? plate : shape, {0.03, 0.02, 0.0499}, turned(0.3, Vec3::UnitZ()));
    scene.detect();
    const double half = is_below ? 0.2 : 0.3, right = 4 * half * half;
    REQUIRE(scene.contacts.size() == 4);
    double area = 0;
    Vec3 middle = Vec3::Zero();
    for (const ContactPoint& p : scene.contacts) {
      const Vec3 at = turned(-0.3, Vec3::UnitZ()) * (p.point() - Vec3(0.03, 0.02, p.point().z()));
      CAPTURE(is_below, at.x(), at.y());
      CHECK((Vec3(std::abs(at.x()), std::abs(at.y()), 0) - Vec3(half, half, 0)).norm() < 1e-9);
      area += p.area, middle += p.middle / 4;
    }
    CHECK(std::abs(area - right) < 1e-9);
    CHECK((middle - Vec3(0.03, 0.02, middle.z())).norm() < 1e-9);
  }
  // The middle one stands out by 0.01 mm: it alone is deeper, and stays.
  CompoundScene scene;
  scene.add(HalfSpace{}, {0, 0, 0}, Mat3::Identity(), false);
  const Compound uneven = tiles(1e-5);
  scene.add(scene.collision.add(uneven), {0, 0, 0.0499 + uneven.centre().z()});
  scene.detect();
  int deepest = 0;
  for (const ContactPoint& p : scene.contacts) deepest += std::abs(p.gap + 1.1e-4) < 1e-9;
  CHECK(deepest == 4);
}

TEST_CASE("contacts of parts keep their names while bodies come and go before them") {
  CompoundScene scene;
  const Compound compound = table();
  scene.add(HalfSpace{}, {0, 0, 0}, Mat3::Identity(), false);
  scene.add(scene.collision.add(compound), {0, 0, 1.1 + compound.centre()[2]});
  scene.detect();
  const auto before = scene.contacts;
  REQUIRE(before.size() == 16);
  scene.add(scene.collision.add(compound), {5, 0, 1.1 + compound.centre()[2]});
  std::swap(scene.colliders[1], scene.colliders[2]);
  scene.detect();
  REQUIRE(scene.contacts.size() == 32);
  for (std::size_t i = 0; i < 16; ++i) {
    CHECK(scene.contacts[i].pair == before[i].pair);
    CHECK(scene.contacts[i].feature == before[i].feature);
    CHECK(scene.contacts[i].b == 2);
  }
}

TEST_CASE("a part's velocity is that of the body there: a turning bar is met early at its end") {
  CompoundScene scene;
  const Shape bar = scene.collision.add(
      Compound(std::vector<CompoundPart>{{.shape = Box{1, 0.1, 0.1}, .position = {-1, 0, 0}},
                                         {.shape = Box{1, 0.1, 0.1}, .position = {1, 0, 0}}}));
  scene.add(bar, {0, 0, 0}).angular_velocity = {0, -10, 0};  // the end at +x rises by 10 m/s
  scene.add(Sphere{0.1}, {1, 0, 0.158});
  scene.detect(1e-3);
  CHECK(scene.contacts.size() == 1);  // 8 mm away, 10 mm in a step
  scene.colliders[0].angular_velocity.setZero();
  scene.detect(1e-3);
  CHECK(scene.contacts.empty());
}

}  // namespace with_compounds_tests
