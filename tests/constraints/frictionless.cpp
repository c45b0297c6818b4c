#include <delassus/constraints/contact/frictionless.hpp>

#include "catch.hpp"

#include <random>

namespace frictionless_tests {

using namespace delassus;

TEST_CASE("a frictionless contact opens or stops, whatever impulse it started from") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> draw(-1, 1);
  for (int n = 0; n < 1000; ++n) {
    const double W = 0.1 + std::abs(draw(random)), b = draw(random), start = std::abs(draw(random));
    Local<1> c{Mat<1, 1>(W), Vec<1>(b + W * start), Vec<1>(start)};
    Frictionless{}.project({}, c);
    // λ = max(0, −b/W); the difference of two numbers below 10 keeps 1e-14.
    REQUIRE(std::abs(c.lambda[0] - std::max(0.0, -b / W)) <= 1e-14);
    const Vec<1> u(b + W * c.lambda[0]);
    REQUIRE(std::abs(Frictionless{}.natural_map<double>({}, c.lambda, u, W)[0]) <= 1e-14);
  }
}

}  // namespace frictionless_tests
