/// Sums and products of 3-vectors and 3 × 3 matrices, evaluated where they stand.
#pragma once

#include <Eigen/Core>

#include <concepts>
#include <type_traits>

namespace delassus {

// Eigen makes a type of every expression, and some eighty functions to compile for each. These operators are chosen over
// Eigen's when both sides are a plain Vec<3, T> or Mat<3, 3, T>, and they return one again: a program compiles a dozen
// small functions instead. Sums run from left to right, whatever the vector instructions. Everything else (blocks, other
// sizes, mixed scalars) stays with Eigen. Vectors are written out, since a loop over them would keep them in memory.

namespace inner {

/// 3 × C, a vector or a square matrix. Column-major, so that entry (i, k) is data()[i + 3 k].
template <class T, int C>
using Small = Eigen::Matrix<T, 3, C>;

/// What Eigen lets a matrix be scaled by: its own scalar or an integer.
template <class S, class T>
concept ScalarOf = std::same_as<S, T> || std::integral<S>;

template <class A, class T>
concept Square = std::same_as<std::remove_const_t<A>, Small<T, 3>>;

/// (x, y, z) · column.
template <class T>
inline T row_times(T x, T y, T z, const T* column) {
  return x * column[0] + y * column[1] + z * column[2];
}

}  // namespace inner

template <class T>
inline inner::Small<T, 1> operator+(const Eigen::Matrix<T, 3, 1>& a, const Eigen::Matrix<T, 3, 1>& b) {
  const T *x = a.data(), *y = b.data();
  return {x[0] + y[0], x[1] + y[1], x[2] + y[2]};
}
template <class T>
inline inner::Small<T, 3> operator+(const Eigen::Matrix<T, 3, 3>& a, const Eigen::Matrix<T, 3, 3>& b) {
  inner::Small<T, 3> c;
  for (int i = 0; i < 9; ++i) c.data()[i] = a.data()[i] + b.data()[i];
  return c;
}

template <class T>
inline inner::Small<T, 1> operator-(const Eigen::Matrix<T, 3, 1>& a, const Eigen::Matrix<T, 3, 1>& b) {
  const T *x = a.data(), *y = b.data();
  return {x[0] - y[0], x[1] - y[1], x[2] - y[2]};
}
template <class T>
inline inner::Small<T, 3> operator-(const Eigen::Matrix<T, 3, 3>& a, const Eigen::Matrix<T, 3, 3>& b) {
  inner::Small<T, 3> c;
  for (int i = 0; i < 9; ++i) c.data()[i] = a.data()[i] - b.data()[i];
  return c;
}

template <class T>
inline inner::Small<T, 1> operator-(const Eigen::Matrix<T, 3, 1>& a) {
  const T* x = a.data();
  return {-x[0], -x[1], -x[2]};
}
template <class T>
inline inner::Small<T, 3> operator-(const Eigen::Matrix<T, 3, 3>& a) {
  inner::Small<T, 3> c;
  for (int i = 0; i < 9; ++i) c.data()[i] = -a.data()[i];
  return c;
}

template <class T, inner::ScalarOf<T> S>
inline inner::Small<T, 1> operator*(const Eigen::Matrix<T, 3, 1>& a, S s) {
  const T* x = a.data();
  return {x[0] * T(s), x[1] * T(s), x[2] * T(s)};
}
template <class T, inner::ScalarOf<T> S>
inline inner::Small<T, 3> operator*(const Eigen::Matrix<T, 3, 3>& a, S s) {
  inner::Small<T, 3> c;
  for (int i = 0; i < 9; ++i) c.data()[i] = a.data()[i] * T(s);
  return c;
}

template <class T, int C, inner::ScalarOf<T> S>
  requires(C == 1 || C == 3)
inline inner::Small<T, C> operator*(S s, const Eigen::Matrix<T, 3, C>& a) {
  return a * s;
}

template <class T, inner::ScalarOf<T> S>
inline inner::Small<T, 1> operator/(const Eigen::Matrix<T, 3, 1>& a, S s) {
  const T* x = a.data();
  return {x[0] / T(s), x[1] / T(s), x[2] / T(s)};
}
template <class T, inner::ScalarOf<T> S>
inline inner::Small<T, 3> operator/(const Eigen::Matrix<T, 3, 3>& a, S s) {
  inner::Small<T, 3> c;
  for (int i = 0; i < 9; ++i) c.data()[i] = a.data()[i] / T(s);
  return c;
}

template <class T>
inline Eigen::Matrix<T, 3, 1>& operator+=(Eigen::Matrix<T, 3, 1>& a, const Eigen::Matrix<T, 3, 1>& b) {
  T* x = a.data();
  const T* y = b.data();
  x[0] += y[0], x[1] += y[1], x[2] += y[2];
  return a;
}
template <class T>
inline Eigen::Matrix<T, 3, 3>& operator+=(Eigen::Matrix<T, 3, 3>& a, const Eigen::Matrix<T, 3, 3>& b) {
  for (int i = 0; i < 9; ++i) a.data()[i] += b.data()[i];
  return a;
}

template <class T>
inline Eigen::Matrix<T, 3, 1>& operator-=(Eigen::Matrix<T, 3, 1>& a, const Eigen::Matrix<T, 3, 1>& b) {
  T* x = a.data();
  const T* y = b.data();
  x[0] -= y[0], x[1] -= y[1], x[2] -= y[2];
  return a;
}

template <class T, inner::ScalarOf<T> S>
inline Eigen::Matrix<T, 3, 1>& operator*=(Eigen::Matrix<T, 3, 1>& a, S s) {
  T* x = a.data();
  x[0] *= T(s), x[1] *= T(s), x[2] *= T(s);
  return a;
}
template <class T, inner::ScalarOf<T> S>
inline Eigen::Matrix<T, 3, 3>& operator*=(Eigen::Matrix<T, 3, 3>& a, S s) {
  for (int i = 0; i < 9; ++i) a.data()[i] *= T(s);
  return a;
}

template <class T, inner::ScalarOf<T> S>
inline Eigen::Matrix<T, 3, 1>& operator/=(Eigen::Matrix<T, 3, 1>& a, S s) {
  T* x = a.data();
  x[0] /= T(s), x[1] /= T(s), x[2] /= T(s);
  return a;
}

/// A x and A B.
template <class T>
[[gnu::always_inline]] inline inner::Small<T, 1> operator*(const Eigen::Matrix<T, 3, 3>& A,
                                                           const Eigen::Matrix<T, 3, 1>& x) {
  const T *a = A.data(), *b = x.data();
  return {inner::row_times(a[0], a[3], a[6], b), inner::row_times(a[1], a[4], a[7], b),
          inner::row_times(a[2], a[5], a[8], b)};
}
template <class T>
inline inner::Small<T, 3> operator*(const Eigen::Matrix<T, 3, 3>& A, const Eigen::Matrix<T, 3, 3>& B) {
  inner::Small<T, 3> Y;
  const T* a = A.data();
  for (int k = 0; k < 9; k += 3)
    for (int i = 0; i < 3; ++i) Y.data()[i + k] = inner::row_times(a[i], a[i + 3], a[i + 6], B.data() + k);
  return Y;
}

/// Aᵀ x and Aᵀ B.
template <class T, inner::Square<T> M>
inline inner::Small<T, 1> operator*(const Eigen::Transpose<M>& At, const Eigen::Matrix<T, 3, 1>& x) {
  const T *a = At.nestedExpression().data(), *b = x.data();
  return {inner::row_times(a[0], a[1], a[2], b), inner::row_times(a[3], a[4], a[5], b),
          inner::row_times(a[6], a[7], a[8], b)};
}
template <class T, inner::Square<T> M>
inline inner::Small<T, 3> operator*(const Eigen::Transpose<M>& At, const Eigen::Matrix<T, 3, 3>& B) {
  inner::Small<T, 3> Y;
  const T* a = At.nestedExpression().data();
  for (int k = 0; k < 9; k += 3)
    for (int i = 0; i < 3; ++i)
      Y.data()[i + k] = inner::row_times(a[3 * i], a[3 * i + 1], a[3 * i + 2], B.data() + k);
  return Y;
}

/// A Bᵀ.
template <class T, inner::Square<T> M>
inline inner::Small<T, 3> operator*(const Eigen::Matrix<T, 3, 3>& A, const Eigen::Transpose<M>& Bt) {
  inner::Small<T, 3> Y;
  const T *a = A.data(), *b = Bt.nestedExpression().data();
  for (int k = 0; k < 3; ++k) {
    const T column[3] = {b[k], b[k + 3], b[k + 6]};
    for (int i = 0; i < 3; ++i) Y.data()[i + 3 * k] = inner::row_times(a[i], a[i + 3], a[i + 6], column);
  }
  return Y;
}

}  // namespace delassus
