/// Sums and products of 3-vectors and 3 × 3 matrices, evaluated where they stand.
#pragma once

#include <Eigen/Core>

#include <concepts>
#include <type_traits>

namespace delassus {

// Eigen makes a type of every expression, and some eighty functions to compile for each. These operators are chosen over
// Eigen's when both sides are a plain Vec<3, T> or Mat<3, 3, T>, and they return one again: a program compiles a dozen
// small loops instead. Sums run from left to right, whatever the vector instructions. Everything else (blocks, other
// sizes, mixed scalars) stays with Eigen.

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
T row_times(T x, T y, T z, const T* column) {
  return x * column[0] + y * column[1] + z * column[2];
}

}  // namespace inner

template <class T, int C>
  requires(C == 1 || C == 3)
inner::Small<T, C> operator+(const Eigen::Matrix<T, 3, C>& a, const Eigen::Matrix<T, 3, C>& b) {
  inner::Small<T, C> c;
  for (int i = 0; i < 3 * C; ++i) c.data()[i] = a.data()[i] + b.data()[i];
  return c;
}

template <class T, int C>
  requires(C == 1 || C == 3)
inner::Small<T, C> operator-(const Eigen::Matrix<T, 3, C>& a, const Eigen::Matrix<T, 3, C>& b) {
  inner::Small<T, C> c;
  for (int i = 0; i < 3 * C; ++i) c.data()[i] = a.data()[i] - b.data()[i];
  return c;
}

template <class T, int C>
  requires(C == 1 || C == 3)
inner::Small<T, C> operator-(const Eigen::Matrix<T, 3, C>& a) {
  inner::Small<T, C> c;
  for (int i = 0; i < 3 * C; ++i) c.data()[i] = -a.data()[i];
  return c;
}

template <class T, int C, inner::ScalarOf<T> S>
  requires(C == 1 || C == 3)
inner::Small<T, C> operator*(const Eigen::Matrix<T, 3, C>& a, S s) {
  inner::Small<T, C> c;
  for (int i = 0; i < 3 * C; ++i) c.data()[i] = a.data()[i] * T(s);
  return c;
}

template <class T, int C, inner::ScalarOf<T> S>
  requires(C == 1 || C == 3)
inner::Small<T, C> operator*(S s, const Eigen::Matrix<T, 3, C>& a) {
  return a * s;
}

template <class T, int C, inner::ScalarOf<T> S>
  requires(C == 1 || C == 3)
inner::Small<T, C> operator/(const Eigen::Matrix<T, 3, C>& a, S s) {
  inner::Small<T, C> c;
  for (int i = 0; i < 3 * C; ++i) c.data()[i] = a.data()[i] / T(s);
  return c;
}

template <class T, int C>
  requires(C == 1 || C == 3)
Eigen::Matrix<T, 3, C>& operator+=(Eigen::Matrix<T, 3, C>& a, const Eigen::Matrix<T, 3, C>& b) {
  return a = a + b;
}

template <class T, int C>
  requires(C == 1 || C == 3)
Eigen::Matrix<T, 3, C>& operator-=(Eigen::Matrix<T, 3, C>& a, const Eigen::Matrix<T, 3, C>& b) {
  return a = a - b;
}

template <class T, int C, inner::ScalarOf<T> S>
  requires(C == 1 || C == 3)
Eigen::Matrix<T, 3, C>& operator*=(Eigen::Matrix<T, 3, C>& a, S s) {
  return a = a * s;
}

template <class T, int C, inner::ScalarOf<T> S>
  requires(C == 1 || C == 3)
Eigen::Matrix<T, 3, C>& operator/=(Eigen::Matrix<T, 3, C>& a, S s) {
  return a = a / s;
}

/// A X.
template <class T, int C>
  requires(C == 1 || C == 3)
inner::Small<T, C> operator*(const Eigen::Matrix<T, 3, 3>& A, const Eigen::Matrix<T, 3, C>& X) {
  inner::Small<T, C> Y;
  const T* a = A.data();
  for (int k = 0; k < C; ++k)
    for (int i = 0; i < 3; ++i) Y.data()[i + 3 * k] = inner::row_times(a[i], a[i + 3], a[i + 6], X.data() + 3 * k);
  return Y;
}

/// Aᵀ X.
template <class T, int C, inner::Square<T> M>
  requires(C == 1 || C == 3)
inner::Small<T, C> operator*(const Eigen::Transpose<M>& At, const Eigen::Matrix<T, 3, C>& X) {
  inner::Small<T, C> Y;
  const T* a = At.nestedExpression().data();
  for (int k = 0; k < C; ++k)
    for (int i = 0; i < 3; ++i)
      Y.data()[i + 3 * k] = inner::row_times(a[3 * i], a[3 * i + 1], a[3 * i + 2], X.data() + 3 * k);
  return Y;
}

/// A Bᵀ.
template <class T, inner::Square<T> M>
inner::Small<T, 3> operator*(const Eigen::Matrix<T, 3, 3>& A, const Eigen::Transpose<M>& Bt) {
  inner::Small<T, 3> Y;
  const T *a = A.data(), *b = Bt.nestedExpression().data();
  for (int k = 0; k < 3; ++k) {
    const T column[3] = {b[k], b[k + 3], b[k + 6]};
    for (int i = 0; i < 3; ++i) Y.data()[i + 3 * k] = inner::row_times(a[i], a[i + 3], a[i + 6], column);
  }
  return Y;
}

}  // namespace delassus
