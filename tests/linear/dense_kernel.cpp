// The dense inner loops against Eigen's products, at sizes on either side of every strip, panel and depth.
#include <delassus/linear/inner/dense_kernel.hpp>

#include "catch.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

using namespace delassus;

namespace dense_kernel_tests {

using inner::Columns;

template <class T>
using Dense = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;

template <class T>
Columns<T> all(Dense<T>& A) {
  return {A.data(), std::size_t(A.rows())};
}
template <class T>
Columns<const T> all(const Dense<T>& A) {
  return {A.data(), std::size_t(A.rows())};
}

// A sum of k products rounds k + 1 times, however it is ordered: |error| ≤ (k + 2) eps Σ|a||b|, twice for the two that are compared.
TEMPLATE_TEST_CASE("products and triangles of any size are those of the definition", "", double, float) {
  using T = TestType;
  inner::DenseKernel<T> kernel;
  std::srand(7);
  for (const Index m : {1, 7, 24, 25, 50, 97})
    for (const Index n : {1, 4, 8, 9, 31})
      for (const Index k : {1, 3, 8, 17, 128, 131, 260}) {
        const Dense<T> A = Dense<T>::Random(m, k), B = Dense<T>::Random(n, k), C = Dense<T>::Random(m, n);
        const T rounding = 2 * T(k + 2) * std::numeric_limits<T>::epsilon();
        const Dense<T> bound = rounding * (C.cwiseAbs() + A.cwiseAbs() * B.cwiseAbs().transpose());
        Dense<T> off = C, fresh = Dense<T>::Constant(m, n, std::numeric_limits<T>::quiet_NaN()), lower = C;
        kernel.subtract(all(off), all(A), all(B), m, n, k, false);
        kernel.negated_product(all(fresh), all(A), all(B), m, n, k, false);
        kernel.subtract(all(lower), all(A), all(B), m, n, k, true);
        CAPTURE(m, n, k);
        REQUIRE(((off - (C - A * B.transpose())).array().abs() <= bound.array()).all());
        REQUIRE(((fresh + A * B.transpose()).array().abs() <= bound.array()).all());
        for (Index j = 0; j < n; ++j)
          for (Index i = j; i < m; ++i) REQUIRE(lower(i, j) == off(i, j));

        // Rows of L with 4 on the diagonal and 1/k beside it: Y L⁻ᵀ Lᵀ gives Y back, backward stable by k eps |Y₊||L|.
        Dense<T> L = Dense<T>::Random(k, k) / T(k), Y = A;
        L.diagonal().setConstant(4);
        kernel.solve_right(all(Y), all(std::as_const(L)), m, k);
        const Dense<T> low = L.template triangularView<Eigen::Lower>();
        REQUIRE(((Y * low.transpose() - A).array().abs() <=
                 (rounding * (Y.cwiseAbs() * low.cwiseAbs().transpose() + A.cwiseAbs())).array())
                    .all());

        // The three at once: the same numbers as one after the other.
        Dense<T> both = A, G = Dense<T>::Zero(m, n), D = Dense<T>::Constant(m, m, T(1)), E = D;
        kernel.solve_and_multiply(all(both), all(std::as_const(L)), all(B), all(G), all(D), m, n, k);
        const Dense<T> solved = Y;
        kernel.negated_product(all(fresh), all(solved), all(B), m, n, k, false);
        kernel.subtract(all(E), all(solved), all(solved), m, m, k, true);
        REQUIRE(both == Y);
        REQUIRE(G == fresh);
        for (Index j = 0; j < m; ++j)
          for (Index i = j; i < m; ++i) REQUIRE(D(i, j) == E(i, j));
      }
}

TEMPLATE_TEST_CASE("a dense factor times itself is the matrix, and what is not positive has none", "", double, float) {
  using T = TestType;
  inner::DenseKernel<T> kernel;
  std::srand(8);
  for (const Index n : {1, 5, 8, 9, 33, 150, 300}) {
    const Index m = n + 40;
    const Dense<T> R = Dense<T>::Random(m, m);
    Dense<T> A = R * R.transpose() + T(m) * Dense<T>::Identity(m, m), C = A.leftCols(n);
    REQUIRE(kernel.factor(all(C), m, n));
    Dense<T> L = C;
    for (Index j = 0; j < n; ++j) L.col(j).head(j).setZero();
    const Dense<T> product = L * L.topRows(n).transpose();
    const T rounding = 4 * T(n + 2) * std::numeric_limits<T>::epsilon();
    CAPTURE(n);
    for (Index j = 0; j < n; ++j)
      for (Index i = j; i < m; ++i)
        REQUIRE(std::abs(product(i, j) - A(i, j)) <= rounding * std::sqrt(A(i, i) * A(j, j)));
    C = A.leftCols(n);
    C(n - 1, n - 1) = -1;
    CHECK_FALSE(kernel.factor(all(C), m, n));
  }
}

}  // namespace dense_kernel_tests
