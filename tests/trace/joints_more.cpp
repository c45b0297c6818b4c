/// The other joints: cylinders, planes, welds, what breaks, what couples two bodies softly, springs and
/// drives.
#include <delassus/bodies/anchor_at.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/constraints/joints/breakable.hpp>
#include <delassus/constraints/joints/cylindrical.hpp>
#include <delassus/constraints/joints/distance_joint.hpp>
#include <delassus/constraints/joints/drive.hpp>
#include <delassus/constraints/joints/hinge.hpp>
#include <delassus/constraints/joints/planar.hpp>
#include <delassus/constraints/joints/point_on_line.hpp>
#include <delassus/constraints/joints/universal.hpp>
#include <delassus/constraints/joints/virtual_coupling.hpp>
#include <delassus/constraints/joints/weld.hpp>
#include <delassus/solvers/minimum_norm.hpp>
#include <delassus/stabilisation/with_compliance.hpp>

#include "scenes.hpp"
#include "trace.hpp"

using namespace trace;

namespace {

auto rest() {
  return AnimationLoop{World{RigidBodies{}},
                       Constraints{BallJoint{}, Cylindrical{}, Planar{}, PointOnLine{}, Universal{}, Weld{}},
                       AcceleratedGaussSeidel{.tolerance = 1e-10}};
}
auto breaking() {
  return AnimationLoop{World{RigidBodies{}},
                       Constraints{Breakable<BallJoint>{}, VirtualCoupling{}, DistanceJoint{}},
                       AcceleratedGaussSeidel{.tolerance = 1e-10}};
}
auto least() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{BallJoint{}},
                       MinimumNorm{AcceleratedGaussSeidel{.tolerance = 1e-10}}};
}

auto soft() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{BallJoint{}}, WithCompliance{Baumgarte{}, 1e-5}};
}
auto driven() { return AnimationLoop{World{RigidBodies{}}, Constraints{Hinge{}, Drive<Turn>{}}}; }

}  // namespace

int main(int argc, char** argv) {
  Trace all("joints_more");
  all.add("cylinder_plane_line_cross_weld", {.h = 0.01}, [] {
    auto loop = rest();
    auto& set = rigid_of(loop);
    const Quat lean = exponential<double>({0.5, 0.2, 0});
    std::vector<RigidBodies::Handle> b;
    for (int k = 0; k < 5; ++k)
      b.push_back(set.add({.position = {1.0 * k, 0, 0},
                           .velocity = {0, 0.5, 0},
                           .angular_velocity = {0.3, 0.2 * k, 1},
                           .mass = 1.0 + k,
                           .shape = Box{0.4, 0.3, 0.2}}));
    loop.add(Cylindrical::Item{world_anchor({0, 0, 0}, lean), anchor(set, b[0], {0, 0, 0}, lean)});
    loop.add(Planar::Item{world_anchor({1, 0, 0}, lean), anchor(set, b[1], {0, 0, 0}, lean)});
    loop.add(PointOnLine::Item{world_anchor({2, 0, 0}, lean), anchor(set, b[2], {0.1, 0, 0}, lean)});
    loop.add(Universal::Item{world_anchor({2.5, 0, 0}), anchor(set, b[3], {-0.5, 0, 0})});
    loop.add(Weld::Item{anchor(set, b[3], {0.5, 0, 0}), anchor(set, b[4], {-0.5, 0, 0})});
    return loop;
  });
  // The joint breaks in the swing, a spring catches, and what is coupled to a moving hand follows it.
  all.add(
      "break_couple_spring", {.h = 0.01},
      [] {
        auto loop = breaking();
        auto& set = rigid_of(loop);
        const auto bob = set.add({.position = {1, 0, 0}, .mass = 1.0, .shape = Sphere{0.1}}),
                   hand = set.add({.position = {3, 0, 0}, .motion = Motion::kinematic}),
                   tool = set.add({.position = {3, 0, 0.1}, .mass = 0.3, .shape = Box{0.1, 0.1, 0.3}});
        loop.add(Breakable<BallJoint>::Item{{world_anchor({0, 0, 0}), anchor(set, bob, {-1, 0, 0})}, 22});
        loop.add(DistanceJoint::Item{.a = world_anchor({0, 0.5, 0}),
                                     .b = anchor(set, bob),
                                     .length = 1,
                                     .stiffness = 40,
                                     .damping = 0.5});
        loop.add(VirtualCoupling::Item{
            .a = anchor(set, tool), .b = anchor(set, hand), .stiffness = 300, .damping = 3});
        return loop;
      },
      [](auto& loop, int n) {
        auto& set = rigid_of(loop);
        set.move_to(set.handle(1), {3, 0.2 * std::sin(0.1 * n), 0.05 * n / 20},
                    exponential<double>({0, 0, 0.01 * n}));
      });
  all.add("held_twice_least_impulses", {.h = 0.01}, [] {
    auto loop = least();
    auto& set = rigid_of(loop);
    add_chain(loop, 2, 0, [&](const Anchor& a, const Anchor& b) {
      for (int k = 0; k < 2; ++k) loop.add(BallJoint::Item{a, b});
    });
    set.set_velocity(set.handle(1), {0, 1, 2}, {1, 0, 0});
    return loop;
  });
  all.add("soft_chain", {.h = 0.01}, [] {
    auto loop = soft();
    add_chain(loop, 3, 0, [&](const Anchor& a, const Anchor& b) { loop.add(BallJoint::Item{a, b}); });
    return loop;
  });
  all.add(
      "driven_arm", {.h = 0.01},
      [] {
        auto loop = driven();
        auto& set = rigid_of(loop);
        const Quat axis = frame_along({0, -1, 0});
        const auto arm = set.add({.position = {0.5, 0, 0}, .mass = 2.0, .shape = Box{1, 0.1, 0.1}});
        const Anchor a = world_anchor({0, 0, 0}, axis), b = anchor_at(set, arm, {0, 0, 0}, axis);
        loop.add(Hinge::Item{a, b});
        loop.add(
            Drive<Turn>::Item{.a = a, .b = b, .target = 1, .stiffness = 60, .damping = 4, .max_force = 14});
        return loop;
      },
      [](auto& loop, int n) {
        loop.item(loop.template constraint<Drive<Turn>>(0)).target = n < 100 ? 1 : -0.5;
      });
  return all.main(argc, argv);
}
