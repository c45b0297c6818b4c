/// Contacts between the nodes of a soft body, which every collision backend must have alike.
#pragma once

#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/collision/native.hpp>
#include <delassus/collision/with_surfaces.hpp>
#include <delassus/step/detect.hpp>

#include "catch.hpp"
#include "soft_scenes.hpp"

#include <random>
#include <vector>

namespace scenes {

using namespace delassus;

/// Bodies of every kind in random poses over and in a soft block, whose cells are larger than they are: as
/// many contacts as natively, of the same names. The backend's own answers are certified to 1e-3 of the
/// distance, here 0.02 m at most, and normals are those of least depth to a fraction of a degree.
template <class Backend>
void check_soft_contacts() {
  using Soft = TetrahedralFem<Corotational>;
  const double h = 0.01;
  World world{RigidBodies{}, Soft{}};
  auto& rigid = bodies<RigidBodies>(world);
  auto& soft = bodies<Soft>(world);
  soft.add({.mesh = delassus::box_mesh({1, 1, 0.4}, {2, 2, 1}), .elasticity = {.young = 1e5}, .contact_radius = 0.01});
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back({i & 1 ? 0.1 : -0.1, i & 2 ? 0.12 : -0.12, i & 4 ? 0.09 : -0.09});
  const ConvexHull hull(corners);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<RigidBodies::Handle> handles;
  for (const Shape& shape : {Shape(Sphere{0.1}), Shape(Box{0.2, 0.2, 0.2}), Shape(Cylinder{0.1, 0.2}),
                             Shape(Capsule{0.05, 0.2}), Shape(hull)})
    handles.push_back(rigid.add(
        {.mass = 5., .inertia = Mat3(0.02 * Mat3::Identity()), .shape = shape, .collides_with = 2}));
  WithSurfaces ours{Backend{.margin = 0.02}};
  WithSurfaces native{NativeCollision{.margin = 0.02}};
  NativeCollision nodes{.margin = 0.02};
  ContactCache book;
  std::vector<ContactPoint> found, expected;
  std::size_t between = 0;
  for (int n = 0; n < 200; ++n) {
    for (const auto body : handles) {
      const double x = uniform(random), y = uniform(random), z = uniform(random), a = uniform(random),
                   b = uniform(random), c = uniform(random);
      rigid.place(body, {0.5 + 0.5 * x, 0.5 + 0.5 * y, 0.5 + 0.05 * z}, Quat(1, a, b, c).normalized());
    }
    book.gather(std::as_const(world));
    ours.see(world);
    native.see(world);
    ours.detect(book.colliders, h, found);
    native.detect(book.colliders, h, expected);
    REQUIRE(found.size() == expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      CHECK(found[i].pair == expected[i].pair);
      CHECK(found[i].feature == expected[i].feature);
      CHECK(std::abs(found[i].gap - expected[i].gap) <= 2e-5);
      CHECK((found[i].normal - expected[i].normal).norm() <= 0.01);
    }
    nodes.detect(book.colliders, h, expected);
    between += found.size() - expected.size();
  }
  CHECK(between > 100);  // on faces and edges
}

}  // namespace scenes
