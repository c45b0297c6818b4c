/// The two halves of a rigid body's velocity, momentum or load: (linear, angular).
#pragma once

#include <delassus/math/linear.hpp>

namespace delassus {

/// Of a point's velocity too, which has no other half.
template <int N, class T>
Vec<3, T> linear_part(const Eigen::Matrix<T, N, 1>& v) {
  static_assert(N == 3 || N == 6);
  return {v.data()[0], v.data()[1], v.data()[2]};
}

template <class T>
Vec<3, T> angular_part(const Eigen::Matrix<T, 6, 1>& v) {
  return {v.data()[3], v.data()[4], v.data()[5]};
}

template <class T>
Vec<6, T> twist(const Vec<3, T>& linear, const Vec<3, T>& angular) {
  Vec<6, T> both;
  for (int k = 0; k < 3; ++k) both.data()[k] = linear[k], both.data()[k + 3] = angular[k];
  return both;
}

}  // namespace delassus
