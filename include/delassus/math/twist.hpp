/// The two halves of a rigid body's velocity, momentum or load: (linear, angular).
#pragma once

#include <delassus/math/linear.hpp>

namespace delassus {

/// Of a point's velocity too, which has no other half.
template <int N, class T>
inline Vec<3, T> linear_part(const Eigen::Matrix<T, N, 1>& v) {
  static_assert(N == 3 || N == 6);
  return {v.data()[0], v.data()[1], v.data()[2]};
}

template <class T>
inline Vec<3, T> angular_part(const Eigen::Matrix<T, 6, 1>& v) {
  return {v.data()[3], v.data()[4], v.data()[5]};
}

template <class T>
inline Vec<6, T> twist(const Vec<3, T>& linear, const Vec<3, T>& angular) {
  Vec<6, T> both;
  T* e = both.data();
  e[0] = linear[0], e[1] = linear[1], e[2] = linear[2];
  e[3] = angular[0], e[4] = angular[1], e[5] = angular[2];
  return both;
}

}  // namespace delassus
