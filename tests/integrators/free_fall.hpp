/// A body dropped from rest at the origin, as a particle and as a rigid body that turns.
#pragma once

#include <delassus/delassus.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace free_fall {

using namespace delassus;

inline constexpr double g = 9.81;

/// The largest |y(n h) − expected(n)| over |expected| of a second's fall, of both kinds of body.
template <class Integrator, class Expected>
double worst_error(Integrator integrator, int steps, const Expected& expected) {
  AnimationLoop loop{World{RigidBodies{}, Particles{}}, std::move(integrator)};
  auto& rigid = bodies<RigidBodies>(loop.world());
  auto& points = bodies<Particles>(loop.world());
  const auto box = rigid.add({.angular_velocity = {1, 2, 3}, .mass = 2.0, .shape = Box{1, 2, 3}});
  const auto point = points.add({.mass = 3.0});
  double worst = 0;
  for (int n = 1; n <= steps; ++n) {
    loop.step(1.0 / steps);
    const double y = expected(n);
    for (const double z : {rigid.position(box).z(), points.position(point).z()})
      worst = std::max(worst, std::abs(z - y) / std::abs(y));
  }
  return worst;
}

}  // namespace free_fall
