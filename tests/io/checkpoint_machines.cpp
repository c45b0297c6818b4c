/// The mechanisms of examples/, stopped and taken up again. The scenes are those of the programs of the same names.
#include <delassus/solvers/direct_gauss_seidel.hpp>
#include <delassus/steppers/newton_midpoint.hpp>

#include "same_bits.hpp"

using namespace scenes;

TEST_CASE("restored, examples/crane goes on bit for bit, driven") {
  require_same_bits(4e-3, [] {
    return AnimationLoop{World{RigidBodies{}}, Constraints{Hinge{}, Drive<Turn>{}, Limit<Turn>{}, DistanceJoint{}},
                         DirectGaussSeidel{.tolerance = 1e-8}};
  }, [](auto& loop) {
    auto& rigid = rigid_bodies(loop);
    const auto jib = rigid.add({.position = {2, 0, 5}, .mass = 200.0, .shape = Box{4, 0.3, 0.3}});
    const auto hook = rigid.add({.position = {4, 0, 3}, .mass = 1.0, .shape = Sphere{0.1}});
    const auto load = rigid.add({.position = {4, 0, 2}, .mass = 1000.0, .shape = Box{0.8, 0.8, 0.8}});
    const Quat axis = frame_along({0, -1, 0});
    const Anchor mast = world_anchor({0, 0, 5}, axis), foot = anchor_at(rigid, jib, {0, 0, 5}, axis);
    loop.add(Hinge::Item{mast, foot});
    loop.add(Drive<Turn>::Item{.a = mast, .b = foot, .stiffness = 4e6, .damping = 4e5, .max_force = 60e3});
    loop.add(Limit<Turn>::Item{.a = mast, .b = foot, .lower = -0.2, .upper = 1.2});
    loop.add(DistanceJoint::Item{.a = anchor(rigid, jib, {2, 0, 0}), .b = anchor(rigid, hook), .length = 2});
    loop.add(DistanceJoint::Item{.a = anchor(rigid, hook), .b = anchor(rigid, load), .length = 1});
  }, [](auto& loop, int n) {
    auto& luff = loop.item(loop.template constraint<Drive<Turn>>(0));
    luff.target = 0.8 * std::min(n, 2500) / 2500;
    luff.speed = n < 2500 ? 0.08 : 0;
  });
}

TEST_CASE("restored, examples/slider_crank goes on bit for bit") {
  require_same_bits(1e-3, [] {
    return AnimationLoop{World{RigidBodies{}}, Constraints{Hinge{}, BallJoint{}, Cylindrical{}, Motor<Turn>{}},
                         AcceleratedGaussSeidel{.tolerance = 1e-8}};
  }, [](auto& loop) {
    auto& rigid = rigid_bodies(loop);
    const double r = 0.2, l = 0.6;
    const auto crank = rigid.add({.position = {r / 2, 0, 0}, .mass = 1.0, .shape = Box{r, 0.05, 0.05}});
    const auto rod = rigid.add({.position = {r + l / 2, 0, 0}, .mass = 0.5, .shape = Box{l, 0.03, 0.03}});
    const auto piston = rigid.add({.position = {r + l, 0, 0}, .mass = 0.8, .shape = Box{0.1, 0.1, 0.1}});
    const Quat along_x = frame_along({1, 0, 0});
    const Anchor bearing = world_anchor({0, 0, 0}), shaft = anchor_at(rigid, crank, {0, 0, 0});
    loop.add(Hinge::Item{bearing, shaft});
    loop.add(Hinge::Item{anchor_at(rigid, crank, {r, 0, 0}), anchor_at(rigid, rod, {r, 0, 0})});
    loop.add(BallJoint::Item{anchor_at(rigid, rod, {r + l, 0, 0}), anchor(rigid, piston)});
    loop.add(Cylindrical::Item{world_anchor({0, 0, 0}, along_x), anchor_at(rigid, piston, {r + l, 0, 0}, along_x)});
    loop.add(Motor<Turn>::Item{.a = bearing, .b = shaft, .speed = 6.2832, .max_force = 40});
  });
}

TEST_CASE("restored, examples/gyroscope goes on bit for bit") {
  require_same_bits(2.5e-3, [] {
    return AnimationLoop{World{RigidBodies{}}, Constraints{BallJoint{}}, NewtonMidpoint{}};
  }, [](auto& loop) {
    auto& rigid = rigid_bodies(loop);
    const auto wheel = rigid.add({.position = {0.2, 0, 0},
                                  .velocity = {0, 0.175, 0},
                                  .angular_velocity = {50, 0, 0.87},
                                  .mass = 1.0,
                                  .inertia = Mat3(Vec3(0.045, 0.0225, 0.0225).asDiagonal())});
    loop.add(BallJoint::Item{anchor(rigid, wheel, {-0.2, 0, 0}), world_anchor({0, 0, 0})});
  });
}

TEST_CASE("restored, examples/heavy_chain goes on bit for bit") {
  require_same_bits(1.0 / 60, [] {
    return AnimationLoop{World{RigidBodies{}}, Constraints{BallJoint{}}, NewtonMidpoint{}};
  }, [](auto& loop) {
    auto& rigid = rigid_bodies(loop);
    const double length = 0.2, angle = 0.35;
    const Vec3 way(std::sin(angle), 0, -std::cos(angle));
    Anchor end = world_anchor({0, 0, 0});
    for (int k = 0; k < 100; ++k) {
      const auto link = rigid.add({.position = (k + 0.5) * length * way,
                                   .orientation = frame_along(-way),
                                   .mass = k == 99 ? 1000.0 : 1.0,
                                   .shape = Box{0.02, 0.02, length}});
      loop.add(BallJoint::Item{end, anchor(rigid, link, {0, 0, length / 2})});
      end = anchor(rigid, link, {0, 0, -length / 2});
    }
  });
}
