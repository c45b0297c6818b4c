/// How the surface of a body moves, for friction.
#pragma once

#include <delassus/math/linear.hpp>

namespace delassus {

/// World axes; at the start of the step, and of a body that is led for this step.
struct SurfaceMotion {
  Vec3 centre = zero<Vec3>();    ///< of mass, m
  Vec3 velocity = zero<Vec3>();  ///< of the centre, m/s
  Vec3 turn = zero<Vec3>();      ///< rad/s
  Vec3 running = zero<Vec3>();   ///< of the surface beside the body, m/s at the point that was asked for
  Vec3 running_turn = zero<Vec3>();  ///< of the surface beside the body, rad/s
  bool is_led = false;           ///< nothing pushes it: kinematic or fixed
  bool is_rigid = false;         ///< its body turns as one, and the numbers above are known
};

}  // namespace delassus
