#include "catch.hpp"

#include <delassus/collision/with_meshes.hpp>
#include <delassus/delassus.hpp>

#include <array>
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

namespace fast_bodies_tests {

using namespace delassus;

namespace {

auto scene() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.3}}, BallJoint{}},
                       NativeCollision{}, GaussSeidel{.tolerance = 1e-9, .max_iterations = 2000}};
}

}  // namespace

TEST_CASE("at 1000 m/s a ball of 1 cm and a box of 2 cm never pass a plate of 1 mm", "[table]") {
  // 10 seeded shots, 500 where DELASSUS_SHOTS is set: from either side, oblique, the box turned and turning.
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int shot = 0; shot < (std::getenv("DELASSUS_SHOTS") ? 500 : 10); ++shot) {
    auto loop = scene();
    auto& rigid = bodies<RigidBodies>(loop.world());
    rigid.add_fixed(Box{4, 4, 1e-3});
    const double side = shot % 2 ? 1 : -1;
    const Vec3 at{0.3 * uniform(random), 0.3 * uniform(random), side * (1.2 + uniform(random))};
    const Vec3 v{300 * uniform(random), 300 * uniform(random), -1000 * side};
    const Quat turn = Quat{uniform(random), uniform(random), uniform(random), uniform(random)}.normalized();
    const Vec3 spin{500 * uniform(random), 500 * uniform(random), 500 * uniform(random)};
    const bool is_ball = shot % 4 < 2;
    const auto body = rigid.add({.position = at,
                                 .orientation = turn,
                                 .velocity = v,
                                 .angular_velocity = spin,
                                 .mass = 0.01,
                                 .shape = is_ball ? Shape(Sphere{0.01}) : Shape(Box{0.02, 0.02, 0.02})});
    INFO("shot " << shot);
    double least = 10;
    for (int i = 0; i < 8; ++i) {
      loop.step(1e-3);
      least = std::min(least, side * rigid.position(body).z());
    }
    // A ball's middle stays its radius and half the plate above it, 1.05 cm, within its tolerance of 1e-3 of
    // the radius; that of a box the radius of the core, 0.55 cm.
    CHECK(least > (is_ball ? 0.0104 : 0.00549));
    CHECK(least < 0.05);  // and it did arrive
  }
}

TEST_CASE("the far end of what topples on a box stays above it", "[table]") {
  // A pole leans with one end on the ground, at 23° or 57° to it, and falls over; friction keeps that end where it is. The lowest
  // point of the pole, by its shape, is never below the ground by more than the 1e-4 of the size, to which bodies touch. The end goes about
  // 0.1 m in its last step, 20 times the least margin, and the pole turns by less than 0.08 rad.
  for (const double lean : {0.4, 1.0})
    for (const bool is_box : {false, true})
      for (const double length : {0.6, 2.0}) {
        AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.8}}}};
        auto& rigid = bodies<RigidBodies>(loop.world());
        rigid.add_fixed(Box{40, 40, 1}, Vec3(0, 0, -0.5));
        const Quat turn(Eigen::AngleAxisd(1.57 - lean, unit_axis(0)));
        const Shape shape = is_box ? Shape(Box{0.2, 0.2, length}) : Shape(Capsule{0.1, length});
        const auto lowest = [&](const Vec3& x, const Quat& q) {
          return x.z() + (q.toRotationMatrix() * support(shape, transposed_times(q.toRotationMatrix(), Vec3(0, 0, -1)))).z();
        };
        const auto pole = rigid.add({.position = Vec3(0, 0, 1e-6 - lowest(zero<Vec3>(), turn)), .orientation = turn, .mass = 1.0, .shape = shape});
        double least = 0;
        for (int i = 0; i < 120; ++i) {
          loop.step(1.0 / 60);
          least = std::min(least, lowest(rigid.position(pole), rigid.orientation(pole)));
        }
        INFO("length " << length << ", box " << is_box << ", lean " << lean);
        CHECK(least > -1e-4 * length);
        CHECK(std::abs(rigid.position(pole).z() - 0.1) < 1e-4 * length);  // and it lies flat
      }
}

TEST_CASE("at 1000 m/s needles that turn by half a radian a step never pass a plate of 1 mm", "[table]") {
  // 600 seeded shots of rods of 2 mm and 5 cm, 6 000 where DELASSUS_SHOTS is set. An end may dip through
  // while the rod is turned; the ball of half its thickness about its middle may not. That one rests 1e-3 of
  // its radius early, and what it is held by does not know the velocity that gravity adds within the step: g
  // h².
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto any = [&] {
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    return Vec3(x, y, z);
  };
  const Shape needles[] = {Capsule{0.001, 0.048}, Box{0.002, 0.002, 0.05}, Cylinder{0.001, 0.05}};
  constexpr double h = 1e-3, core = 5e-4, half_plate = 5e-4;
  for (int shot = 0; shot < (std::getenv("DELASSUS_SHOTS") ? 6000 : 600); ++shot) {
    auto loop = scene();
    auto& rigid = bodies<RigidBodies>(loop.world());
    rigid.add_fixed(Box{400, 400, 2 * half_plate});
    const double side = shot % 2 ? 1 : -1;
    const Vec3 at = any(), aside = any(), spin = any(), turn = any();
    const auto body = rigid.add({.position = {0.3 * at[0], 0.3 * at[1], side * (1.2 + at[2])},
                                 .orientation = Quat(0.2, turn[0], turn[1], turn[2]).normalized(),
                                 .velocity = {300 * aside[0], 300 * aside[1], -1000 * side},
                                 .angular_velocity = 500 * spin,
                                 .mass = 0.01,
                                 .shape = needles[shot % 3]});
    INFO("shot " << shot);
    double least = 10;
    for (int i = 0; i < 40; ++i) {
      loop.step(h);
      least = std::min(least, side * rigid.position(body).z());
    }
    CHECK(least > half_plate + core - 1e-3 * core - 9.81 * h * h);
    CHECK(least < 0.05);  // and it did arrive
  }
}

TEST_CASE("cones and tetrahedra that strike a plate of 1 mm or a mesh on a corner do not pass it") {
  // Within the step of the impact they turn by a radian, and lie through the plate at its end. The shorter way out is often through it.
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const std::vector<Vec3> corners{{0.03, 0.03, 0.03}, {-0.03, -0.03, 0.03}, {0.03, -0.03, -0.03}, {-0.03, 0.03, -0.03}};
  const std::vector<Vec3> points{{-100, -100, 0}, {100, -100, 0}, {100, 100, 0}, {-100, 100, 0}};
  const std::vector<std::array<Index, 3>> triangles{{0, 1, 2}, {0, 2, 3}};
  const ConvexHull tetrahedron(corners);
  const TriangleMesh sheet(points, triangles);
  constexpr double h = 1.0 / 60;
  for (int shot = 0; shot < 240; ++shot) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.3}}}, WithMeshes{NativeCollision{}}};
    auto& rigid = bodies<RigidBodies>(loop.world());
    const bool is_mesh = shot % 4 == 3;
    if (is_mesh) rigid.add_fixed(loop.get<WithMeshes<NativeCollision>>().add(sheet));
    else rigid.add_fixed(Box{200, 200, 1e-3});
    const double speed = std::vector<double>{10, 30, 100}[std::size_t(shot % 3)];
    const Quat turn = Quat{uniform(random), uniform(random), uniform(random), uniform(random)}.normalized();
    const auto body = rigid.add({.position = {0, 0, 0.1 + speed * h * (1 + uniform(random))},
                                 .orientation = turn,
                                 .velocity = {0, 0, -speed},
                                 .mass = 0.3,
                                 .shape = shot % 2 ? Shape(Cone{0.03, 0.05}) : Shape(tetrahedron)});
    INFO("shot " << shot);
    bool has_arrived = false;
    for (int i = 0; i < 40; ++i) {
      const StepReport report = loop.step(h);
      CHECK(report.status < Status::infeasible);
      has_arrived = has_arrived || rigid.position(body).z() < 0.05;
      CHECK(rigid.position(body).z() > 0);
    }
    CHECK(has_arrived);
  }
}

TEST_CASE("a rod that turns by a radian a step does not pass a pin") {
  auto loop = scene();
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.gravity.setZero();
  rigid.add_fixed(Capsule{0.002, 0.4}, {0.8 * std::cos(2.0), 0.8 * std::sin(2.0), 0});
  const Quat along_x(Eigen::AngleAxisd(1.5707963267948966, Vec3(0, 1, 0)));
  const auto rod = rigid.add(
      {.orientation = along_x, .angular_velocity = {0, 0, 200}, .mass = 1., .shape = Capsule{0.005, 2}});
  loop.add(BallJoint::Item{anchor(rigid, rod), world_anchor({0, 0, 0})});
  double farthest = 0;
  for (int i = 0; i < 10; ++i) {
    loop.step(5e-3);
    const Vec3 axis = rigid.orientation(rod) * Vec3(0, 0, 1);
    farthest = std::max(farthest, std::atan2(axis[1], axis[0]));
    CHECK(std::atan2(axis[1], axis[0]) > -0.1);  // it would be negative beyond π
  }
  CHECK(farthest > 2 - std::asin(0.007 / 0.8) - 2e-3);
  CHECK(farthest < 2 - std::asin(0.007 / 0.8) + 1e-4);
}

TEST_CASE("a half-space that tilts about a place far off lets nothing through") {
  // At r from the pivot its surface goes ω r h in a step, up to 50 sizes of a body. A contact sees that to the first order: what is
  // left of a step is r ((ω h)²/2 + (ω h)³), and the weight's g h². So much is missing where a body arrives; while it rides, as much
  // comes in each step as Baumgarte's fifth of the depth takes away.
  constexpr double h = 1.0 / 60, half = 0.01;
  for (const Shape& shape : {Shape(Sphere{half}), Shape(Box{2 * half, 2 * half, 2 * half}), Shape(Capsule{half, 0.05})})
    for (const double rate : {0.5, 3.0, 12.0}) {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.3}}}};
      auto& rigid = bodies<RigidBodies>(loop.world());
      const auto ground = rigid.add({.shape = HalfSpace{}, .motion = Motion::kinematic});
      rigid.set_velocity(ground, Vec3::Zero(), {0, rate, 0});
      const auto body = rigid.add({.position = {-5, 0, 0.3}, .mass = 0.01, .shape = shape});
      INFO("kind " << int(shape.kind) << ", " << rate << " rad/s");
      int steps_there = 0;
      for (double turned = 0; turned < 1; turned += rate * h) {
        loop.step(h);
        const Vec3 normal = rigid.orientation(ground) * Vec3(0, 0, 1), at = rigid.position(body);
        const double turn = rate * h, missed = at.norm() * turn * turn * (0.5 + turn) + 9.81 * h * h;
        steps_there += loop.report().contacts > 0;
        REQUIRE(normal.dot(at) > half - (steps_there > 1 ? 5 : 1) * missed);
      }
      CHECK(steps_there > 1);
    }
}

}  // namespace fast_bodies_tests
