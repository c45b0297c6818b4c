#include <delassus/math/long_vectors.hpp>

#include "catch.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

namespace long_vectors_tests {

using namespace delassus;

/// Whole numbers, so that every order of a sum gives the same.
template <class T>
std::vector<T> numbers(Index n, int by) {
  std::vector<T> x(std::size_t(n) + 1);
  for (Index i = 0; i <= n; ++i) x[std::size_t(i)] = T((by * i) % 17 - 8);
  return x;
}

template <class T>
void check() {
  for (Index n = 0; n < 70; ++n) {
    const std::vector<T> x = numbers<T>(n, 5), y = numbers<T>(n, 7);
    T sum = 0;
    for (std::size_t i = 0; i < std::size_t(n); ++i) sum += x[i] * y[i];
    CHECK(sum_of_products(x.data(), y.data(), n) == sum);
    std::vector<T> z = y;
    add_multiple(T(3), x.data(), z.data(), n);
    for (std::size_t i = 0; i < std::size_t(n); ++i) REQUIRE(z[i] == y[i] + 3 * x[i]);
    CHECK(z[std::size_t(n)] == y[std::size_t(n)]);  // what lies behind stays
    scale(T(3), z.data(), n);
    for (std::size_t i = 0; i < std::size_t(n); ++i) REQUIRE(z[i] == 3 * (y[i] + 3 * x[i]));
    CHECK(z[std::size_t(n)] == y[std::size_t(n)]);
    // Three rows that lie n + 2 numbers apart, from the first to the last and back.
    const std::ptrdiff_t stride = n + 2;
    const std::vector<T> rows = numbers<T>(Index(3 * stride), 3);
    const T a[] = {2, -3, 5};
    std::vector<T> down = y, up = y;
    add_multiples(a, 3, rows.data(), stride, down.data(), n);
    add_multiples(a, 3, rows.data() + 2 * stride, -stride, up.data(), n);
    for (Index i = 0; i < n; ++i) {
      const T r[] = {rows[std::size_t(i)], rows[std::size_t(i + stride)], rows[std::size_t(i + 2 * stride)]};
      REQUIRE(down[std::size_t(i)] == y[std::size_t(i)] + 2 * r[0] - 3 * r[1] + 5 * r[2]);
      REQUIRE(up[std::size_t(i)] == y[std::size_t(i)] + 5 * r[0] - 3 * r[1] + 2 * r[2]);
    }
    CHECK(down[std::size_t(n)] == y[std::size_t(n)]);
    CHECK(up[std::size_t(n)] == y[std::size_t(n)]);
  }
}

TEST_CASE("sums of any length are those of a plain loop") {
  check<double>();
  check<float>();
}

}  // namespace long_vectors_tests
