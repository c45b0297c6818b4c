// Loops that differ in how they step have one type of scene, which puts a machine in, sets it and reads it as the loop itself does.
#include <delassus/constraints/joints/rotor_inertia.hpp>
#include <delassus/delassus.hpp>
#include <delassus/io/checkpoint.hpp>
#include <delassus/loop/scene.hpp>
#include <delassus/model/actuators.hpp>
#include <delassus/model/add.hpp>
#include <delassus/model/joint_reader.hpp>
#include <delassus/model/joint_state.hpp>

#include "catch.hpp"

#include <cmath>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

namespace scene_tests {

using namespace delassus;

namespace {

/// A rod with a rotor on a hinge, and a motor on it.
Model driven_rod() {
  Model model{.name = "rod"};
  model.gravity = {0, 0, -9.81};
  model.bodies.push_back({.name = "rod", .pose = {Vec3(0, 0, 1), Mat3::Identity()}, .mass = 2, .centre = {0.3, 0, 0}, .inertia = Mat3(Vec3(0.1, 0.2, 0.2).asDiagonal())});
  model.bodies.back().joints = {0};
  model.joints.push_back({.name = "hinge", .kind = model::JointKind::hinge, .axis = {0, 1, 0}, .armature = 0.05});
  model.actuators.push_back({.name = "motor", .target = 0, .gain = 3});
  return model;
}

template <class... More>
auto loop_with(More... more) {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}, Hinge{}, RotorInertia<Turn>{}}, more...};
}

/// Puts the rod in, sets it and drives it; q and v after it, and the bits of all.
template <bool by_scene, class Loop>
std::pair<std::vector<double>, std::uint64_t> run(Loop loop) {
  const Model model = driven_rod();
  const auto scene = [&]() -> decltype(auto) {
    if constexpr (by_scene) return scene_of(loop);
    else return (loop);
  };
  auto&& first = scene();
  Machine machine = add(first, model);
  JointSpace space(model);
  set_joint_state(first, machine, space, std::vector{0.4}, std::vector{-1.});
  set_control(machine, "motor", 2);
  for (int k = 0; k < 50; ++k) {
    auto&& now = scene();
    actuate(now, machine, 0.01);
    loop.step(0.01);
  }
  JointReader reader(model);
  std::vector<double> q{0.}, v{0.};
  reader.read(first, machine, q, v);
  return {{q[0], v[0]}, state_hash(loop)};
}

}  // namespace

TEST_CASE("a scene takes the place of its loop for a machine, whatever steps it") {
  auto euler = loop_with();
  auto midpoint = loop_with(ImplicitMidpoint{}, GaussSeidel{});
  static_assert(!std::is_same_v<decltype(euler), decltype(midpoint)>);
  static_assert(std::is_same_v<decltype(scene_of(euler)), decltype(scene_of(midpoint))>);

  const auto check = [](const auto& make) {
    const auto by_loop = run<false>(make()), by_scene = run<true>(make());
    CHECK(by_scene == by_loop);
    CHECK(std::abs(by_loop.first[0] - 0.4) > 0.1);  // it has moved
  };
  check([] { return loop_with(); });
  check([] { return loop_with(ImplicitMidpoint{}, GaussSeidel{}); });
}

TEST_CASE("a loop without contacts has a scene too") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, RotorInertia<Turn>{}}};
  const auto scene = scene_of(loop);
  CHECK(add(scene, driven_rod()).actuators.size() == 1);
}

TEST_CASE("a scene refuses what its loop refuses") {
  auto loop = loop_with();
  const auto body = bodies<RigidBodies>(loop.world()).add({.mass = 1.0, .shape = Sphere{0.1}});
  const auto scene = scene_of(loop);
  const Anchor end = anchor(bodies<RigidBodies>(loop.world()), body, {0, 0, 0});
  CHECK_THROWS_WITH(scene.add(Hinge::Item{end, end}), Catch::Matchers::Contains("both ends are on"));
  const auto hinge = scene.add(Hinge::Item{end, world_anchor({0, 0, 0})});
  CHECK(scene.contains(hinge));
  CHECK(&scene.item(hinge) == &loop.item(hinge));
  const auto& read_only = loop;
  CHECK(scene_of(read_only).contains(hinge));
  loop.remove(hinge);
  CHECK_FALSE(scene.contains(hinge));
  CHECK_THROWS_WITH(scene.item(hinge), Catch::Matchers::Contains("this constraint was removed"));
}

}  // namespace scene_tests
