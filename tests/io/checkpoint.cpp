#include "scenes.hpp"

#include <delassus/io/checkpoint.hpp>
#include <delassus/schemes/joint_by_joint.hpp>

#include <cstdio>
#include <filesystem>

#include "catch.hpp"
#include "rope.hpp"
#include "same_bits.hpp"
#include "scratch_path.hpp"

using namespace scenes;

namespace {

auto stack_loop() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.6}}},
                       AcceleratedGaussSeidel{.tolerance = 1e-6}};
}

/// A law by another name.
struct Hinge2 : Hinge {};

}  // namespace

TEST_CASE("restored, a falling and tumbling box goes on bit for bit") {
  require_same_bits(1e-3, [] { return AnimationLoop{World{RigidBodies{}}}; }, [](auto& loop) {
    rigid_bodies(loop).add({.position = {0, 0, 5}, .angular_velocity = {1, 2, 3}, .mass = 2.0, .shape = Box{1, 2, 3}});
  });
}

TEST_CASE("restored, a stack of boxes and hulls goes on bit for bit, contacts, ids and warm starts") {
  require_same_bits(5e-3, stack_loop, [](auto& loop) {
    auto& set = rigid_bodies(loop);
    set.add_fixed(HalfSpace{});
    for (int i = 0; i < 6; ++i) {
      const ConvexHull cube = cube_of_points();
      set.add({.position = {0.01 * i, 0, 0.501 + 1.001 * i}, .mass = 1.0, .shape = i % 2 ? Shape(Box{1, 1, 1}) : Shape(cube)});
    }
    set.add({.position = {0.3, 0, 9}, .angular_velocity = {3, 1, 0}, .mass = 2.0, .shape = Capsule{0.3, 0.8}});
  });
}

TEST_CASE("restored, a chain on ball joints goes on bit for bit") {
  require_same_bits(2e-3, [] {
    return AnimationLoop{World{RigidBodies{}}, Constraints{BallJoint{}}, AcceleratedGaussSeidel{.tolerance = 1e-8}};
  }, [](auto& loop) {
    auto& set = rigid_bodies(loop);
    Anchor end = world_anchor({0, 0, 3});
    for (int k = 0; k < 8; ++k) {
      const auto link = set.add({.position = {0.2 * k + 0.1, 0, 3}, .mass = 0.1, .shape = Box{0.2, 0.02, 0.02}});
      loop.add(BallJoint::Item{end, anchor(set, link, {-0.1, 0, 0})});
      end = anchor(set, link, {0.1, 0, 0});
    }
  });
}

TEST_CASE("restored, joints in turn go on bit for bit, with the impulses they begin with") {
  require_same_bits(2e-3, [] {
    return AnimationLoop{World{RigidBodies{}}, Constraints{BallJoint{}, Hinge{}}, JointByJoint{.sweeps = 2}};
  }, [](auto& loop) {
    auto& set = rigid_bodies(loop);
    Anchor end = world_anchor({0, 0, 3});
    for (int k = 0; k < 4; ++k) {
      const auto link = set.add({.position = {0.2 * k + 0.1, 0, 3}, .mass = 0.1, .shape = Box{0.2, 0.02, 0.02}});
      loop.add(BallJoint::Item{end, anchor(set, link, {-0.1, 0, 0})});
      end = anchor(set, link, {0.1, 0, 0});
    }
    const auto door = set.add({.position = {0.5, 5, 0}, .angular_velocity = {0, 0, 1}, .mass = 3.0, .shape = Box{1, 0.1, 2}});
    loop.add(Hinge::Item{anchor(set, door, {-0.5, 0, 0}), world_anchor({0, 5, 0})});
  });
}

TEST_CASE("restored, a slope with materials and a bouncing ball goes on bit for bit") {
  require_same_bits(5e-3, [] {
    return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Restitution{Coulomb{.friction = 0.3}, 0.8}}}, PredictiveScheme{}};
  }, [](auto& loop) {
    auto& set = rigid_bodies(loop);
    const Index ice = loop.materials().add({.friction = 0.05});
    set.add({.orientation = Quat(Eigen::AngleAxisd(0.3, Vec3::UnitY())), .shape = HalfSpace{}, .motion = Motion::fixed, .material = ice});
    set.add({.position = {0, 0, 0.6}, .mass = 1.0, .shape = Box{1, 1, 1}, .material = ice});
    set.add({.position = {0, 3, 4}, .velocity = {1, 0, 0}, .mass = 1.0, .shape = Sphere{0.4}});
  });
}

TEST_CASE("restored, a law of one's own, springs and two sets go on bit for bit") {
  require_same_bits(5e-3, [] {
    return AnimationLoop{World{RigidBodies{}, Particles{}}, Constraints{Rope{}, DistanceJoint{}}, ImplicitEuler{}};
  }, [](auto& loop) {
    auto& set = rigid_bodies(loop);
    auto& dust = loop.world().template set<1>();
    const auto weight = set.add({.position = {1, 0, 2}, .mass = 5.0, .shape = Sphere{0.1}});
    loop.add(Rope::Item{world_anchor({0, 0, 2}), anchor(set, weight), 1.0});
    const auto p = dust.add({.position = {1, 0, 1}, .mass = 0.2}), q = dust.add({.position = {1, 0, 0.5}, .mass = 0.1});
    dust.add_spring(p, q, 40, 0.3);
    loop.add(DistanceJoint::Item{anchor(set, weight), anchor(dust, p), 1.0});
  });
}

TEST_CASE("restored, sleepers sleep on, and wake where they would have") {
  require_same_bits(1.0 / 60, [] {
    return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}}, Sleeping{}};
  }, [](auto& loop) {
    auto& set = rigid_bodies(loop);
    add_stack(set, 3, Box{1, 1, 1});
    const auto bob = set.add({.position = {3, 0, 2.5}, .mass = 1.0, .shape = Sphere{0.4}});
    loop.add(BallJoint::Item{anchor(set, bob), world_anchor({0, 0, 5})});
  });
}

TEST_CASE("removed bodies leave their gaps in a checkpoint, and a new body takes the same place in both") {
  auto loop = stack_loop();
  auto& set = rigid_bodies(loop);
  const auto handles = add_stack(set, 4, Box{1, 1, 1});
  for (int n = 0; n < 50; ++n) loop.step(5e-3);
  loop.remove(handles[1]);
  for (int n = 0; n < 20; ++n) loop.step(5e-3);
  auto restored = stack_loop();
  restore(restored, checkpoint(loop));
  for (auto* l : {&loop, &restored}) {
    const auto added = rigid_bodies(*l).add({.position = {0, 0, 6}, .mass = 1.0, .shape = Box{1, 1, 1}});
    REQUIRE(added.index == handles[1].index);
    for (int n = 0; n < 500; ++n) l->step(5e-3);
  }
  REQUIRE(state_hash(loop) == state_hash(restored));
}

TEST_CASE("who is added after a step back has no handle that somebody had before it") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}};
  auto& set = rigid_bodies(loop);
  const auto kept = set.add({.mass = 1, .shape = Sphere{0.1}});
  const auto bytes = checkpoint(loop);
  loop.remove(kept);
  const auto in_its_place = set.add({.mass = 2, .shape = Sphere{0.1}}), behind = set.add({.mass = 3, .shape = Sphere{0.1}});
  const auto hook = loop.add(BallJoint::Item{world_anchor({0, 0, 0}), anchor(set, behind)});
  restore(loop, bytes);
  // Whoever was there at the checkpoint is there again; the others are gone for good, though each place is given anew.
  CHECK(set.mass(kept) == 1);
  loop.remove(kept);
  for (int k = 0; k < 2; ++k) set.add({.mass = 4, .shape = Sphere{0.1}});
  loop.add(BallJoint::Item{world_anchor({0, 0, 0}), anchor(set, set.handle(1))});
  for (const auto& gone : {kept, in_its_place, behind}) CHECK_FALSE(set.contains(gone));
  CHECK_FALSE(loop.contains(hook));
  // A second step back, to where there was nobody but the first.
  restore(loop, bytes);
  CHECK(set.contains(kept));
  CHECK_FALSE(set.contains(in_its_place));
}

TEST_CASE("a checkpoint of another loop, cut short, or damaged is refused and changes nothing") {
  auto loop = stack_loop();
  add_stack(rigid_bodies(loop), 3, Box{1, 1, 1});
  for (int n = 0; n < 20; ++n) loop.step(5e-3);
  const auto bytes = checkpoint(loop);
  loop.step(5e-3);
  const auto before = state_hash(loop);
  auto damaged = bytes;
  damaged[bytes.size() / 2] ^= 1;
  REQUIRE_THROWS_WITH(restore(loop, damaged), Catch::Contains("not those that were written"));
  for (const std::size_t n : {std::size_t(0), std::size_t(10), bytes.size() / 2, bytes.size() - 1})
    REQUIRE_THROWS_AS(restore(loop, std::span(bytes).first(n)), InvalidArgument);
  AnimationLoop other{World{RigidBodies{}}, Constraints{BallJoint{}}};
  REQUIRE_THROWS_WITH(restore(other, bytes), Catch::Contains("another version or another loop"));
  REQUIRE(state_hash(loop) == before);
}

// A hinge and a slider have five rows and items of one size: the names tell them apart. The type of the solver is not saved.
TEST_CASE("a checkpoint of laws and sets of other names is refused, one of another solver is not") {
  const auto refuses = [](const auto& bytes, auto loop) {
    rigid_bodies(loop).add({.position = {0, 0, 5}, .mass = 1.0, .shape = Sphere{0.1}});
    const auto before = state_hash(loop);
    CHECK_THROWS_WITH(restore(loop, bytes), Catch::Contains("another version or another loop"));
    CHECK(state_hash(loop) == before);
  };
  AnimationLoop door{World{RigidBodies{}}, Constraints{Hinge{}, Slider{}}};
  auto& set = rigid_bodies(door);
  door.add(Hinge::Item{world_anchor({0, 0, 0}), anchor(set, set.add({.position = {1, 0, 0}, .mass = 1.0, .shape = Box{1, 1, 1}}), {-1, 0, 0})});
  door.step(0.01);
  const auto bytes = checkpoint(door);
  refuses(bytes, AnimationLoop{World{RigidBodies{}}, Constraints{Slider{}, Hinge{}}});
  refuses(bytes, AnimationLoop{World{RigidBodies{}}, Constraints{Hinge{}, Hinge2{}}});
  AnimationLoop other{World{RigidBodies{}}, Constraints{Hinge{}, Slider{}}, GaussSeidel{}};
  restore(other, bytes);
  CHECK(state_hash(other) == state_hash(door));
  auto old = bytes;
  old[std::string("delassus checkpoint ").size()] = '1';
  refuses(old, AnimationLoop{World{RigidBodies{}}, Constraints{Hinge{}, Slider{}}});
}

TEST_CASE("a checkpoint file is written whole, and a path that cannot be is named") {
  const auto path = scratch_path("checkpoint").string();
  auto loop = stack_loop();
  add_stack(rigid_bodies(loop), 3, Box{1, 1, 1});
  for (int n = 0; n < 20; ++n) loop.step(5e-3);
  save_checkpoint(loop, path);
  auto restored = stack_loop();
  load_checkpoint(restored, path);
  REQUIRE(state_hash(restored) == state_hash(loop));
  REQUIRE(!std::filesystem::exists(path + ".part"));
  std::filesystem::remove(path);
  REQUIRE_THROWS_WITH(save_checkpoint(loop, "/no/such/folder/x"), Catch::Contains("cannot write '/no/such/folder/x'"));
  REQUIRE_THROWS_WITH(load_checkpoint(loop, "/no/such/folder/x"), Catch::Contains("cannot open '/no/such/folder/x' for reading"));
}

TEST_CASE("equal states have equal hashes, one bit makes another") {
  AnimationLoop loop{World{RigidBodies{}}};
  auto& set = rigid_bodies(loop);
  const auto box = set.add({.position = {0, 0, 5}, .mass = 2.0, .shape = Box{1, 2, 3}});
  const auto before = state_hash(loop);
  REQUIRE(state_hash(loop) == before);
  set.place(box, {0, 0, std::nextafter(5.0, 6.0)});
  REQUIRE(state_hash(loop) != before);
}
