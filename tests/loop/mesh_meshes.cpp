#include "catch.hpp"
#include "collision/mesh_scene.hpp"

#include <delassus/delassus.hpp>

#include <cmath>
#include <vector>

namespace mesh_meshes_tests {

using namespace delassus;

namespace {

auto scene() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                       WithMeshes{NativeCollision{}}, GaussSeidel{.tolerance = 1e-9, .max_iterations = 5000}};
}
using Scene = decltype(scene());

RigidBodies::Handle add_cube(Scene& loop, const Shape& shape, const Vec3& at) {
  const Mat3 inertia = Vec3(1, 1, 1).asDiagonal();  // of 6 kg and 1 m
  return bodies<RigidBodies>(loop.world())
      .add({.position = at, .mass = 6., .inertia = inertia, .shape = shape});
}

}  // namespace

TEST_CASE(
    "meshed cubes rest on each other and on a meshed floor: no turn, no sinking, their weight carried") {
  Scene loop = scene();
  auto& rigid = bodies<RigidBodies>(loop.world());
  auto& meshes = loop.get<WithMeshes<NativeCollision>>();
  rigid.add_fixed(meshes.add(scenes::flat_grid(3, 8, 0.3)));
  const Shape cube = meshes.add(scenes::fine_box(1, 1, 1, 3));
  const auto low = add_cube(loop, cube, {0.05, 0.02, 0.5}), high = add_cube(loop, cube, {0.2, 0.1, 1.5});
  const double h = 5e-3, weight = 6 * 9.81;
  for (int i = 0; i < 400; ++i) loop.step(h);
  // Penetrations of the solver's tolerance, 1e-9 of h g = 0.05 m/s over 400 steps of 5e-3 s, are below 1e-9
  // m; what the first steps sink before contacts carry is pushed out to Baumgarte's share. 1e-7 bounds both.
  for (const auto& [body, z] : {std::pair{low, 0.5}, std::pair{high, 1.5}}) {
    CHECK(std::abs(rigid.position(body).z() - z) < 1e-7);
    CHECK(rigid.orientation(body).vec().norm() < 1e-7);
    CHECK(rigid.velocity(body).norm() < 1e-7);
  }
  double floor = 0, between = 0;
  for (const ContactResult& c : loop.contacts())
    (c.record.pair == pair_key(collider_key(0, low.index), collider_key(0, high.index)) ? between : floor) +=
        c.impulse.z() / h;
  CHECK(std::abs(floor - 2 * weight) < 1e-6 * weight);
  CHECK(std::abs(between - weight) < 1e-6 * weight);
}

TEST_CASE("a meshed cube that lands on its edge across a meshed ridge stays above it") {
  Scene loop = scene();
  auto& rigid = bodies<RigidBodies>(loop.world());
  auto& meshes = loop.get<WithMeshes<NativeCollision>>();
  const std::vector<Vec3> v{{-2, 0, 0}, {2, 0, 0}, {-2, 2, -2}, {2, 2, -2}, {-2, -2, -2}, {2, -2, -2}};
  rigid.add_fixed(
      meshes.add(TriangleMesh(v, std::vector<scenes::Corners>{{0, 1, 3}, {0, 3, 2}, {1, 0, 4}, {1, 4, 5}})));
  const Shape cube = meshes.add(scenes::box_mesh(1, 1, 1));
  const auto body = add_cube(loop, cube, {0, 0, 0.75});
  rigid.place(body, {0, 0, 0.75}, Quat(Eigen::AngleAxisd(0.25 * 3.14159265358979, Vec3(0, 1, 0))));
  double lowest = 1;
  for (int i = 0; i < 60; ++i) {
    loop.step(5e-3);
    for (const ContactResult& c : loop.contacts()) lowest = std::min(lowest, c.record.gap);
  }
  // The edge along y, √2/2 below the middle, comes down on the ridge along x with 0.9 m/s; a contact exists
  // from a gap of one step's way on, so it is met and not passed.
  CHECK(lowest > -1e-4);
  CHECK(rigid.position(body).z() > 0.5 * std::sqrt(2.0) - 1e-3);
}

TEST_CASE("a ball that rolls over a hundred coplanar triangles has no vertical velocity") {
  Scene loop = scene();
  auto& rigid = bodies<RigidBodies>(loop.world());
  auto& meshes = loop.get<WithMeshes<NativeCollision>>();
  rigid.add_fixed(meshes.add(scenes::flat_grid(1, 7, 0.3, 3)));  // 98 triangles
  const double r = 0.1, speed = 1;
  const auto ball = rigid.add({.position = {-0.9, -0.2, r},
                               .velocity = {speed, 0.2, 0},
                               .angular_velocity = {-0.2 / r, speed / r, 0},
                               .density = 1000.,
                               .shape = Sphere{r}});
  double noise = 0;
  for (int i = 0; i < 300; ++i) {
    loop.step(5e-3);
    noise = std::max(noise, std::abs(rigid.velocity(ball).z()));
  }
  CHECK(rigid.position(ball).x() > 0.55);
  CHECK(noise < 1e-9);  // the solver's tolerance, 1e-9 of h g; an edge that acts tilts the normal by degrees
}

}  // namespace mesh_meshes_tests
