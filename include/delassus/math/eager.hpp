/// Sums and products of small matrices of fixed size, evaluated where they stand.
#pragma once

#include <delassus/core/cmath.hpp>

#include <Eigen/Core>

#include <concepts>
#include <type_traits>

namespace delassus {

// Eigen makes a type of every expression, and some eighty functions to compile for each. These operators are chosen over
// Eigen's when both sides are plain matrices of fixed size with at most six rows and columns, and they return one again: a
// program compiles one small function for each size instead. Sums run from left to right, whatever the vector instructions.
// Everything else (blocks, larger and dynamic sizes, mixed scalars) stays with Eigen. Sums and multiples of 3-vectors are
// written out, since a loop over them would keep them in memory.

// Of a trip count that is a constant: at -O2 g++ would leave such a loop as it is.
#if defined(__clang__)
#define DELASSUS_UNROLL _Pragma("unroll")
#elif defined(__GNUC__)
#define DELASSUS_UNROLL _Pragma("GCC unroll 36")
#else
#define DELASSUS_UNROLL
#endif

namespace inner {

template <int... sizes>
concept SmallSizes = ((sizes > 0 && sizes <= 6) && ...);

/// With its options by name: left out they follow from R and C, and g++ would convert a matrix stored by rows to fit.
template <class T, int R, int C, int O>
using Fixed = Eigen::Matrix<T, R, C, O, R, C>;

/// Entry (i, k) of R rows is data()[i + R k].
template <int R, int O>
concept ByColumns = R == 1 || !(O & Eigen::RowMajor);

/// What Eigen lets a matrix be scaled by: its own scalar or an integer.
template <class S, class T>
concept ScalarOf = std::same_as<S, T> || std::integral<S>;

/// R × K, and R or K as a name that is not yet known.
template <class M, class T, int R, int K>
concept Plain = std::same_as<std::remove_const_t<M>, Eigen::Matrix<T, R, K>> && SmallSizes<R, K>;

/// Y = A B. Column-major, so that entry (i, k) of an R × K matrix is data()[i + R k].
template <int R, int K, int C, class T>
[[gnu::always_inline]] inline void set_product(const T* A, const T* B, T* Y) {
  DELASSUS_UNROLL
  for (int c = 0; c < C; ++c) {
    DELASSUS_UNROLL
    for (int i = 0; i < R; ++i) Y[i + R * c] = A[i] * B[K * c];
    DELASSUS_UNROLL
    for (int k = 1; k < K; ++k) {
      DELASSUS_UNROLL
      for (int i = 0; i < R; ++i) Y[i + R * c] += A[i + R * k] * B[k + K * c];
    }
  }
}

/// Y = A Bᵀ.
template <int R, int K, int C, class T>
[[gnu::always_inline]] inline void set_product_with_transposed(const T* A, const T* B, T* Y) {
  DELASSUS_UNROLL
  for (int c = 0; c < C; ++c) {
    DELASSUS_UNROLL
    for (int i = 0; i < R; ++i) Y[i + R * c] = A[i] * B[c];
    DELASSUS_UNROLL
    for (int k = 1; k < K; ++k) {
      DELASSUS_UNROLL
      for (int i = 0; i < R; ++i) Y[i + R * c] += A[i + R * k] * B[c + C * k];
    }
  }
}

/// (x, y, z) · column.
template <class T>
inline T row_times(T x, T y, T z, const T* column) {
  return x * column[0] + y * column[1] + z * column[2];
}

}  // namespace inner

template <class T>
inline Eigen::Matrix<T, 3, 1> operator+(const Eigen::Matrix<T, 3, 1>& a, const Eigen::Matrix<T, 3, 1>& b) {
  const T *x = a.data(), *y = b.data();
  return {x[0] + y[0], x[1] + y[1], x[2] + y[2]};
}
template <class T, int R, int C, int O>
  requires inner::SmallSizes<R, C>
inline inner::Fixed<T, R, C, O> operator+(const inner::Fixed<T, R, C, O>& a, const inner::Fixed<T, R, C, O>& b) {
  inner::Fixed<T, R, C, O> c;
  DELASSUS_UNROLL
  for (int i = 0; i < R * C; ++i) c.data()[i] = a.data()[i] + b.data()[i];
  return c;
}

template <class T>
inline Eigen::Matrix<T, 3, 1> operator-(const Eigen::Matrix<T, 3, 1>& a, const Eigen::Matrix<T, 3, 1>& b) {
  const T *x = a.data(), *y = b.data();
  return {x[0] - y[0], x[1] - y[1], x[2] - y[2]};
}
template <class T, int R, int C, int O>
  requires inner::SmallSizes<R, C>
inline inner::Fixed<T, R, C, O> operator-(const inner::Fixed<T, R, C, O>& a, const inner::Fixed<T, R, C, O>& b) {
  inner::Fixed<T, R, C, O> c;
  DELASSUS_UNROLL
  for (int i = 0; i < R * C; ++i) c.data()[i] = a.data()[i] - b.data()[i];
  return c;
}

template <class T>
inline Eigen::Matrix<T, 3, 1> operator-(const Eigen::Matrix<T, 3, 1>& a) {
  const T* x = a.data();
  return {-x[0], -x[1], -x[2]};
}
template <class T, inner::ScalarOf<T> S>
inline Eigen::Matrix<T, 3, 1> operator*(const Eigen::Matrix<T, 3, 1>& a, S s) {
  const T* x = a.data();
  return {x[0] * T(s), x[1] * T(s), x[2] * T(s)};
}
template <class T, int R, int C, int O, inner::ScalarOf<T> S>
  requires inner::SmallSizes<R, C>
inline inner::Fixed<T, R, C, O> operator*(const inner::Fixed<T, R, C, O>& a, S s) {
  inner::Fixed<T, R, C, O> c;
  DELASSUS_UNROLL
  for (int i = 0; i < R * C; ++i) c.data()[i] = a.data()[i] * T(s);
  return c;
}

template <class T, int R, int C, int O, inner::ScalarOf<T> S>
  requires inner::SmallSizes<R, C>
inline inner::Fixed<T, R, C, O> operator*(S s, const inner::Fixed<T, R, C, O>& a) {
  return a * s;
}

template <class T, int R, int C, int O>
  requires inner::SmallSizes<R, C>
inline inner::Fixed<T, R, C, O> operator-(const inner::Fixed<T, R, C, O>& a) {
  return a * T(-1);
}

template <class T, inner::ScalarOf<T> S>
inline Eigen::Matrix<T, 3, 1> operator/(const Eigen::Matrix<T, 3, 1>& a, S s) {
  const T* x = a.data();
  return {x[0] / T(s), x[1] / T(s), x[2] / T(s)};
}
template <class T, int R, int C, int O, inner::ScalarOf<T> S>
  requires inner::SmallSizes<R, C>
inline inner::Fixed<T, R, C, O> operator/(const inner::Fixed<T, R, C, O>& a, S s) {
  inner::Fixed<T, R, C, O> c;
  DELASSUS_UNROLL
  for (int i = 0; i < R * C; ++i) c.data()[i] = a.data()[i] / T(s);
  return c;
}

template <class T, int R, int C, int O>
  requires inner::SmallSizes<R, C>
inline inner::Fixed<T, R, C, O>& operator+=(inner::Fixed<T, R, C, O>& a, const inner::Fixed<T, R, C, O>& b) {
  DELASSUS_UNROLL
  for (int i = 0; i < R * C; ++i) a.data()[i] += b.data()[i];
  return a;
}

template <class T, int R, int C, int O>
  requires inner::SmallSizes<R, C>
inline inner::Fixed<T, R, C, O>& operator-=(inner::Fixed<T, R, C, O>& a, const inner::Fixed<T, R, C, O>& b) {
  DELASSUS_UNROLL
  for (int i = 0; i < R * C; ++i) a.data()[i] -= b.data()[i];
  return a;
}

template <class T, int R, int C, int O, inner::ScalarOf<T> S>
  requires inner::SmallSizes<R, C>
inline inner::Fixed<T, R, C, O>& operator*=(inner::Fixed<T, R, C, O>& a, S s) {
  DELASSUS_UNROLL
  for (int i = 0; i < R * C; ++i) a.data()[i] *= T(s);
  return a;
}

template <class T, int R, int C, int O, inner::ScalarOf<T> S>
  requires inner::SmallSizes<R, C>
inline inner::Fixed<T, R, C, O>& operator/=(inner::Fixed<T, R, C, O>& a, S s) {
  DELASSUS_UNROLL
  for (int i = 0; i < R * C; ++i) a.data()[i] /= T(s);
  return a;
}

template <class T, int R, int C, int O>
  requires inner::SmallSizes<R, C>
inline bool operator==(const inner::Fixed<T, R, C, O>& a, const inner::Fixed<T, R, C, O>& b) {
  bool is_equal = true;
  for (int i = 0; i < R * C; ++i) is_equal &= a.data()[i] == b.data()[i];
  return is_equal;
}
template <class T, int R, int C, int O>
  requires inner::SmallSizes<R, C>
inline bool operator!=(const inner::Fixed<T, R, C, O>& a, const inner::Fixed<T, R, C, O>& b) {
  return !(a == b);
}

/// A x, written out.
template <class T>
[[gnu::always_inline]] inline Eigen::Matrix<T, 3, 1> operator*(const Eigen::Matrix<T, 3, 3>& A,
                                                               const Eigen::Matrix<T, 3, 1>& x) {
  const T *a = A.data(), *b = x.data();
  return {inner::row_times(a[0], a[3], a[6], b), inner::row_times(a[1], a[4], a[7], b),
          inner::row_times(a[2], a[5], a[8], b)};
}
/// A B.
template <class T, int R, int K, int C, int O, int P>
  requires inner::SmallSizes<R, K, C> && inner::ByColumns<R, O> && inner::ByColumns<K, P>
inline Eigen::Matrix<T, R, C> operator*(const inner::Fixed<T, R, K, O>& A, const inner::Fixed<T, K, C, P>& B) {
  Eigen::Matrix<T, R, C> Y;
  inner::set_product<R, K, C>(A.data(), B.data(), Y.data());
  return Y;
}

/// Aᵀ as a value, where Eigen's transpose() is a view.
template <class T, int R, int C>
  requires inner::SmallSizes<R, C>
inline Eigen::Matrix<T, C, R> transposed(const Eigen::Matrix<T, R, C>& A) {
  Eigen::Matrix<T, C, R> Y;
  DELASSUS_UNROLL
  for (int i = 0; i < R; ++i) {
    DELASSUS_UNROLL
    for (int k = 0; k < C; ++k) Y.data()[k + C * i] = A.data()[i + R * k];
  }
  return Y;
}

/// Aᵀ B and A Bᵀ of Eigen's view; xᵀ y stays with Eigen, where it is a number.
template <class M, class T, int K, int C, int O, int R = int(M::ColsAtCompileTime)>
  requires inner::Plain<M, T, K, R> && inner::SmallSizes<C> && inner::ByColumns<K, O> && (R * C > 1)
inline Eigen::Matrix<T, R, C> operator*(const Eigen::Transpose<M>& At, const inner::Fixed<T, K, C, O>& B) {
  Eigen::Matrix<T, R, C> Y;
  const T *a = At.nestedExpression().data(), *b = B.data();
  DELASSUS_UNROLL
  for (int c = 0; c < C; ++c) {
    DELASSUS_UNROLL
    for (int i = 0; i < R; ++i) {
      T sum = a[K * i] * b[K * c];
      DELASSUS_UNROLL
      for (int k = 1; k < K; ++k) sum += a[k + K * i] * b[k + K * c];
      Y.data()[i + R * c] = sum;
    }
  }
  return Y;
}
template <class M, class T, int R, int K, int O, int C = int(M::RowsAtCompileTime)>
  requires inner::Plain<M, T, C, K> && inner::SmallSizes<R> && inner::ByColumns<R, O> && (R * C > 1)
inline Eigen::Matrix<T, R, C> operator*(const inner::Fixed<T, R, K, O>& A, const Eigen::Transpose<M>& Bt) {
  Eigen::Matrix<T, R, C> Y;
  inner::set_product_with_transposed<R, K, C>(A.data(), Bt.nestedExpression().data(), Y.data());
  return Y;
}

/// Aᵀ B and A Bᵀ without Eigen's view.
template <class T>
[[gnu::always_inline]] inline Eigen::Matrix<T, 3, 1> transposed_times(const Eigen::Matrix<T, 3, 3>& A,
                                                                      const Eigen::Matrix<T, 3, 1>& x) {
  const T *a = A.data(), *b = x.data();
  return {inner::row_times(a[0], a[1], a[2], b), inner::row_times(a[3], a[4], a[5], b), inner::row_times(a[6], a[7], a[8], b)};
}
template <class T, int K, int R, int C>
  requires inner::SmallSizes<K, R, C>
inline Eigen::Matrix<T, R, C> transposed_times(const Eigen::Matrix<T, K, R>& A, const Eigen::Matrix<T, K, C>& B) {
  return transposed(A) * B;
}
template <class T, int R, int K, int C>
  requires inner::SmallSizes<R, K, C>
inline Eigen::Matrix<T, R, C> times_transposed(const Eigen::Matrix<T, R, K>& A, const Eigen::Matrix<T, C, K>& B) {
  Eigen::Matrix<T, R, C> Y;
  inner::set_product_with_transposed<R, K, C>(A.data(), B.data(), Y.data());
  return Y;
}

/// a · b of all entries, summed from left to right.
template <class T>
[[gnu::always_inline]] inline T dot(const Eigen::Matrix<T, 3, 1>& a, const Eigen::Matrix<T, 3, 1>& b) {
  const T *x = a.data(), *y = b.data();
  return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}
template <class T, int R, int C>
  requires inner::SmallSizes<R, C>
inline T dot(const Eigen::Matrix<T, R, C>& a, const Eigen::Matrix<T, R, C>& b) {
  T sum = a.data()[0] * b.data()[0];
  DELASSUS_UNROLL
  for (int i = 1; i < R * C; ++i) sum += a.data()[i] * b.data()[i];
  return sum;
}
template <class T, int R, int C>
  requires inner::SmallSizes<R, C>
[[gnu::always_inline]] inline T squared_norm(const Eigen::Matrix<T, R, C>& a) {
  return dot(a, a);
}
template <class T, int R, int C>
  requires inner::SmallSizes<R, C>
[[gnu::always_inline]] inline T norm(const Eigen::Matrix<T, R, C>& a) {
  return std::sqrt(dot(a, a));
}

/// a × b.
template <class T>
[[gnu::always_inline]] inline Eigen::Matrix<T, 3, 1> cross(const Eigen::Matrix<T, 3, 1>& a, const Eigen::Matrix<T, 3, 1>& b) {
  const T *x = a.data(), *y = b.data();
  return {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
}

/// a / |a|; a vector of zeros stays what it is.
template <class T>
inline Eigen::Matrix<T, 3, 1> normalized(const Eigen::Matrix<T, 3, 1>& a) {
  const T square = dot(a, a), length = square > T(0) ? std::sqrt(square) : T(1);
  const T* x = a.data();
  return {x[0] / length, x[1] / length, x[2] / length};
}

// The same names for what is no plain matrix of such a size: blocks, larger and dynamic ones.
template <class T, int R, int C>
  requires(!inner::SmallSizes<R, C>)
inline Eigen::Matrix<T, C, R> transposed(const Eigen::Matrix<T, R, C>& A) {
  return A.transpose();
}
template <class A, class B>
inline typename A::Scalar dot(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  return a.dot(b);
}
template <class A>
inline typename A::Scalar squared_norm(const Eigen::MatrixBase<A>& a) {
  return a.squaredNorm();
}
template <class A>
inline typename A::Scalar norm(const Eigen::MatrixBase<A>& a) {
  return a.norm();
}
template <class A, class B>
inline Eigen::Matrix<typename A::Scalar, 3, 1> cross(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  return a.cross(b);
}
template <class A>
inline typename A::PlainObject normalized(const Eigen::MatrixBase<A>& a) {
  return a.normalized();
}

/// to = from, entry by entry: Eigen's own operator= between two names takes thirty functions for each size, and none where
/// the right side is a value.
template <class T, int R, int C, int O>
[[gnu::always_inline]] inline void assign(inner::Fixed<T, R, C, O>& to, const inner::Fixed<T, R, C, O>& from) {
  T* e = to.data();
  const T* f = from.data();
  DELASSUS_UNROLL
  for (int i = 0; i < R * C; ++i) e[i] = f[i];
}

/// Sets every entry.
template <class T, int R, int C>
inline void set_all(Eigen::Matrix<T, R, C>& a, std::type_identity_t<T> value) {
  DELASSUS_UNROLL
  for (int i = 0; i < R * C; ++i) a.data()[i] = value;
}
template <class T, int R, int C>
[[gnu::always_inline]] inline void set_zero(Eigen::Matrix<T, R, C>& a) {
  set_all(a, T(0));
}

/// The largest entry, and the column j.
template <class T>
[[gnu::always_inline]] inline T max_entry(const Eigen::Matrix<T, 3, 1>& a) {
  const T *x = a.data(), two = x[0] < x[1] ? x[1] : x[0];
  return two < x[2] ? x[2] : two;
}
template <class T>
[[gnu::always_inline]] inline Eigen::Matrix<T, 3, 1> column(const Eigen::Matrix<T, 3, 3>& A, int j) {
  const T* x = A.data() + 3 * j;
  return {x[0], x[1], x[2]};
}

/// The matrix with `value` on its diagonal and zeros elsewhere, and of zeros alone.
template <int R, class T>
inline Eigen::Matrix<T, R, R> diagonal_of(T value) {
  Eigen::Matrix<T, R, R> a;
  DELASSUS_UNROLL
  for (int i = 0; i < R * R; ++i) a.data()[i] = i % (R + 1) == 0 ? value : T(0);
  return a;
}
template <class M>
[[gnu::always_inline]] inline M zero() {
  M a;
  set_all(a, 0);
  return a;
}
template <class M>
[[gnu::always_inline]] inline M identity() {
  return diagonal_of<int(M::RowsAtCompileTime)>(typename M::Scalar(1));
}

}  // namespace delassus
