#include "allocations/count_allocations.hpp"

#include "catch.hpp"
#include "collision/mesh_scene.hpp"
#include "collision/samples.hpp"

#include <vector>

using namespace delassus;
using namespace scenes;

TEST_CASE("a warm detect() allocates nothing") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const ConvexHull hull = samples::ball_hull(20, 7, 0.5);
  const std::vector<Shape> shapes{Sphere{0.4},         Box{1, 0.6, 0.8}, Capsule{0.25, 0.8},
                                  Cylinder{0.35, 0.8}, hull,             Cone{0.4, 0.9},
                                  Ellipsoid{0.5, 0.3, 0.4}};
  Scene scene;
  scene.add(HalfSpace{}, {0, 0, -1}, Mat3::Identity(), false);
  for (std::size_t i = 0; i < 60; ++i) {
    const Vec3 at{uniform(random), uniform(random), uniform(random)};
    scene.add(shapes[i % shapes.size()], 1.5 * at, samples::any_rotation(random));
  }
  const auto move = [&](int step) {
    for (std::size_t i = 1; i < scene.colliders.size(); ++i)
      scene.colliders[i].pose.position[0] += (i % 2 ? 1e-3 : -1e-3) * (step % 2 ? 1 : -1);
  };
  for (int step = 0; step < 20; ++step) {
    move(step);
    scene.detect();
  }
  REQUIRE(scene.contacts.size() > 100);
  const long before = allocations;
  for (int step = 0; step < 20; ++step) {
    move(step);
    scene.detect();
  }
  CHECK(allocations == before);
}

TEST_CASE("bodies that part for the first time in a warm detect(), and meet again, allocate nothing") {
  Scene scene;
  for (int i = 0; i < 3; ++i) {
    scene.add(Box{1, 1, 1}, {2.0 * i, 0, 0}, Mat3::Identity(), false);
    scene.add(Box{1, 1, 1}, {2.0 * i + 0.1, 0, 1 - 1e-5});
  }
  for (int step = 0; step < 20; ++step) scene.detect();
  REQUIRE(scene.report.pairs == 3);
  const long before = allocations;
  for (const double way : {0.02, -0.02}) {
    scene.colliders[3].pose.position[2] += way;
    scene.detect();
    CHECK(scene.report.pairs == (way > 0 ? 2 : 3));
  }
  CHECK(allocations == before);
}

TEST_CASE("a warm detect() of meshes on a mesh allocates nothing") {
  MeshScene scene;
  scene.add(scene.collision.add(flat_grid(4, 31, 0.3)), {0, 0, 0}, Mat3::Identity(), false);
  const Shape box = scene.collision.add(fine_box(0.8, 0.8, 0.8, 3));
  for (int i = 0; i < 4; ++i) scene.add(box, {0.9 * i - 1.4, 0.2 * i, 0.399});
  const auto step = [&](int k) {
    for (std::size_t i = 1; i < scene.colliders.size(); ++i)
      scene.colliders[i].pose.position[0] += k % 2 ? 1e-3 : -1e-3;
    scene.detect();
  };
  for (int k = 0; k < 20; ++k) step(k);
  REQUIRE(scene.contacts.size() == 16);
  const long before = allocations;
  for (int k = 0; k < 20; ++k) step(k);
  CHECK(allocations == before);
}

TEST_CASE("a warm detect() on a mesh allocates nothing") {
  MeshScene scene;
  scene.add(scene.collision.add(flat_grid(4, 31, 0.3)), {0, 0, 0}, Mat3::Identity(), false);
  const std::vector<Shape> shapes{Sphere{0.4}, Box{1, 0.6, 0.8}, Capsule{0.25, 0.8}, Cylinder{0.35, 0.8}};
  for (std::size_t i = 0; i < 16; ++i)
    scene.add(shapes[i % 4], Vec3(0.3 * double(i) - 2, double(i % 4) - 2, 0.399));
  const auto step = [&](int k) {
    for (std::size_t i = 1; i < scene.colliders.size(); ++i) scene.colliders[i].pose.position[0] += k % 2 ? 1e-3 : -1e-3;
    scene.detect();
  };
  for (int k = 0; k < 20; ++k) step(k);
  REQUIRE(scene.contacts.size() > 30);
  const long before = allocations;
  for (int k = 0; k < 20; ++k) step(k);
  CHECK(allocations == before);
}
