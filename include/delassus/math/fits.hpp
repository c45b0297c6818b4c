/// Whether numbers in double fit the scalar a set of bodies keeps them in, and the words for those that do
/// not.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/math/linear.hpp>

#include <limits>
#include <string>

namespace delassus::inner {

/// False for what is not finite, too.
template <class T>
bool fits(const Vec3& x) {
  constexpr double most = double(std::numeric_limits<T>::max());
  return std::abs(x[0]) <= most && std::abs(x[1]) <= most && std::abs(x[2]) <= most;
}

/// x and 1/x are normal numbers of T.
template <class T>
bool has_inverse(double x) {
  constexpr double least = double(std::numeric_limits<T>::min());
  return x >= least && x <= 1 / least;
}

inline std::string text(const Vec3& x) {
  return std::string("(") + text(x[0]) + ", " + text(x[1]) + ", " + text(x[2]) + ")";
}

/// `(1e+300, 0, 0) m is beyond 3.40282e+38, …`, after the name of what was given.
template <class T>
std::string beyond(const Vec3& x, const char* unit) {
  return text(x) + " " + unit + " is beyond " + text(double(std::numeric_limits<T>::max())) +
         ", the largest number that this set of bodies holds";
}

/// `1e-50 kg lies outside [1.17549e-38, 8.50706e+37], …`.
template <class T>
std::string without_inverse(const std::string& x, const char* unit) {
  constexpr double least = double(std::numeric_limits<T>::min());
  return x + " " + unit + " lies outside [" + text(least) + ", " + text(1 / least) +
         "], where this set of bodies holds a number and its inverse";
}

}  // namespace delassus::inner
