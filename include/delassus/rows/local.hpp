/// The problem one law meets when it is visited: its own rows, everything else held fixed.
#pragma once

#include <delassus/math/linear.hpp>

namespace delassus {

/// W: own block of the Delassus operator, 1/kg. d: velocity of the rows plus their bias at the present impulse,
/// its own share W λ included, m/s. lambda: the impulse, N·s, which the law replaces.
template <int R, class T = double>
struct Local {
  Mat<R, R, T> W;
  Vec<R, T> d;
  Vec<R, T> lambda;

  /// What the rows would do without this constraint: d − W λ.
  Vec<R, T> free_velocity() const { return d - W * lambda; }
};

}  // namespace delassus
