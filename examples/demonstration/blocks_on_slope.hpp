/// The blocks of the demonstration that slip or stay by their friction.
#pragma once

#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/bodies/world.hpp>

#include <array>
#include <numbers>

namespace demonstration {

/// Five blocks of ten kilograms on a slope that ends on a floor.
struct BlocksOnSlope {
  static constexpr double angle = 20 * std::numbers::pi / 180;
  static constexpr std::array frictions{0.1, 0.2, 0.3, 0.4, 0.5};  // tan 20° = 0.364
  static constexpr std::size_t first = 2;  // the blocks come after the two half-spaces

  delassus::Quat tilt{Eigen::AngleAxisd(angle, delassus::Vec3::UnitY())};
  delassus::Vec3 down = tilt * delassus::Vec3::UnitX(), normal = tilt * delassus::Vec3::UnitZ();

  /// Where the middle of a block is at the start, m.
  delassus::Vec3 start(std::size_t k) const {
    return 0.2 * normal + 0.9 * (double(k) - 2) * delassus::Vec3::UnitY();
  }

  template <class Loop>
  void add_to(Loop& loop) const {
    using namespace delassus;
    auto& rigid = bodies<RigidBodies>(loop.world());
    const Index ground = loop.materials().add({.friction = 0.5});
    rigid.add({.shape = HalfSpace{normal}, .motion = Motion::fixed, .material = ground});
    const Index floor = loop.materials().add({.friction = 0.6});
    rigid.add({.shape = HalfSpace{Vec3::UnitZ(), -1.6}, .motion = Motion::fixed, .material = floor});
    for (std::size_t k = 0; k < frictions.size(); ++k) {
      const Index material = loop.materials().add({.friction = frictions[k]});
      loop.materials().set_pair(ground, material, {.friction = frictions[k]});
      loop.materials().set_pair(floor, material, {.friction = 0.6});
      rigid.add({.position = start(k),
                 .orientation = tilt,
                 .mass = 10,
                 .shape = Box{0.6, 0.6, 0.4},
                 .material = material});
    }
  }
};

}  // namespace demonstration
