/// Which stiffness and damping a row can have.
#pragma once

#include <delassus/core/expect.hpp>

namespace delassus::inner {

/// What is asked of a stiffness or damping: 0, or a size at which the compliance 1/(h² k + h c) of the row and its bias
/// are numbers in single precision too, for every step from 1e-6 s to 1e6 s. Beyond that a spring is none, or rigid.
inline bool is_soft_number(double x) { return x == 0 || (x >= 1e-20 && x <= 1e20); }

/// Whether a row of this stiffness and damping is a spring. One that is no number makes a spring without a finite impulse,
/// which a step reports; it does not make the row rigid.
template <class T>
constexpr bool is_spring(T stiffness, T damping) {
  return !(stiffness <= 0 && damping <= 0);
}

/// Refuses `value`, in a sentence that begins with `what` and ends with the rule.
inline void check_soft_number(double value, const char* what, const char* unit) {
  expect_number(is_soft_number(value), what, value, "must be 0 or lie in [1e-20, 1e20]", unit);
}

}  // namespace delassus::inner
