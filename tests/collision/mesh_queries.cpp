#include "catch.hpp"
#include "collision/mesh_scene.hpp"

#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/collision/mesh_queries.hpp>

#include <array>
#include <random>
#include <vector>

namespace mesh_queries_tests {

using namespace delassus;
using namespace scenes;

namespace {

/// The same three boxes, as boxes in one world and as meshes in the other.
struct Worlds {
  World<RigidBodies> solid{RigidBodies{}}, meshed{RigidBodies{}};
  WithMeshes<NativeCollision> meshes;

  Worlds() {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const Shape mesh = meshes.add(box_mesh(1, 0.6, 0.8));
    for (int i = 0; i < 3; ++i) {
      const Vec3 at{1.5 * i, uniform(random), uniform(random)};
      const Quat turn = Quat{uniform(random), uniform(random), uniform(random), uniform(random)}.normalized();
      bodies<RigidBodies>(solid).add_fixed(Box{1, 0.6, 0.8}, at, turn);
      bodies<RigidBodies>(meshed).add_fixed(mesh, at, turn);
    }
  }
};

}  // namespace

TEST_CASE("rays and nearest points of meshed boxes are those of the boxes, from outside") {
  const Worlds w;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int hits = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 from{1.5 + 4 * uniform(random), 4 * uniform(random), 4 * uniform(random)};
    const Vec3 to{1.5 + 2 * uniform(random), uniform(random), uniform(random)};
    const SurfacePoint outside = closest_point(w.solid, from);
    if (outside.distance < 0.01) continue;
    const SurfacePoint near = closest_point(w.meshed, w.meshes, from);
    REQUIRE(near);
    CHECK(std::abs(near.distance - outside.distance) < 1e-12);
    CHECK((near.point - outside.point).norm() < 1e-12);
    CHECK((near.normal - outside.normal).norm() < 1e-11);
    const SurfacePoint a = ray_cast(w.solid, from, to - from),
                       b = ray_cast(w.meshed, w.meshes, from, to - from);
    REQUIRE(bool(a) == bool(b));
    if (!a) continue;
    ++hits;
    CHECK(std::abs(a.distance - b.distance) <
          1e-8);  // the solid's ray stops within 1e-10 of its size, at a slant
    CHECK(a.anchor.block == b.anchor.block);
  }
  CHECK(hits > 50);
}

// The edge of the ball is farther from its middle than any face of a box that has the middle inside, so that it crosses each.
TEST_CASE("a ball overlaps the meshed boxes that it overlaps as boxes, by as much, its middle inside too") {
  const Worlds w;
  std::vector<SurfacePoint> solid, meshed;
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::size_t all = 0, inside = 0;
  for (int i = 0; i < 200; ++i) {
    const Vec3 at{1.5 + 2.5 * uniform(random), 1.5 * uniform(random), 1.5 * uniform(random)};
    inside += closest_point(w.solid, at).distance < 0;
    overlaps(w.solid, Sphere{0.5}, {.position = at}, solid);
    overlaps(w.meshed, w.meshes, Sphere{0.5}, {.position = at}, meshed);
    REQUIRE(solid.size() == meshed.size());
    all += solid.size();
    for (std::size_t k = 0; k < solid.size(); ++k)
      CHECK(std::abs(solid[k].distance - meshed[k].distance) < 1e-12);
  }
  CHECK(all > 30);
  CHECK(inside > 5);
}

TEST_CASE("a shape of any kind overlaps a surface that it comes upon from behind") {
  // Its middle lies 0.1 m below the floor of two triangles, and its foot 0.3 m: the way out is that of the foot.
  World<RigidBodies> world{RigidBodies{}};
  WithMeshes<NativeCollision> meshes;
  const TriangleMesh floor(std::vector<Vec3>{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}},
                           std::vector<std::array<Index, 3>>{{0, 1, 2}, {0, 2, 3}});
  bodies<RigidBodies>(world).add_fixed(meshes.add(floor), {0, 0, 0});
  std::vector<SurfacePoint> found;
  for (const Shape& shape : {Shape(Sphere{0.2}), Shape(Box{0.3, 0.2, 0.4}), Shape(Capsule{0.1, 0.2}), Shape(Cylinder{0.1, 0.4})}) {
    overlaps(world, meshes, shape, {.position = {0.3, 0.2, -0.1}}, found);
    REQUIRE(found.size() == 1);
    CHECK(std::abs(found[0].distance + 0.3) < 1e-9);
    CHECK((found[0].normal - Vec3(0, 0, 1)).norm() < 1e-9);
    overlaps(world, meshes, shape, {.position = {0.3, 0.2, -0.3}}, found);
    CHECK(found.empty());
  }
}

TEST_CASE("who asks without the backend is told so; groups leave meshes out") {
  const Worlds w;
  CHECK_THROWS_WITH(closest_point(w.meshed, {0, 0, 0}),
                    Catch::Matchers::Contains("a mesh is known to its backend alone"));
  CHECK_FALSE(ray_cast(w.meshed, {0, 0, 5}, {0, 0, -1}, 10., 2u));
}

TEST_CASE("a compound is refused by every question, with the backend named or not; groups leave it out") {
  World<RigidBodies> world;
  bodies<RigidBodies>(world).add({.shape = KeptShape{ShapeKind::compound, 0, {1, 1, 1}}, .motion = Motion::fixed});
  WithMeshes<> meshes;
  std::vector<SurfacePoint> found;
  const auto refused = Catch::Matchers::Contains("a compound is known to its backend alone, and no question sees its parts");
  CHECK_THROWS_WITH(ray_cast(world, {0, 0, 5}, {0, 0, -1}), refused);
  CHECK_THROWS_WITH(ray_cast(world, meshes, {0, 0, 5}, {0, 0, -1}), refused);
  CHECK_THROWS_WITH(closest_point(world, meshes, {0, 0, 5}), refused);
  CHECK_THROWS_WITH(overlaps(world, meshes, Sphere{1}, {}, found), refused);
  CHECK_FALSE(ray_cast(world, meshes, {0, 0, 5}, {0, 0, -1}, 10., 2u));
}

}  // namespace mesh_queries_tests
