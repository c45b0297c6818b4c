/// Scenes with joints, from which problems are taken: grips, arms, chains, ragdolls, conveyors, mixers,
/// presses, carts.
#pragma once

#include "contact_scenes.hpp"

#include <delassus/bodies/anchor_at.hpp>
#include <delassus/collision/native.hpp>
#include <delassus/collision/with_filter.hpp>
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/constraints/joints/hinge.hpp>
#include <delassus/constraints/joints/motor.hpp>
#include <delassus/constraints/joints/slider.hpp>
#include <delassus/loop/animation_loop.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

#include <functional>
#include <limits>

namespace problems {

/// A loop of machines: joints by one factorization, contacts swept on what they leave.
inline auto machine_loop(double friction) {
  return AnimationLoop{World{RigidBodies{}},
                       Constraints{Contact{Coulomb{.friction = friction}}, Hinge{}, BallJoint{}, Slider{},
                                   Motor<Turn>{}, Motor<Slide>{}},
                       WithFilter{NativeCollision{}}, DirectGaussSeidel{.tolerance = 1e-6}};
}
using MachineLoop = decltype(machine_loop(0));
using Body = RigidBodies::Handle;
/// What the scene does before the step at a time, s.
using Guide = std::function<void(double)>;

inline RigidBodies& bodies_of(MachineLoop& loop) { return bodies<RigidBodies>(loop.world()); }

/// A hinge about the world's y through `at`, and its motor.
inline void add_hinge(MachineLoop& loop, Body b, const Vec3& at, double speed, double most,
                      const Body* a = nullptr) {
  auto& set = bodies_of(loop);
  const Quat axis = frame_along({0, 1, 0});
  const Anchor end = a != nullptr ? anchor_at(set, *a, at, axis) : world_anchor(at, axis),
               other = anchor_at(set, b, at, axis);
  loop.add(Hinge::Item{end, other});
  if (most > 0) loop.add(Motor<Turn>::Item{.a = end, .b = other, .speed = speed, .max_force = most});
}

/// A slider from a to b along `direction`, and its motor.
inline void add_slider(MachineLoop& loop, const Anchor& a, Body b, const Vec3& at, const Vec3& direction,
                       double speed, double most) {
  const Anchor other = anchor_at(bodies_of(loop), b, at, frame_along(direction));
  loop.add(Slider::Item{a, other});
  loop.add(Motor<Slide>::Item{.a = a, .b = other, .speed = speed, .max_force = most});
}

/// Two fingers close on a row of `count` boxes and lift it.
inline Guide add_grip(MachineLoop& loop, int count, double force) {
  auto& set = bodies_of(loop);
  set.add_fixed(HalfSpace{});
  for (int k = 0; k < count; ++k)
    set.add(
        {.position = {0.101 * (k - 0.5 * (count - 1)), 0, 0.05}, .mass = 0.3, .shape = Box{0.1, 0.1, 0.1}});
  const Body hand = set.add({.position = {0, 0, 0.3}, .motion = Motion::kinematic});
  for (const double side : {-1., 1.}) {
    const Vec3 at(side * (0.051 * count + 0.03), 0, 0.055), inwards(-side, 0, 0);
    const Body finger = set.add({.position = at, .mass = 0.3, .shape = Box{0.03, 0.12, 0.08}});
    add_slider(loop, anchor_at(set, hand, at, frame_along(inwards)), finger, at, inwards, 0.15, force);
  }
  return [&set, hand](double time) {
    const double t = std::clamp(time - 0.5, 0., 1.);
    set.move_to(hand, {0, 0, 0.3 + 0.2 * t * t * (3 - 2 * t)});
  };
}

/// Two jaws close on a heap of balls.
inline Guide add_jaws(MachineLoop& loop, int count) {
  auto& set = bodies_of(loop);
  set.add_fixed(HalfSpace{});
  for (const double side : {-1., 1.}) {
    set.add_fixed(Box{3, 0.1, 1}, {0, 0.5 * side, 0.5});
    const Vec3 at(0.9 * side, 0, 0.26), inwards(-side, 0, 0);
    const Body jaw = set.add({.position = at, .mass = 4., .shape = Box{0.1, 0.85, 0.5}});
    add_slider(loop, world_anchor(at, frame_along(inwards)), jaw, at, inwards, 0.3, 150);
  }
  Dice dice(61);
  for (int i = 0; i < count; ++i)
    set.add(
        {.position = {0.19 * (i % 5 - 2) + dice(-0.02, 0.02), 0.19 * (i / 5 % 4 - 1.5), 0.1 + 0.2 * (i / 20)},
         .mass = 0.5,
         .shape = Sphere{dice(0.07, 0.09)}});
  return {};
}

/// An arm of four links that sweeps boxes off a table.
inline Guide add_arm(MachineLoop& loop, int count) {
  auto& set = bodies_of(loop);
  set.add_fixed(HalfSpace{});
  set.add_fixed(Box{2, 2, 0.5}, {1.6, 0, 0.25});
  const double length = 0.55;
  Vec3 at(-0.5, 0, 1.7);
  Body before;
  const double turn[] = {0.35, 0.5, 0.7, 0.6};
  for (int k = 0; k < 4; ++k) {
    const double pitch = turn[k] * (k + 1) * 0.5;
    const Quat q(Eigen::AngleAxisd(pitch, Vec3::UnitY()));
    const Vec3 along = q * Vec3(length, 0, 0);
    const Body link =
        set.add({.position = at + 0.5 * along,
                 .orientation = q,
                 .mass = 4. - k * 0.8,
                 .shape = k == 3 ? Shape(Box{length, 0.7, 0.06}) : Shape(Box{length, 0.1, 0.1})});
    add_hinge(loop, link, at, k == 0 ? 0.05 : 0.25 - 0.2 * k, 250 - 50 * k, k > 0 ? &before : nullptr);
    before = link;
    at += along;
  }
  Dice dice(67);
  for (int i = 0; i < count; ++i)
    set.add({.position = {0.9 + 0.28 * (i % 4), 0.28 * (i / 4 % 4 - 1.5), 0.61 + 0.21 * (i / 16)},
             .mass = 0.8,
             .shape = Box{dice(0.18, 0.22), dice(0.18, 0.22), 0.2}});
  return {};
}

/// Chains of links on ball joints that fall over a bar onto the ground.
inline Guide add_chains(MachineLoop& loop, int chains, int links) {
  auto& set = bodies_of(loop);
  set.add_fixed(HalfSpace{});
  set.add_fixed(Box{0.2, 6, 0.2}, {0, 0, 0.5});
  for (int c = 0; c < chains; ++c) {
    Body before;
    for (int k = 0; k < links; ++k) {
      const Vec3 at(0.16 * (k - 0.5 * links), 0.12 * (c - 0.5 * chains) + 0.1 * (c % 2), 0.75 + 0.09 * c);
      const Body link = set.add({.position = at, .density = 3000., .shape = Box{0.14, 0.06, 0.05}});
      if (k > 0)
        loop.add(BallJoint::Item{anchor(set, before, {0.08, 0, 0}), anchor(set, link, {-0.08, 0, 0})});
      before = link;
    }
  }
  return {};
}

/// Ragdolls of six parts that fall down a stair.
inline Guide add_ragdolls(MachineLoop& loop, int count) {
  auto& set = bodies_of(loop);
  for (int k = 0; k < 6; ++k) set.add_fixed(Box{0.4, 6, 0.2}, {0.4 * k, 0, -0.2 * k - 0.1});
  set.add_fixed(HalfSpace{}, {0, 0, -1.2});
  for (int doll = 0; doll < count; ++doll) {
    const Vec3 at(0.15 * (doll % 3), 0.5 * (doll % 2) - 0.2, 0.1 + 1.5 * (doll / 2));
    const Vec3 speed(1 - 0.2 * doll, 0, 0);
    const Body trunk = set.add(
        {.position = at + Vec3(0, 0, 1), .velocity = speed, .mass = 40., .shape = Box{0.2, 0.3, 0.6}});
    const auto limb = [&](const Vec3& joint, double width, double length,
                          double mass) {  // a length < 0 hangs down
      const Body part = set.add({.position = at + joint + Vec3(0, 0, length / 2),
                                 .velocity = speed,
                                 .mass = mass,
                                 .shape = Box{width, width, std::abs(length)}});
      loop.add(BallJoint::Item{anchor_at(set, trunk, at + joint), anchor_at(set, part, at + joint)});
    };
    limb({0, 0, 1.32}, 0.15, 0.25, 4);
    for (const double side : {-1., 1.}) {
      limb({0, 0.24 * side, 1.25}, 0.08, -0.6, 3);
      limb({0, 0.1 * side, 0.68}, 0.12, -0.6, 10);
    }
  }
  return {};
}

/// Driven rollers that carry crates to a stop.
inline Guide add_rollers(MachineLoop& loop, int rollers, int crates) {
  auto& set = bodies_of(loop);
  set.add_fixed(HalfSpace{}, {0, 0, -0.5});
  const Quat lying(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitX()));
  for (int k = 0; k < rollers; ++k) {
    const Vec3 at(0.25 * k, 0, 0);
    const Body roller =
        set.add({.position = at, .orientation = lying, .mass = 5., .shape = Cylinder{0.1, 1}});
    add_hinge(loop, roller, at, 6, 20);
  }
  set.add_fixed(Box{0.1, 1, 0.8}, {0.25 * rollers, 0, 0.3});
  for (int i = 0; i < crates; ++i)
    set.add({.position = {0.3 + 0.55 * (i / 2), 0.02 * (i % 2), 0.27 + 0.31 * (i % 2)},
             .mass = 8.,
             .shape = Box{0.5, 0.6, 0.3}});
  return {};
}

/// A paddle that turns in a bin of balls and stones.
inline Guide add_mixer(MachineLoop& loop, int count, double half) {
  auto& set = bodies_of(loop);
  add_bin(set, half);
  const Vec3 at(0, 0, 1.1 * half);
  for (const double pitch : {0., 0.5 * std::numbers::pi}) {
    const Quat q(Eigen::AngleAxisd(pitch, Vec3::UnitY()));
    const Body paddle = set.add({.position = at,
                                 .orientation = q,
                                 .mass = 12.,
                                 .shape = Box{1.5 * half, 1.5 * half, 0.08},
                                 .group = 2,
                                 .collides_with = 1});
    add_hinge(loop, paddle, at, 2.5, 200);
  }
  Dice dice(71);
  for (int i = 0; i < count; ++i) {
    const ConvexHull rock = stone(dice, 0.12);
    const double x = half * (i % 2 == 0 ? 0.5 : -0.5) + dice(-0.1, 0.1), y = 0.26 * (i / 2 % 4 - 1.5);
    set.add({.position = {x, y, 2.2 * half + 0.26 * (i / 8)},
             .orientation = dice.turn(),
             .density = 1200.,
             .shape = i % 3 == 0   ? Shape(rock)
                      : i % 3 == 1 ? Shape(Sphere{0.11})
                                   : Shape(Box{0.2, 0.16, 0.14})});
  }
  return {};
}

/// A bridge of hinged planks under crates.
inline Guide add_bridge(MachineLoop& loop, int planks, int crates) {
  auto& set = bodies_of(loop);
  set.add_fixed(HalfSpace{}, {0, 0, -2});
  const double length = 0.4;
  Body before;
  for (int k = 0; k < planks; ++k) {
    const Body plank = set.add(
        {.position = {length * (k + 0.5), 0, 0}, .mass = 15., .shape = Box{0.96 * length, 1.2, 0.08}});
    add_hinge(loop, plank, {length * k, 0, 0}, 0, 5, k > 0 ? &before : nullptr);
    before = plank;
  }
  add_hinge(loop, before, {length * planks, 0, 0}, 0, 5);
  for (int i = 0; i < crates; ++i)
    set.add({.position = {length * planks * (0.25 + 0.5 * (i / 2 + 0.5) / (0.5 * crates)),
                          0.42 * (i % 2 - 0.5), 0.3 + 0.1 * (i % 3)},
             .mass = 6.,
             .shape = Box{0.35, 0.35, 0.35}});
  return {};
}

/// A piston that presses boxes and balls in a bin.
inline Guide add_press(MachineLoop& loop, int count, double half) {
  auto& set = bodies_of(loop);
  add_bin(set, half);
  Dice dice(83);
  const int side = std::max(1, int(2 * half / 0.32));
  const int layers = (count + side * side - 1) / (side * side);
  for (int i = 0; i < count; ++i)
    set.add({.position = {0.32 * (i % side - 0.5 * (side - 1)), 0.32 * (i / side % side - 0.5 * (side - 1)),
                          0.2 + 0.3 * (i / side / side)},
             .orientation = dice.turn(),
             .density = 900.,
             .shape = i % 4 == 0 ? Shape(Sphere{0.12}) : Shape(Box{0.22, 0.18, 0.14})});
  const Vec3 at(0, 0, 0.5 + 0.3 * layers), down(0, 0, -1);
  const Body piston = set.add({.position = at, .mass = 20., .shape = Box{1.96 * half, 1.96 * half, 0.2}});
  add_slider(loop, world_anchor(at, frame_along(down)), piston, at, down, 0.4, 3000);
  return {};
}

/// A cart on driven wheels that carries boxes over sills.
inline Guide add_cart(MachineLoop& loop, int boxes) {
  auto& set = bodies_of(loop);
  set.add_fixed(HalfSpace{});
  for (int k = 0; k < 8; ++k) set.add_fixed(Box{0.12, 3, 0.06}, {1.4 + 0.75 * k, 0, 0});
  const Body deck = set.add({.position = {0, 0, 0.4}, .mass = 60., .shape = Box{2, 1.2, 0.1}});
  const Quat lying(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitX()));
  for (const double x : {-0.7, 0.7})
    for (const double y : {-0.75, 0.75}) {
      const Vec3 at(x, y, 0.25);
      const Body wheel =
          set.add({.position = at, .orientation = lying, .mass = 8., .shape = Cylinder{0.25, 0.12}});
      add_hinge(loop, wheel, at, 5, 40, &deck);
    }
  for (int i = 0; i < boxes; ++i)
    set.add({.position = {0.42 * (i % 4 - 1.5), 0.42 * (i / 4 % 2 - 0.5), 0.64 + 0.37 * (i / 8)},
             .mass = 4.,
             .shape = Box{0.36, 0.36, 0.36}});
  return {};
}

}  // namespace problems
