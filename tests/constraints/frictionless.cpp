#include <delassus/constraints/contact/frictionless.hpp>

#include "catch.hpp"

#include <random>

namespace frictionless_tests {

using namespace delassus;

TEST_CASE("a frictionless contact opens or stops") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> draw(-1, 1);
  for (int n = 0; n < 1000; ++n) {
    const double W = 0.1 + std::abs(draw(random)), b = draw(random);
    const Vec<1> lambda = Frictionless{}.solve_local({}, Mat<1, 1>(W), Vec<1>(b));
    REQUIRE(lambda[0] == std::max(0.0, -b / W));
    // The difference of two numbers below 10 keeps 1e-14.
    const Vec<1> u(b + W * lambda[0]);
    REQUIRE(std::abs(Frictionless{}.natural_map<double>({}, lambda, u, W)[0]) <= 1e-14);
  }
}

}  // namespace frictionless_tests
