#include "catch.hpp"
#include "collision/acceptance.hpp"

#include <delassus/bodies/particles.hpp>
#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/collision/body_tree.hpp>

#include <limits>
#include <vector>

namespace body_tree_tests {

using namespace delassus;
using namespace samples;

namespace {

using Bodies = World<RigidBodies, Particles>;

Vec3 any(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> uniform(-size, size);
  const double x = uniform(random), y = uniform(random), z = uniform(random);
  return {x, y, z};
}

bool same(const SurfacePoint& p, const SurfacePoint& q) {
  return p.is_found == q.is_found &&
         (!p.is_found || (p.anchor.set == q.anchor.set && p.anchor.block == q.anchor.block &&
                          p.point == q.point && p.normal == q.normal && p.distance == q.distance));
}

/// Asks both ways, and says how many answers there were.
int compare(const Bodies& world, const BodyTree& tree, std::mt19937& random) {
  int found = 0;
  std::vector<SurfacePoint> all, few;
  for (int k = 0; k < 60; ++k) {
    const Vec3 eye = any(random, 9), way = any(random, 1), at = any(random, 7);
    const double reach = k % 3 ? inner::forever : 4.0;
    const std::uint32_t groups = k % 5 ? ~0u : 2u;
    const SurfacePoint hit = ray_cast(world, eye, way, reach, groups);
    CHECK(same(hit, ray_cast(world, tree, eye, way, reach, groups)));
    const SurfacePoint near = closest_point(world, at, reach, groups);
    CHECK(same(near, closest_point(world, tree, at, reach, groups)));
    const Pose pose{.position = at, .rotation = any_rotation(random)};
    overlaps(world, Box{1, 2, 1.5}, pose, all, 0.1 * (k % 4), groups);
    overlaps(world, tree, Box{1, 2, 1.5}, pose, few, 0.1 * (k % 4), groups);
    REQUIRE(all.size() == few.size());
    for (std::size_t i = 0; i < all.size(); ++i) CHECK(same(all[i], few[i]));
    found += hit.is_found + near.is_found + int(all.size());
  }
  return found;
}

}  // namespace

TEST_CASE("the tree answers as all bodies one by one do, to the bit, while bodies move, come and go") {
  Bodies world;
  const Zoo zoo;
  std::mt19937 random(1);
  auto& rigid = world.get<RigidBodies>();
  rigid.add_fixed(HalfSpace{}, {0, 0, -6});
  std::vector<RigidBodies::Handle> handles;
  for (int i = 0; i < 150; ++i) {
    const Vec3 at = any(random, 6);
    handles.push_back(rigid.add({.position = at,
                                 .orientation = Quat(any_rotation(random)),
                                 .mass = 1.0,
                                 .shape = zoo.all[std::size_t(i) % zoo.all.size()],
                                 .group = i % 4 ? 1u : 2u}));
  }
  for (int i = 0; i < 40; ++i)
    world.get<Particles>().add({.position = any(random, 6), .mass = 1, .radius = 0.2});
  BodyTree tree;
  for (int round = 0; round < 6; ++round) {
    tree.refresh(world);
    CHECK(compare(world, tree, random) > 60);
    for (std::size_t i = 0; i < handles.size(); i += 3)
      rigid.place(handles[i], rigid.position(handles[i]) + any(random, 0.5), rigid.orientation(handles[i]));
    for (int k = 0; k < 5; ++k) {
      rigid.remove(handles.back());
      handles.pop_back();
    }
    handles.push_back(rigid.add({.position = any(random, 6), .mass = 1.0, .shape = Sphere{0.5}}));
  }
}

TEST_CASE("of bodies met at the same distance the tree names the one that comes first, as the others do") {
  Bodies world;
  auto& rigid = world.get<RigidBodies>();
  for (int i = 0; i < 20; ++i) rigid.add({.position = {3, 0, 0}, .mass = 1.0, .shape = Box{1, 1, 1}});
  for (int i = 0; i < 20; ++i) rigid.add({.position = {-9.0 - i, 0, 0}, .mass = 1.0, .shape = Sphere{0.4}});
  BodyTree tree;
  tree.refresh(world);
  CHECK(ray_cast(world, tree, Vec3::Zero(), Vec3::UnitX()).anchor.block == 0);
  CHECK(closest_point(world, tree, Vec3::UnitX()).anchor.block == 0);
  rigid.remove(rigid.handle(0));
  CHECK(ray_cast(world, tree, Vec3::Zero(), Vec3::UnitX()).anchor.block ==
        1);  // gone, though the tree was not told
}

TEST_CASE("an empty world, and bodies that are not finite, answer nothing") {
  Bodies world;
  BodyTree tree;
  tree.refresh(world);
  CHECK_FALSE(ray_cast(world, tree, Vec3::Zero(), Vec3::UnitX()));
  CHECK_FALSE(closest_point(world, tree, Vec3::Zero()));
  CHECK_THROWS(ray_cast(world, tree, Vec3::Zero(), Vec3::Zero()));
}

}  // namespace body_tree_tests
