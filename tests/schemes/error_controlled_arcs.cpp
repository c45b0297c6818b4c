// Steps that keep an error: the order of arcs in contact is measured, a trial copies no mesh, and who leads
// is asked by every scheme.
#include <delassus/collision/with_meshes.hpp>
#include <delassus/geometry/triangle_mesh.hpp>
#include <delassus/io/checkpoint.hpp>
#include <delassus/schemes/error_controlled.hpp>
#include <delassus/schemes/substeps.hpp>

#include "scenes.hpp"

#include <array>
#include <vector>

#include "catch.hpp"

namespace error_controlled_arcs_tests {

using namespace scenes;

namespace {

/// A rattleback that is spun the way that it does not like; what it stands on is ground.
auto rattleback(auto scheme) {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Contact{Coulomb{.friction = 5}}},
                     AcceleratedGaussSeidel{.tolerance = 1e-9, .max_iterations = 20000},
                     PositionProjection{},
                     ImplicitMidpoint{.looks = 2},
                     scheme};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  const Mat3 R = exponential<double>(Vec3(0, 0, 0.1)).toRotationMatrix();
  const Vec3 start(0.02, 0, -1.5);
  set.add({.position = {0, 0, 0.02},
           .velocity = start.cross(Vec3(0, 0, 0.02)),
           .angular_velocity = start,
           .mass = 1,
           .inertia = Mat3(R * Vec3(2e-4, 1.6e-3, 1.7e-3).asDiagonal() * R.transpose()),
           .shape = Ellipsoid{0.2, 0.03, 0.02}});
  return loop;
}

/// Leads a floor up.
struct Lift {
  using plays = role::Listener;
  using listens = Listens<>;
  RigidBodies::Handle floor{};
  void lead(auto& world, double t, double h) const {
    bodies<RigidBodies>(world).move_to(floor, {0, 0, 0.2 * (t + h) * (t + h)});
  }
};

}  // namespace

// It rolls on one point: two looks make the rule second order there. A step of h must leave 2³ of what one of
// h/2 leaves, so that from 1e-3 to 1e-5 steps grow in number by 100^(1/3) = 4.6; by first order with what
// contacts hold they grew by 100^(1/1) at most. Half of the decades' exponents lies at 100^(1/2) = 10.
TEST_CASE("what rolls is of second order under error control") {
  long steps[2] = {}, measurements = 0, rejections = 0;
  for (const int k : {0, 1}) {
    auto loop = rattleback(ErrorControlled{.accuracy = k == 0 ? 1e-3 : 1e-5});
    for (int i = 0; i < 20; ++i) {
      loop.step(0.1);
      steps[k] += error_report(loop).steps, measurements += error_report(loop).measurements,
          rejections += error_report(loop).rejections;
    }
  }
  CAPTURE(steps[0], steps[1], measurements, rejections);
  CHECK(steps[1] < 10 * steps[0]);
  CHECK(measurements > 0);
  CHECK(10 * measurements <=
        steps[0] + steps[1] + rejections);  // one in 16 steps, and more where an arc begins
}

// A wobble that grows takes the leading term of the error through zero, where the measured order is neither one
// nor two. Taken for the first, what the contact holds would count, which no smaller step lessens, and the steps
// would end at the floor.
TEST_CASE("what rolls keeps an error per second without a step at the floor") {
  auto loop = rattleback(ErrorControlled{.accuracy = 1e-4, .per_second = true});
  long at_floor = 0, rejections = 0, steps = 0;
  for (int i = 0; i < 30; ++i) {
    loop.step(0.1);
    const ErrorReport& report = error_report(loop);
    at_floor += report.at_floor, rejections += report.rejections, steps += report.steps;
  }
  CAPTURE(steps, rejections);
  CHECK(at_floor == 0);
  CHECK(100 * rejections <= steps);
}

TEST_CASE("an arc whose order was measured repeats to the bit from a checkpoint") {
  auto loop = rattleback(ErrorControlled{}), restored = rattleback(ErrorControlled{});
  for (int i = 0; i < 7; ++i) loop.step(0.03);
  restore(restored, checkpoint(loop));
  for (int i = 0; i < 10; ++i) {
    loop.step(0.03), restored.step(0.03);
    REQUIRE(state_hash(loop) == state_hash(restored));
    REQUIRE(error_report(loop).steps == error_report(restored).steps);
  }
}

TEST_CASE("who leads a body is asked by every scheme") {
  const auto height = [](auto scheme) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                       ImplicitMidpoint{}, Lift{}, scheme};
    auto& set = rigid_bodies(loop);
    const auto floor = loop.data().template get<Lift>().floor =
        set.add({.shape = HalfSpace{}, .motion = Motion::kinematic});
    set.add({.position = {0, 0, 0.1}, .mass = 1, .shape = Sphere{0.1}});
    for (int i = 0; i < 10; ++i) loop.step(0.1);
    return set.position(floor).z();
  };
  CHECK(height(PlainOrder{}) == Approx(0.2).epsilon(1e-9));
  CHECK(height(Substeps{.count = 4}) == Approx(0.2).epsilon(1e-9));
  CHECK(height(ErrorControlled{}) == Approx(0.2).epsilon(1e-9));
}

// What is set aside of a trial is what a step changes: a floor of 2 triangles takes as many bytes as one of
// 2048.
TEST_CASE("a trial copies no mesh") {
  const auto bytes = [](int n) {
    std::vector<Vec3> vertices;
    std::vector<std::array<Index, 3>> triangles;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n; ++j) vertices.push_back({10. * i / n - 5, 10. * j / n - 5, 0});
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const Index a = i * (n + 1) + j, b = a + n + 1;
        triangles.push_back({a, b, b + 1}), triangles.push_back({a, b + 1, a + 1});
      }
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                       ImplicitMidpoint{}, WithMeshes{NativeCollision{}}, ErrorControlled{}};
    auto& set = rigid_bodies(loop);
    set.add_fixed(loop.data().collision().add(TriangleMesh(vertices, triangles)));
    set.add({.position = {0, 0, 1}, .mass = 1, .shape = Sphere{0.1}});
    loop.step(0.1);
    inner::StepCopy copy;
    copy.keep(loop.data());
    const std::vector<char> before = checkpoint(loop);
    auto& step = loop.data();
    step.h = 0.05;
    stage::detect(step);
    stage::move(step);
    REQUIRE(checkpoint(loop) != before);
    copy.bring_back(step);
    REQUIRE(checkpoint(loop) == before);
    return copy.bytes();
  };
  CHECK(bytes(1) == bytes(32));
}

}  // namespace error_controlled_arcs_tests
