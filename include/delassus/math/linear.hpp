/// The names under which the library uses Eigen's fixed-size types.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/math/eager.hpp>
#include <delassus/math/eigen.hpp>

namespace delassus {

template <int N, class T = double>
using Vec = Eigen::Matrix<T, N, 1>;

template <int R, int C, class T = double>
using Mat = Eigen::Matrix<T, R, C>;

using Vec3 = Vec<3>;
using Mat3 = Mat<3, 3>;
using Quat = Eigen::Quaternion<double>;

namespace inner {

template <class T>
struct double_in {
  using type = double;
};

}  // namespace inner

/// A double that is not known before T is: what a template writes with it costs who uses the template, and not who reads it.
template <class T>
using DoubleIn = typename inner::double_in<T>::type;

/// to = from.
template <class T>
[[gnu::always_inline]] inline void assign(Eigen::Quaternion<T>& to, const Eigen::Quaternion<T>& from) {
  assign(to.coeffs(), from.coeffs());
}

/// The same numbers as another scalar, without an expression's types where there is nothing to convert.
template <class To, class T, int R, int C>
[[gnu::always_inline]] inline Mat<R, C, To> converted(const Eigen::Matrix<T, R, C>& x) {
  Mat<R, C, To> y;
  DELASSUS_UNROLL
  for (int k = 0; k < R * C; ++k) y.data()[k] = To(x.data()[k]);
  return y;
}
template <class To, class T>
[[gnu::always_inline]] inline Eigen::Quaternion<To> converted(const Eigen::Quaternion<T>& q) {
  return {To(q.w()), To(q.x()), To(q.y()), To(q.z())};
}

/// The k-th axis.
template <class T = double>
Vec<3, T> unit_axis(int k) {
  return {T(k == 0), T(k == 1), T(k == 2)};
}

/// The matrix with these columns.
template <class T>
inline Mat<3, 3, T> columns(const Vec<3, T>& x, const Vec<3, T>& y, const Vec<3, T>& z) {
  Mat<3, 3, T> m;
  T* e = m.data();
  e[0] = x[0], e[1] = x[1], e[2] = x[2];
  e[3] = y[0], e[4] = y[1], e[5] = y[2];
  e[6] = z[0], e[7] = z[1], e[8] = z[2];
  return m;
}

/// Which entry is the largest in size; the first of equals.
template <class T>
int largest_entry(const Vec<3, T>& a) {
  int k = std::abs(a[1]) > std::abs(a[0]) ? 1 : 0;
  return std::abs(a[2]) > std::abs(a[k]) ? 2 : k;
}

/// A unit vector across n.
template <class T>
inline Vec<3, T> unit_across(const Vec<3, T>& n) {
  const T little = T(1e-12) * std::abs(n[2]);
  if (std::abs(n[0]) > little || std::abs(n[1]) > little) {
    const T over = T(1) / std::sqrt(n[0] * n[0] + n[1] * n[1]);
    return {-n[1] * over, n[0] * over, 0};
  }
  const T over = T(1) / std::sqrt(n[1] * n[1] + n[2] * n[2]);
  return {0, -n[2] * over, n[1] * over};
}

/// The matrix of the cross product: skew(a) b = a × b.
template <class T>
inline Mat<3, 3, T> skew(const Vec<3, T>& a) {
  return columns<T>({0, a[2], -a[1]}, {-a[2], 0, a[0]}, {a[1], -a[0], 0});
}

/// A⁻¹ = adj(A) / det A. Pre: A is regular.
template <class T>
inline Mat<3, 3, T> inverse(const Mat<3, 3, T>& A) {
  const Vec<3, T> x(A(0, 0), A(1, 0), A(2, 0)), y(A(0, 1), A(1, 1), A(2, 1)), z(A(0, 2), A(1, 2), A(2, 2));
  const Vec<3, T> yz = cross(y, z), zx = cross(z, x), xy = cross(x, y);  // the rows of adj(A)
  return T(1) / dot(x, yz) * columns<T>({yz[0], zx[0], xy[0]}, {yz[1], zx[1], xy[1]}, {yz[2], zx[2], xy[2]});
}

/// Adds to the diagonal.
template <class T, int R>
inline void add_diagonal(Mat<R, R, T>& A, T value) {
  for (int k = 0; k < R; ++k) A(k, k) += value;
}

template <class T, int R>
inline T trace(const Mat<R, R, T>& A) {
  T sum = A(0, 0);
  for (int k = 1; k < R; ++k) sum += A(k, k);
  return sum;
}

/// True when every entry is zero, in fewer instructions than Eigen's isZero(0).
template <class T, int R, int C>
inline bool is_zero(const Eigen::Matrix<T, R, C>& x) {
  for (int k = 0; k < R * C; ++k)
    if (x.data()[k] != T(0)) return false;
  return true;
}

/// True when every entry is finite: 0·x is 0 for finite x and NaN otherwise, so one sum decides.
template <class T, int R, int C>
inline bool is_finite(const Eigen::Matrix<T, R, C>& x) {
  T sum = x.data()[0] * T(0);
  for (int k = 1; k < R * C; ++k) sum += x.data()[k] * T(0);
  return sum == T(0);
}

}  // namespace delassus
