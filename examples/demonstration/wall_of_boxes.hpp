/// The wall of the demonstration, and the ball that hits it.
#pragma once

#include <delassus/bodies/rigid_bodies.hpp>

#include <vector>

namespace demonstration {

constexpr double wall_depth = 0.2;  // m

/// A hundred boxes in running bond on the ground, row by row from below, then a ball of 1.4 t that flies at
/// them. Returns the boxes.
inline std::vector<delassus::RigidBodies::Handle> add_wall_of_boxes(delassus::RigidBodies& rigid) {
  using namespace delassus;
  rigid.add_fixed(HalfSpace{});
  const double length = 0.4, height = 0.2;
  std::vector<RigidBodies::Handle> boxes;
  for (int row = 0; row < 10; ++row)
    for (int k = 0; k < 10; ++k)
      boxes.push_back(rigid.add({.position = {0, length * (k - 4.75 + 0.5 * (row % 2)), height * (row + 0.5)},
                                 .density = 2000,
                                 .shape = Box{wall_depth, length, height}}));
  rigid.add({.position = {-2.5, 0, 1.0}, .velocity = {8, 0, 0.5}, .density = 7800, .shape = Sphere{0.35}});
  return boxes;
}

}  // namespace demonstration
