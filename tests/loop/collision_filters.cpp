#include "scenes.hpp"

#include "catch.hpp"

#include <delassus/collision/with_filter.hpp>
#include <delassus/io/checkpoint.hpp>

#include <vector>

namespace collision_filters_tests {

using namespace scenes;
using Catch::Matchers::Contains;

namespace {

/// Two boxes that overlap by a tenth, joined in the middle or not.
template <class Collision>
auto overlapping(Collision collision) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}},
                     collision};
  auto& rigid = rigid_bodies(loop);
  rigid.gravity.setZero();
  for (const double x : {0.0, 0.9}) rigid.add({.position = {x, 0, 0}, .mass = 1.0, .shape = Box{1, 1, 1}});
  return loop;
}

template <class Loop>
auto box(Loop& loop, Index i) {
  return rigid_bodies(loop).handle(i);
}

template <class Loop>
auto join(Loop& loop) {
  auto& rigid = rigid_bodies(loop);
  return loop.add(
      BallJoint::Item{anchor(rigid, box(loop, 0), {0.45, 0, 0}), anchor(rigid, box(loop, 1), {-0.45, 0, 0})});
}

/// A backend of a user's: every two colliders touch.
struct AllTouch {
  using plays = role::Collision;
  CollisionReport detect(std::span<const Collider> colliders, double, std::vector<ContactPoint>& points) {
    points.clear();
    for (Index i = 0; i < Index(colliders.size()); ++i)
      for (Index j = i + 1; j < Index(colliders.size()); ++j)
        points.push_back({.a = i, .b = j, .pair = pair_key(colliders[i].key, colliders[j].key)});
    return {.points = Index(points.size())};
  }
};

}  // namespace

TEST_CASE("bodies that a joint holds together do not collide while it does") {
  auto loop = overlapping(WithFilter{NativeCollision{}});
  CHECK(loop.step(1e-3).contacts == 4);
  const auto hook = join(loop);
  CHECK(loop.step(1e-3).contacts == 0);
  CHECK(loop.report().queries == 0);
  loop.remove(hook);
  CHECK(loop.step(1e-3).contacts == 4);
}

TEST_CASE("a filter that spares the joined, and a loop without one, let them collide") {
  auto spared = overlapping(WithFilter{NativeCollision{}, false});
  join(spared);
  CHECK(spared.step(1e-3).contacts == 4);
  auto plain = overlapping(NativeCollision{});
  join(plain);
  CHECK(plain.step(1e-3).contacts == 4);
}

TEST_CASE("a pair that is ignored passes through each other until it is heeded") {
  auto loop = overlapping(WithFilter{NativeCollision{}});
  auto& rigid = rigid_bodies(loop);
  auto& filter = loop.get<WithFilter<NativeCollision>>();
  filter.ignore(loop.world(), anchor(rigid, box(loop, 1)), anchor(rigid, box(loop, 0)));
  CHECK(loop.step(1e-3).contacts == 0);
  rigid.add({.position = {1.8, 0, 0}, .mass = 1.0, .shape = Box{1, 1, 1}});
  CHECK(loop.step(1e-3).contacts == 4);  // others collide as ever
  filter.heed(loop.world(), anchor(rigid, box(loop, 0)), anchor(rigid, box(loop, 1)));
  CHECK(loop.step(1e-3).contacts == 8);
}

TEST_CASE("an ignored pair is forgotten with its body: the next one in its place collides") {
  auto loop = overlapping(WithFilter{NativeCollision{}});
  auto& rigid = rigid_bodies(loop);
  loop.get<WithFilter<NativeCollision>>().ignore(loop.world(), anchor(rigid, box(loop, 0)),
                                                 anchor(rigid, box(loop, 1)));
  loop.remove(box(loop, 1));
  CHECK(loop.step(1e-3).contacts == 0);
  const auto next = rigid.add({.position = {0.9, 0, 0}, .mass = 1.0, .shape = Box{1, 1, 1}});
  REQUIRE(next.index == 1);
  CHECK(loop.step(1e-3).contacts == 4);
}

TEST_CASE("a checkpoint keeps the ignored pairs") {
  auto loop = overlapping(WithFilter{NativeCollision{}}),
       restored = overlapping(WithFilter{NativeCollision{}});
  auto& rigid = rigid_bodies(loop);
  loop.get<WithFilter<NativeCollision>>().ignore(loop.world(), anchor(rigid, box(loop, 0)),
                                                 anchor(rigid, box(loop, 1)));
  loop.step(1e-3);
  restore(restored, checkpoint(loop));
  CHECK(restored.step(1e-3).contacts == 0);
  auto& again = rigid_bodies(restored);
  restored.get<WithFilter<NativeCollision>>().heed(restored.world(), anchor(again, box(restored, 0)),
                                                   anchor(again, box(restored, 1)));
  CHECK(restored.step(1e-3).contacts == 4);
}

TEST_CASE("any backend can be filtered") {
  auto loop = overlapping(WithFilter{AllTouch{}});
  rigid_bodies(loop).add({.position = {5, 0, 0}, .mass = 1.0, .shape = Sphere{1}});
  CHECK(loop.step(1e-3).contacts == 3);
  join(loop);
  CHECK(loop.step(1e-3).contacts == 2);
}

TEST_CASE("a filter refuses what is no pair of bodies") {
  auto loop = overlapping(WithFilter{NativeCollision{}});
  auto& rigid = rigid_bodies(loop);
  auto& filter = loop.get<WithFilter<NativeCollision>>();
  const Anchor a = anchor(rigid, box(loop, 0));
  CHECK_THROWS_WITH(filter.ignore(loop.world(), a, a), Contains("body 0 is named twice"));
  CHECK_THROWS_WITH(filter.ignore(loop.world(), a, world_anchor(Vec3::Zero())),
                    Contains("the world has no shape"));
}

}  // namespace collision_filters_tests
