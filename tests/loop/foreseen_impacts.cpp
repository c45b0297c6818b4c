#include "catch.hpp"
#include "collision/mesh_scene.hpp"

#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/collision/seamless.hpp>
#include <delassus/collision/with_meshes.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/constraints/contact/restitution.hpp>
#include <delassus/constraints/joints/planar.hpp>
#include <delassus/constraints/joints/slider.hpp>
#include <delassus/constraints/joints/weld.hpp>
#include <delassus/integrators/implicit_midpoint.hpp>
#include <delassus/loop/animation_loop.hpp>
#include <delassus/loop/defaults.hpp>

#include <cmath>
#include <random>

// Detection foresees impacts by the free fall of each body. What a joint, a force or an earlier impact leads elsewhere meets nothing
// there, and is not to be touched.
namespace foreseen_impacts_tests {

using namespace delassus;

namespace {

constexpr double h = 1 / 60.;

/// The most by which the velocity of a body of 1 kg that glides at v over a fixed block, 2 mm above its top, differs from v.
double change_above(const auto& law, double v, const Shape& body, double half, const auto& carry, const auto& join) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}, law}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(Box{0.3, 0.4, 0.2}, {0, 0, -0.1 - half - 2e-3});
  const auto b = set.add({.position = {-0.5, 0, 0}, .velocity = {v, 0, 0}, .mass = 1, .shape = body});
  join(loop, b);
  double worst = 0;
  for (int i = 0; i < int(1 / (v * h)); ++i) {
    carry(set, b);
    loop.step(h);
    worst = std::max(worst, (set.velocity(b) - Vec3(v, 0, 0)).norm());
  }
  return worst;
}

/// A ball of 5 cm is thrown at two boxes whose tops are one plane, `before` m from their seam: its velocity after five steps.
template <class Detection>
Vec3 thrown_at_tiles(const Detection& detection, double speed, double e, double before, double step) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Coulomb{.friction = 0}, e}}}, detection};
  auto& set = bodies<RigidBodies>(loop.world());
  set.gravity.setZero();
  for (const double x : {-1., 1.}) set.add_fixed(Box{2, 2, 1}, {x, 0, -0.5});
  const Vec3 v = speed * Vec3(0.6, 0, -0.8);
  const auto b = set.add({.position = Vec3(-before, 0, 0.05) - 1.3 * step * v, .velocity = v, .mass = 1, .shape = Sphere{0.05}});
  for (int i = 0; i < 5; ++i) loop.step(step);
  return set.velocity(b);
}

}  // namespace

// Free, the body would fall by g h² = 2.7 mm in a step and meet the block's side. The joint or the force carries its weight.
TEST_CASE("what is carried over an obstacle is not touched") {
  const auto no_force = [](RigidBodies&, RigidBodies::Handle) {};
  for (const double v : {0.3, 1.0, 3.0}) {
    for (const bool is_ball : {false, true}) {
      const Shape body = is_ball ? Shape(Sphere{0.05}) : Shape(Box{0.2, 0.2, 0.1});
      CAPTURE(v, is_ball);
      CHECK(change_above(Planar{}, v, body, 0.05, no_force, [](auto& loop, auto b) {
              loop.add(Planar::Item{world_anchor({-0.5, 0, 0}), anchor(bodies<RigidBodies>(loop.world()), b)});
            }) < 1e-9);
      CHECK(change_above(Slider{}, v, body, 0.05, no_force, [](auto& loop, auto b) {
              const Quat along_x(Eigen::AngleAxisd(std::acos(0.0), Vec3(0, 1, 0)));
              loop.add(Slider::Item{world_anchor({-0.5, 0, 0}, along_x), anchor(bodies<RigidBodies>(loop.world()), b, {0, 0, 0}, along_x)});
            }) < 1e-9);
      // The weld of a load to what is led answers to any push.
      CHECK(change_above(Weld{}, v, body, 0.05, no_force, [v](auto& loop, auto b) {
              auto& set = bodies<RigidBodies>(loop.world());
              const auto arm = set.add({.position = {-0.5, 0, 1}, .velocity = {v, 0, 0}, .motion = Motion::kinematic});
              loop.add(Weld::Item{anchor(set, arm, {0, 0, -1}), anchor(set, b)});
            }) < 1e-9);
      CHECK(change_above(Weld{}, v, body, 0.05, [](RigidBodies& set, RigidBodies::Handle b) { set.apply_force(b, -set.gravity); }, [](auto&, auto) {}) <
            1e-9);
    }
  }
}

// A mirror: (v_x, 0, −e v_z). The second tile's side lies on the way that the ball had, under the first one's top. What slides on past
// the seam of plain tiles feels it, as the limits say.
TEST_CASE("of two tiles the one that is met first throws back") {
  for (const double step : {h, 1 / 240.})
    for (const double speed : {3., 5., 10.})
      for (const double before : {0.02, 0.06}) {
        CAPTURE(step, speed, before);
        const Vec3 thrown = thrown_at_tiles(NativeCollision{}, speed, 0.5, before, step), slid = thrown_at_tiles(Seamless{NativeCollision{}}, speed, 0, before, step);
        CHECK((thrown - speed * Vec3(0.6, 0, 0.4)).norm() < 1e-6 * speed);
        CHECK((slid - speed * Vec3(0.6, 0, 0)).norm() < 1e-6 * speed);
      }
}

TEST_CASE("who stands behind a plate or on the old way of what glances off is not hit") {
  for (const double step : {h, 1 / 240.})
    for (const double speed : {5., 20.}) {
      CAPTURE(step, speed);
      {
        AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Coulomb{.friction = 0}, 1}}}};
        auto& set = bodies<RigidBodies>(loop.world());
        set.gravity.setZero();
        set.add_fixed(Box{2, 2, 0.02}, {0, 0, -0.01});
        const Vec3 v = speed * Vec3(std::sin(0.5), 0, -std::cos(0.5));
        const auto ball = set.add({.position = Vec3(0, 0, 0.02) - 0.4 * step * v, .velocity = v, .mass = 1, .shape = Sphere{0.02}});
        const Vec3 behind = Vec3(0, 0, 0.02) + 0.06 / std::cos(0.5) / speed * v;
        const auto hidden = set.add({.position = behind + Vec3(0.005, 0.004, -0.01), .mass = 1, .shape = Sphere{0.02}});
        for (int i = 0; i < 4; ++i) loop.step(step);
        CHECK((set.velocity(ball) - Vec3(v.x(), 0, -v.z())).norm() < 1e-6 * speed);
        CHECK(set.velocity(hidden).norm() == 0);
      }
      // Off a fixed ball at 45°, without a bounce: half of the speed is left, at 45°.
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0}}}};
      auto& set = bodies<RigidBodies>(loop.world());
      set.gravity.setZero();
      const Vec3 place = 0.05 * std::sqrt(0.5) * Vec3(-1, 0, 1);
      set.add_fixed(Sphere{0.03}, {0, 0, 0});
      set.add_fixed(Sphere{0.03}, {0.1, 0, 0.02});
      const auto ball = set.add({.position = place - Vec3(0.03, 0, 0), .velocity = {speed, 0, 0}, .mass = 1, .shape = Sphere{0.02}});
      for (int i = 0; i < int(0.05 / step); ++i) loop.step(step);
      CHECK((set.velocity(ball) - 0.5 * speed * Vec3(1, 0, 1)).norm() < 0.01 * speed);
    }
}

// The midpoint rule moves bodies by the mean of both velocities, and who meets is asked by that. Small boxes fly past a plate at random.
// A pair that was asked again in vain got a contact each time. Four corners, an edge and the middle make six at most. Boxes that land
// sink in by h v/2, or go through (limits page), and then a solve need not end.
TEST_CASE("a step by the midpoint rule beside a plate ends") {
  int untouched = 0;
  std::mt19937 random(7);
  const auto next = [&](double from, double to) { return from + (to - from) * (random() / 4294967296.0); };
  for (int i = 0; i < 300; ++i) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, ImplicitMidpoint{}};
    auto& set = bodies<RigidBodies>(loop.world());
    set.gravity.setZero();
    set.add_fixed(Box{0.8, 0.8, 0.04});
    // One draw a statement: the order is the same of every compiler.
    const double v_x = next(-8, 8), v_y = next(-8, 8), v_z = -next(1, 8);
    const double x = next(-0.5, 0.5), y = next(-0.5, 0.5), ago = next(0, 1);
    const double w_x = next(-8, 8), w_y = next(-8, 8), w_z = next(-8, 8);
    const Vec3 v(v_x, v_y, v_z);
    set.add({.position = Vec3(x, y, 0.06) - ago * h * v, .velocity = v, .angular_velocity = {w_x, w_y, w_z}, .mass = 1,
             .shape = Box{0.05, 0.03, 0.02}});
    for (int k = 0; k < 4; ++k) {
      CAPTURE(i, k);
      const Status status = loop.step(h).status;
      CHECK(loop.contacts().size() <= 6);
      if (!loop.contacts().empty()) continue;
      CHECK(status == Status::converged);
      ++untouched;
    }
  }
  CHECK(untouched > 300);
}

// |v| = 7, 7 e, 7 e²: the ball starts 1.3 steps before the right wall, meets it in the second step, and the left one in the next, way / (7 e) later.
TEST_CASE("a ball that meets another wall right after the first is not held by the first") {
  for (const int kind : {0, 1, 2})
    for (const double e : {0.8, 0.9, 1.0})
      for (const double step : {h, h / 4}) {
        CAPTURE(kind, e, step);
        AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Coulomb{.friction = 0}, e}}}, WithMeshes<NativeCollision>{}};
        auto& set = bodies<RigidBodies>(loop.world());
        set.gravity.setZero();
        const double way = 6 * step * e, half = 0.5 * way + 0.1;  // the wall's plane
        for (const double side : {-1., 1.}) {
          if (kind == 0) set.add_fixed(HalfSpace{{-side, 0, 0}, -half});
          else if (kind == 1) set.add_fixed(Box{1, 3, 3}, {side * (half + 0.5), 0, 0});
          else set.add_fixed(loop.get<WithMeshes<NativeCollision>>().add(scenes::fine_box(1, 3, 3, 2)), {side * (half + 0.5), 0, 0});
        }
        const auto ball = set.add({.position = {0.5 * way - 1.3 * 7 * step, 0.2, 0.1}, .velocity = {7, 0, 0}, .mass = 1, .shape = Sphere{0.1}});
        for (const double expected : {7., -7 * e, 7 * e * e}) {
          loop.step(step);
          CHECK(std::abs(set.velocity(ball).x() - expected) < 1e-5);
        }
      }
}

// Four reflections at two planes with 45° between them are a turn by 180°: v becomes −v.
TEST_CASE("a ball that is thrown into a corner of 45 degrees comes back as it came") {
  for (int i = 0; i < 20; ++i) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Coulomb{.friction = 0}, 1}}}};
    auto& set = bodies<RigidBodies>(loop.world());
    set.gravity.setZero();
    const double quarter = std::acos(0.0) / 4, way = 0.01 * (i - 10);
    for (const double side : {-1., 1.}) set.add_fixed(HalfSpace{{std::sin(quarter), side * std::cos(quarter), 0}, 0});
    const Vec3 v(-2, 0.1, 0);
    const auto ball = set.add({.position = {0.4, 0.3 * way, 0}, .velocity = v, .mass = 1, .shape = Sphere{0.02}});
    for (int k = 0; k < 150; ++k) loop.step(h / 4);
    CAPTURE(i);
    CHECK((set.velocity(ball) + v).norm() < 1e-3);
  }
}

}  // namespace foreseen_impacts_tests
