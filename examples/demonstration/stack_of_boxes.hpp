/// The stack that two parts of the demonstration share.
#pragma once

#include <delassus/bodies/rigid_bodies.hpp>

#include <cmath>

namespace demonstration {

/// Ten boxes of one metre and one kilogram on the ground, touching, each up to 4 cm off centre. Returns the top one.
inline delassus::RigidBodies::Handle add_stack_of_boxes(delassus::RigidBodies& rigid) {
  using namespace delassus;
  rigid.add_fixed(HalfSpace{});
  RigidBodies::Handle top;
  for (int k = 0; k < 10; ++k) {
    const Vec3 off(0.04 * std::sin(2.0 * k), 0.04 * std::sin(3.1 * k), 0);
    top = rigid.add({.position = Vec3(0, 0, 0.5 + k) + off, .mass = 1.0, .shape = Box{1, 1, 1}});
  }
  return top;
}

}  // namespace demonstration
