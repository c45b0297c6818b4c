/// Which mean of the velocities of a step moves the bodies.
#pragma once

#include <type_traits>

namespace delassus {

/// The share θ of the new velocity in the mean that moves q; bilateral rows hold for that mean. A static constant of
/// the integrator: one that whoever makes the loop chooses is its own affair.
template <class I>
constexpr double theta() {
  return 1;
}
template <class I>
  requires requires { std::bool_constant<(I::theta > 0)>{}; }
constexpr double theta() {
  return I::theta;
}

}  // namespace delassus
