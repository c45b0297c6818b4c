#include "catch.hpp"

#include <delassus/collision/with_filter.hpp>
#include <delassus/collision/with_meshes.hpp>
#include <delassus/delassus.hpp>

#include <cmath>
#include <vector>

namespace meshes_tests {

using namespace delassus;

namespace {

auto scene() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}},
                       WithFilter{WithMeshes{NativeCollision{}}},
                       GaussSeidel{.tolerance = 1e-7, .max_iterations = 1000}};
}
using Scene = decltype(scene());

WithMeshes<NativeCollision>& meshes(Scene& loop) {
  return loop.get<WithFilter<WithMeshes<NativeCollision>>>().backend;
}

HeightField flat(Index points, double spacing) {
  return HeightField(points, points, spacing, spacing,
                     std::vector<double>(std::size_t(points * points), 0.0));
}

}  // namespace

TEST_CASE("a box comes to rest on a meshed floor as on a half-space") {
  double height[2] = {};
  for (const bool is_meshed : {false, true}) {
    Scene loop = scene();
    auto& rigid = bodies<RigidBodies>(loop.world());
    const Shape floor = is_meshed ? meshes(loop).add(flat(9, 0.37)) : Shape(HalfSpace{});
    rigid.add_fixed(floor);
    const auto box = rigid.add(
        {.position = {0.1, 0.05, 0.55}, .velocity = {0.3, 0.1, 0}, .density = 1000., .shape = Box{1, 1, 1}});
    for (int i = 0; i < 200; ++i) loop.step(5e-3);
    height[is_meshed] = rigid.position(box).z();
  }
  CHECK(std::abs(height[1] - 0.5) < 1e-5);
  CHECK(std::abs(height[1] - height[0]) <
        1e-6);  // both end within the solver's tolerance of touching, 1e-6 m
}

// At rest its base lies in the floor: half its height up, without a turn. The solver's tolerance is 1e-7 of speeds of about 0.2 m/s; over the
// base of 0.2 m that is a lean of 1e-7 in the ten steps in which overlaps are mended: 1e-5 is far above that, and a rocking one leans 1e-3.
TEST_CASE("a cylinder that lands on its rim comes to rest flat on a meshed floor") {
  for (int k = 0; k < 12; ++k) {
    Scene loop = scene();
    auto& rigid = bodies<RigidBodies>(loop.world());
    rigid.add_fixed(meshes(loop).add(flat(9, 1)));
    const double lean = 0.01 + 0.1 * std::fmod(0.3 * k, 1);
    const Quat turned(Eigen::AngleAxisd(lean, Vec3(std::cos(k), std::sin(k), 0)));
    const Vec3 at(std::fmod(0.37 * k, 1), std::fmod(0.71 * k, 1), 0.2);
    const auto drum = rigid.add({.position = at, .orientation = turned, .mass = 1., .shape = Cylinder{0.2, 0.2}});
    double most = 0, off = 0;
    for (int i = 0; i < 600; ++i) {
      loop.step(1 / 60.0);
      if (i < 480) continue;
      most = std::max(most, std::hypot(rigid.orientation(drum).x(), rigid.orientation(drum).y()));
      off = std::max(off, std::abs(rigid.position(drum).z() - 0.1));
    }
    CAPTURE(k, most, off);
    CHECK(most < 1e-5);
    CHECK(off < 1e-5);
  }
}

TEST_CASE("a ball that rolls over coplanar triangles keeps its height and its speed") {
  Scene loop = scene();
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(meshes(loop).add(flat(41, 0.13)));
  const double r = 0.2, speed = 2;  // rolling: ω r = v
  const auto ball = rigid.add({.position = {-2.2, -0.3, r},
                               .velocity = {speed, 0.2, 0},
                               .angular_velocity = {-1, speed / r, 0},
                               .density = 1000.,
                               .shape = Sphere{r}});
  for (int i = 0; i < 400; ++i) {
    loop.step(5e-3);
    CHECK(std::abs(rigid.position(ball).z() - r) < 1e-6 * r);
    CHECK(std::abs(rigid.velocity(ball).x() - speed) < 1e-5);
  }
  CHECK(rigid.position(ball).x() > 1.79);
}

TEST_CASE("a body of a mesh falls, stands and carries; a filter goes around") {
  Scene loop = scene();
  auto& rigid = bodies<RigidBodies>(loop.world());
  std::vector<Vec3> v;
  for (int i = 0; i < 8; ++i) v.push_back({i & 1 ? .5 : -.5, i & 2 ? .5 : -.5, i & 4 ? .5 : -.5});
  const std::vector<std::array<Index, 3>> t{{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                            {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  const Shape cube = meshes(loop).add(TriangleMesh(v, t));
  rigid.add_fixed(HalfSpace{});
  const Mat3 inertia = Vec3(1, 1, 1).asDiagonal();
  const auto low = rigid.add({.position = {0, 0, 0.6}, .mass = 6., .inertia = inertia, .shape = cube});
  const auto high = rigid.add({.position = {0.1, 0, 1.7}, .mass = 6., .shape = Box{1, 1, 1}});
  const auto ghost = rigid.add({.position = {0, 0, 0.8}, .mass = 1., .shape = Box{.2, .2, .2}});
  loop.add(BallJoint::Item{anchor(rigid, low, {0, 0, .2}), anchor(rigid, ghost)});
  for (int i = 0; i < 300; ++i) loop.step(5e-3);
  CHECK(std::abs(rigid.position(low).z() - 0.5) < 1e-4);
  CHECK(std::abs(rigid.position(high).z() - 1.5) < 1e-4);
  CHECK((rigid.position(ghost) - rigid.position(low) - Vec3(0, 0, .2)).norm() < 1e-3);
}

namespace {

/// One of every shape dropped on a hilly field, told in other units: positions, velocities and spins of all
/// steps, told back.
std::vector<double> tumble(double length, double mass, double time) {
  Scene loop = scene();
  const double speed = length / time;
  loop.policy<role::Stabilisation>().max_speed *= speed;
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.gravity *= speed / time;
  std::vector<double> heights;
  for (int i = 0; i < 81; ++i) heights.push_back(length * 0.1 * std::sin(1.3 * i) * std::cos(0.7 * (i / 9)));
  rigid.add_fixed(meshes(loop).add(HeightField(9, 9, 0.5 * length, 0.5 * length, heights)));
  std::vector<Vec3> corners;
  for (int k = 0; k < 12; ++k)
    corners.push_back(0.3 * length * Vec3(std::sin(2.1 * k), std::cos(1.3 * k + 1), std::sin(3.7 * k + .3)));
  const ConvexHull hull(corners);
  const Shape shapes[] = {Box{.4, .3, .5},  Cylinder{.2, .5}, Cone{.25, .5}, Ellipsoid{.2, .3, .15},
                          Capsule{.15, .4}, Sphere{.2},       hull};
  std::vector<RigidBodies::Handle> all;
  for (int k = 0; k < 14; ++k) {
    Shape shape = shapes[k % 7];
    for (double& size : shape.size) size *= length;
    all.push_back(
        rigid.add({.position = length * Vec3(-.8 + .8 * (k % 3), -.8 + .8 * (k / 3 % 3), .5 + k / 9),
                   .orientation = exponential<double>(Vec3(.3 * k, .2, -.4 * k)),
                   .velocity = speed * Vec3(.2, -.1 * k, -1),
                   .angular_velocity = Vec3(1, .3 * k, -1) / time,
                   .density = 1000 * mass / (length * length * length),
                   .shape = shape}));
  }
  std::vector<double> out;
  for (int n = 0; n < 60; ++n) {
    loop.step(0.01 * time);
    for (const auto body : all)
      for (int k = 0; k < 3; ++k) {
        out.push_back(rigid.position(body)[k] / length);
        out.push_back(rigid.velocity(body)[k] / speed);
        out.push_back(rigid.angular_velocity(body)[k] * time);
      }
  }
  REQUIRE(loop.contacts().size() > 20);
  return out;
}

}  // namespace

// Powers of four round nothing, nor do their roots.
TEST_CASE(
    "lengths, masses and times 1024 times larger or smaller change no bit of shapes that fall on a field") {
  const std::vector<double> usual = tumble(1, 1, 1);
  constexpr double more = 1024, less = 1 / more;
  CHECK((tumble(more, 1, 1) == usual));
  CHECK((tumble(less, 1, 1) == usual));
  CHECK((tumble(1, more, 1) == usual));
  CHECK((tumble(1, 1, less) == usual));
  CHECK((tumble(more, less, more) == usual));
}

TEST_CASE("a body of a mesh without mass and inertia is refused") {
  Scene loop = scene();
  auto& rigid = bodies<RigidBodies>(loop.world());
  const Shape floor = meshes(loop).add(flat(2, 1));
  CHECK_THROWS_WITH(rigid.add({.mass = 1., .shape = floor}), Catch::Matchers::Contains("give an inertia"));
}

TEST_CASE("a loop whose backend keeps no meshes refuses the shape of one that does") {
  WithMeshes<NativeCollision> elsewhere;
  const Shape floor = elsewhere.add(flat(2, 1));
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(floor);
  rigid.add({.position = {0.2, 0.2, 1}, .mass = 1.0, .shape = Sphere{0.1}});
  CHECK_THROWS_WITH(loop.step(0.01), Catch::Matchers::Contains("put the WithMeshes{...} or WithCompounds{...}"));
}

}  // namespace meshes_tests
