/// The names under which the library uses Eigen's fixed-size types.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>

namespace delassus {

template <int N, class T = double>
using Vec = Eigen::Matrix<T, N, 1>;

template <int R, int C, class T = double>
using Mat = Eigen::Matrix<T, R, C>;

using Vec3 = Vec<3>;
using Mat3 = Mat<3, 3>;
using Quat = Eigen::Quaternion<double>;

/// The matrix of the cross product: skew(a) b = a × b.
template <class Derived>
Mat<3, 3, typename Derived::Scalar> skew(const Eigen::MatrixBase<Derived>& a) {
  using T = typename Derived::Scalar;
  Mat<3, 3, T> m;
  m << T(0), -a[2], a[1], a[2], T(0), -a[0], -a[1], a[0], T(0);
  return m;
}

/// True when every entry is finite: 0·x is 0 for finite x and NaN otherwise, so one sum decides.
template <class Derived>
bool is_finite(const Eigen::MatrixBase<Derived>& x) {
  using T = typename Derived::Scalar;
  return (x * T(0)).sum() == T(0);
}

}  // namespace delassus
