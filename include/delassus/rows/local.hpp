/// The problem one law meets when it is visited: its own rows, everything else held fixed.
#pragma once

#include <delassus/math/linear.hpp>

namespace delassus {

/// Of one item with R rows. Units are those of rows that are forces.
template <int R, class T = double>
struct Local {
  Mat<R, R, T> W;    ///< own block of the Delassus operator, 1/kg
  Vec<R, T> d;       ///< velocity of the rows with their bias, W λ of their own included, m/s
  Vec<R, T> lambda;  ///< the impulse, N·s, which the law replaces

  /// What the rows would do without this constraint: d − W λ.
  Vec<R, T> free_velocity() const { return d - W * lambda; }
};

}  // namespace delassus
