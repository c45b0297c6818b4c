#include "catch.hpp"
#include "collision/acceptance.hpp"

#include <delassus/bodies/particles.hpp>
#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/collision/queries.hpp>

#include <cmath>
#include <limits>
#include <vector>

namespace queries_tests {

using namespace delassus;
using namespace samples;
using Catch::Matchers::Contains;

namespace {

using Bodies = World<RigidBodies, Particles>;

RigidBodies::Handle add(Bodies& world, const Shape& shape, const Vec3& position,
                        const Quat& q = Quat::Identity()) {
  return world.get<RigidBodies>().add({.position = position, .orientation = q, .mass = 1.0, .shape = shape});
}

}  // namespace

TEST_CASE("a ray meets a sphere, a box, a cone and the ground where geometry says") {
  Bodies world;
  world.get<RigidBodies>().add_fixed(HalfSpace{});
  const auto ball = add(world, Sphere{1}, {0, 0, 5});
  add(world, Box{2, 2, 2}, {10, 0, 5}, Quat(Eigen::AngleAxisd(std::acos(-1.0) / 4, Vec3::UnitZ())));
  add(world, Cone{0.3, 0.4}, {0, 10, 5});
  // 0.6 beside the middle the ball's surface is 0.8 before it.
  const SurfacePoint on_ball = ray_cast(world, {-5, 0.6, 5}, {3, 0, 0});
  REQUIRE(on_ball);
  CHECK(on_ball.distance == Approx(4.2).epsilon(1e-9));
  CHECK((on_ball.normal - Vec3(-0.8, 0.6, 0)).norm() < 1e-9);
  CHECK(on_ball.anchor.block == ball.index);
  CHECK((world.point(on_ball.anchor) - on_ball.point).norm() < 1e-14);
  // The edge of the turned box looks at the ray.
  CHECK(ray_cast(world, {20, 0.1, 5}, {-1, 0, 0}).distance ==
        Approx(10 - std::sqrt(2.0) + 0.1).epsilon(1e-9));
  // Half way up the mantle, 0.15 from the axis.
  const SurfacePoint on_cone = ray_cast(world, {5, 10, 5.1}, {-1, 0, 0});
  CHECK(on_cone.distance == Approx(4.85).epsilon(1e-9));
  CHECK((on_cone.normal - Vec3(0.8, 0, 0.6)).norm() < 1e-9);
  const SurfacePoint on_ground = ray_cast(world, {3, 3, 4}, {0.6, 0, -0.8});
  CHECK(on_ground.distance == Approx(5).epsilon(1e-9));
  CHECK((on_ground.point - Vec3(6, 3, 0)).norm() < 1e-9);
  CHECK_FALSE(ray_cast(world, {-5, 0.6, 5}, {3, 0, 0}, 4.1));
  CHECK_FALSE(ray_cast(world, {-5, 1.01, 5}, {1, 0, 0}, 10));
  CHECK_FALSE(ray_cast(world, {0, 0, 8}, {0, 0, 1}));
}

TEST_CASE(
    "a ray that begins inside a body is there at once, and the nearest of several bodies is met first") {
  Bodies world;
  for (int i = 0; i < 5; ++i) add(world, Sphere{1}, {3.0 * i, 0, 0});
  CHECK(ray_cast(world, {0, 0.1, 0}, {1, 0, 0}).distance == 0);
  CHECK(ray_cast(world, {-9, 0, 0}, {1, 0, 0}).anchor.block == 0);
  CHECK(ray_cast(world, {99, 0, 0}, {-1, 0, 0}).anchor.block == 4);
  world.get<Particles>().add({.position = {-5, 0, 0}, .mass = 1, .radius = 0.5});
  const SurfacePoint grain = ray_cast(world, {-9, 0, 0}, {1, 0, 0});
  CHECK(grain.anchor.set == 1);
  CHECK(grain.distance == Approx(3.5).epsilon(1e-9));
}

// Aimed at a known surface point from outside: no point of the body lies before the plane there, so a ray
// against the normal meets the surface at the point itself. The ray ends within 1e-10 of the size in front of
// it.
TEST_CASE("rays aimed at a surface point of any shape end there") {
  const Zoo zoo;
  std::mt19937 random(4);
  for (const Shape& s : zoo.all)
    for (int k = 0; k < 200; ++k) {
      const Vec3 n = any_direction(random), target = support(s, n);
      double way = 0;
      Vec3 normal;
      CAPTURE(name(s.kind), k);
      REQUIRE(inner::enter(s, target + 3 * n, -n, 10, way, normal));
      CHECK(std::abs(way - 3) < 1e-8);
      CHECK_FALSE(inner::enter(s, target + 3 * n, -n, 2.9, way, normal));
      Vec3 along = n.cross(any_direction(random)).normalized();
      CHECK_FALSE(inner::enter(s, target + 1e-6 * n - 5 * along, along, 10, way, normal));
    }
}

TEST_CASE("the closest point is on the nearest surface, and inside the distance is negative") {
  Bodies world;
  world.get<RigidBodies>().add_fixed(HalfSpace{});
  add(world, Box{2, 2, 2}, {0, 0, 5});
  add(world, Ellipsoid{1, 2, 3}, {10, 0, 5});
  const SurfacePoint corner = closest_point(world, {2, 3, 8});
  CHECK(corner.distance == Approx(3).epsilon(1e-12));  // (1, 2, 2) from the corner
  CHECK((corner.point - Vec3(1, 1, 6)).norm() < 1e-12);
  CHECK((corner.normal - Vec3(1, 2, 2) / 3).norm() < 1e-12);
  const SurfacePoint inside = closest_point(world, {0.2, 0.7, 5.1});
  CHECK(inside.distance == Approx(-0.3).epsilon(1e-12));
  CHECK((inside.normal - Vec3::UnitY()).norm() < 1e-12);
  CHECK(closest_point(world, {12, 0, 5}).distance == Approx(1).epsilon(1e-12));
  CHECK(closest_point(world, {5, 0, 0.5}).distance == Approx(0.5).epsilon(1e-12));
  CHECK_FALSE(closest_point(world, {5, 0, 1.5}, 1.4));
}

TEST_CASE("overlaps lists who is touched, in order, and how deep") {
  Bodies world;
  world.get<RigidBodies>().add_fixed(HalfSpace{});
  for (int i = 0; i < 5; ++i) add(world, Box{1, 1, 1}, {2.0 * i, 0, 0.6});
  std::vector<SurfacePoint> found;
  overlaps(world, Sphere{0.7}, {.position = {3, 0, 0.65}}, found);
  REQUIRE(found.size() == 3);
  CHECK(found[0].distance == Approx(-0.05).epsilon(1e-9));
  CHECK(found[1].distance == Approx(-0.2).epsilon(1e-9));
  CHECK((found[1].normal - Vec3::UnitX()).norm() < 1e-9);
  CHECK(found[2].anchor.block == found[1].anchor.block + 1);
  overlaps(world, Box{0.1, 0.1, 0.1}, {.position = {3, 0, 0.65}}, found);
  CHECK(found.empty());
  overlaps(world, Box{0.1, 0.1, 0.1}, {.position = {3, 0, 0.65}}, found, 0.46);
  CHECK(found.size() == 2);
}

TEST_CASE("the separation of two bodies is that of their shapes, whichever is asked first") {
  Bodies world;
  auto& rigid = world.get<RigidBodies>();
  const auto ground = rigid.add_fixed(HalfSpace{});
  const auto box = add(world, Box{1, 1, 1}, {0, 0, 2}), ball = add(world, Sphere{0.5}, {3, 0, 2});
  const Separation s = separation(rigid, box, rigid, ball), back = separation(rigid, ball, rigid, box);
  CHECK(s.distance == Approx(2).epsilon(1e-12));
  CHECK((s.normal - Vec3::UnitX()).norm() < 1e-12);
  CHECK((s.point_b - s.point_a - s.distance * s.normal).norm() < 1e-12);
  CHECK(back.distance == Approx(2).epsilon(1e-12));
  CHECK((back.normal + s.normal).norm() < 1e-12);
  CHECK(separation(rigid, ground, rigid, box).distance == Approx(1.5).epsilon(1e-12));
  CHECK(separation(rigid, box, rigid, ground).normal == -Vec3::UnitZ());
  CHECK_THROWS_WITH(separation(rigid, ground, rigid, ground), Contains("two half-spaces have no distance"));
  CHECK_THROWS_WITH(separation(rigid, box, rigid, RigidBodies::Handle{}), Contains("its handle is stale"));
}

TEST_CASE("groups choose who is asked, and questions that make no sense are refused") {
  Bodies world;
  world.get<RigidBodies>().add({.position = {2, 0, 0}, .mass = 1.0, .shape = Sphere{1}, .group = 4});
  CHECK(ray_cast(world, Vec3::Zero(), Vec3::UnitX(), 10, 4));
  CHECK_FALSE(ray_cast(world, Vec3::Zero(), Vec3::UnitX(), 10, 3));
  CHECK_FALSE(closest_point(world, Vec3::Zero(), 10, 3));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(ray_cast(world, Vec3::Zero(), Vec3::Zero()), Contains("the direction not zero"));
  CHECK_THROWS_WITH(ray_cast(world, Vec3(nan, 0, 0), Vec3::UnitX()), Contains("must be finite"));
  CHECK_THROWS_WITH(closest_point(world, Vec3(0, nan, 0)), Contains("not finite"));
  std::vector<SurfacePoint> found;
  CHECK_THROWS_WITH(overlaps(world, HalfSpace{}, Pose{}, found), Contains("a half-space has no volume"));
}

}  // namespace queries_tests
