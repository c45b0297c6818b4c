/// Boxes on a slope, which slide or stay by their friction: worlds of an ensemble.
#pragma once

#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/io/state_hash.hpp>
#include <delassus/loop/animation_loop.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace slides {

using namespace delassus;

/// Three unit boxes, one on the other and each a little turned, on a slope of tan 0.3.
inline auto make_slide(double friction) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = friction}}}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const double angle = std::atan(0.3);
  rigid.gravity = 9.81 * Vec3(std::sin(angle), 0, -std::cos(angle));
  rigid.add_fixed(HalfSpace{});
  for (int i = 0; i < 3; ++i)
    rigid.add({.position = {0, 0.02 * i, 0.501 + 1.001 * i}, .angular_velocity = {0, 0, 0.2 * i}, .mass = 1.0 + i, .shape = Box{1, 1, 1}});
  return loop;
}
using Loop = decltype(make_slide(0));

/// Places along the slope of the lowest box and of the highest, m.
inline std::array<double, 2> places(const Loop& loop) {
  const auto& rigid = bodies<RigidBodies>(loop.world());
  return {rigid.position(rigid.handle(1)).x(), rigid.position(rigid.handle(3)).x()};
}

inline const std::vector<double> frictions{0.1, 0.2, 0.25, 0.3, 0.35, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9};

/// `state_hash` of each after so many steps in a plain loop.
inline std::vector<std::uint64_t> hashes_alone(int steps, double h) {
  std::vector<std::uint64_t> hashes;
  for (const double friction : frictions) {
    auto loop = make_slide(friction);
    for (int n = 0; n < steps; ++n) loop.step(h);
    hashes.push_back(state_hash(loop));
  }
  return hashes;
}

}  // namespace slides
