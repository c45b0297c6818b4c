/// What a joint did to its first end in the last step, as a force and a moment.
#pragma once

#include <delassus/math/linear.hpp>

namespace delassus {

/// What end a received, as a mean over the step; b has the opposite of both.
struct Reaction {
  Vec3 force = zero<Vec3>();   ///< N
  Vec3 moment = zero<Vec3>();  ///< about the joint's point, x_b
};

namespace inner {

/// Law::acts says for each row which of (F_x, F_y, F_z, M_x, M_y, M_z) it is.
template <class Law>
Reaction reaction(const Vec<Law::rows>& lambda, double h) {
  Reaction out;
  for (int k = 0; k < Law::rows; ++k)
    (Law::acts[k] < 3 ? out.force : out.moment)[Law::acts[k] % 3] = lambda[k] / h;
  return out;
}

}  // namespace inner

/// The reaction of a joint in the axes of its frame on a, as they were where the step took its rows. That of a
/// `BallJoint` is in the axes of the world. The moment z of a `Universal` is that about a_x × b_y.
template <class Loop, class Handle>
Reaction reaction(const Loop& loop, Handle joint) {
  return inner::reaction<typename Handle::Law>(loop.impulse(joint), loop.step_size());
}

}  // namespace delassus
