/// Machines: gears, a rack and a screw by sweeps, a stop and a motor and links that fall with the direct
/// solver.
#include <delassus/bodies/anchor_at.hpp>
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/constraints/joints/coupling.hpp>
#include <delassus/constraints/joints/hinge.hpp>
#include <delassus/constraints/joints/limit.hpp>
#include <delassus/constraints/joints/motor.hpp>
#include <delassus/constraints/joints/screw.hpp>
#include <delassus/constraints/joints/slider.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

#include "scenes.hpp"
#include "trace.hpp"

using namespace trace;

namespace {

auto train() {
  return AnimationLoop{World{RigidBodies{}},
                       Constraints{Hinge{}, Slider{}, Gear{}, Rack{}, Screw{}, Motor<Turn>{}, Limit<Slide>{}},
                       AcceleratedGaussSeidel{.tolerance = 1e-10}};
}
auto machine() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Hinge{}, Limit<Turn>{}, Motor<Turn>{}},
                       DirectGaussSeidel{.tolerance = 1e-10}};
}

auto links() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}},
                       DirectGaussSeidel{.tolerance = 1e-10}};
}

}  // namespace

int main(int argc, char** argv) {
  Trace all("machines_more");
  // A motor turns a wheel, that one another, that one moves a bar with teeth until its stop; a nut goes along
  // its screw.
  all.add("gears_rack_screw", {.h = 0.005}, [] {
    auto loop = train();
    auto& set = rigid_of(loop);
    const Quat z, x = frame_along({1, 0, 0});
    const auto first = set.add({.position = {0, 0, 0}, .mass = 1.0, .shape = Cylinder{0.2, 0.1}}),
               second = set.add({.position = {0.5, 0, 0}, .mass = 2.0, .shape = Cylinder{0.3, 0.1}}),
               bar = set.add({.position = {0.5, 0.35, 0}, .mass = 1.0, .shape = Box{1, 0.1, 0.1}}),
               nut = set.add({.position = {0, 0, 1},
                              .angular_velocity = {0, 0, 3},
                              .mass = 0.5,
                              .shape = Box{0.1, 0.1, 0.1}});
    const Anchor w1 = world_anchor({0, 0, 0}), w2 = world_anchor({0.5, 0, 0}),
                 wb = world_anchor({0.5, 0.35, 0}, x);
    const Anchor a1 = anchor(set, first), a2 = anchor(set, second), ab = anchor(set, bar, {0, 0, 0}, x);
    loop.add(Hinge::Item{w1, a1});
    loop.add(Hinge::Item{w2, a2});
    loop.add(Slider::Item{wb, ab});
    loop.add(Motor<Turn>::Item{.a = w1, .b = a1, .speed = 6, .max_force = 2});
    loop.add(Gear::Item{.a = a2, .b = a1, .c = w2, .d = w1, .ratio = -2. / 3});
    loop.add(Rack::Item{.a = ab, .b = a2, .c = wb, .d = w2, .ratio = 0.3});
    loop.add(Limit<Slide>::Item{.a = wb, .b = ab, .lower = -0.3, .upper = 0.3});
    loop.add(Screw::Item{world_anchor({0, 0, 1}), anchor(set, nut), 0.05});
    return loop;
  });
  // An arm falls on its stop and comes back, another is turned by a motor that is too weak at first.
  all.add(
      "stop_and_motor_direct", {.h = 0.01},
      [] {
        auto loop = machine();
        auto& set = rigid_of(loop);
        const Quat axis = frame_along({0, -1, 0});
        for (int k = 0; k < 2; ++k) {
          const Vec3 foot(0, k, 0);
          const auto arm =
              set.add({.position = foot + Vec3(0.5, 0, 0), .mass = 1.0 + k, .shape = Box{1, 0.1, 0.1}});
          const Anchor a = world_anchor(foot, axis), b = anchor_at(set, arm, foot, axis);
          loop.add(Hinge::Item{a, b});
          if (k == 0)
            loop.add(Limit<Turn>::Item{.a = a, .b = b, .lower = -0.6, .upper = 0.2, .restitution = 0.5});
          if (k == 1) loop.add(Motor<Turn>::Item{.a = a, .b = b, .speed = 3, .max_force = 15});
        }
        return loop;
      },
      [](auto& loop, int n) {
        loop.item(loop.template constraint<Motor<Turn>>(0)).max_force = n < 60 ? 5 : 30;
      });
  all.add("chain_falls_on_ground", {.h = 0.01, .is_redundant = true}, [] {
    auto loop = links();
    auto& set = rigid_of(loop);
    set.add_fixed(HalfSpace{});
    add_chain(loop, 3, 0.7, [&](const Anchor& a, const Anchor& b) { loop.add(BallJoint::Item{a, b}); });
    return loop;
  });
  return all.main(argc, argv);
}
