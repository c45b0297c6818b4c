// expect: -ffast-math, -Ofast and -ffinite-math-only hide numbers that are not finite from the library
// As the flag defines it.
#undef __FINITE_MATH_ONLY__
#define __FINITE_MATH_ONLY__ 1
#include <delassus/bodies/rigid_bodies.hpp>
