#include <delassus/math/long_vectors.hpp>

#include "catch.hpp"

#include <cmath>
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
  }
}

TEST_CASE("sums of any length are those of a plain loop") {
  check<double>();
  check<float>();
}

}  // namespace long_vectors_tests
