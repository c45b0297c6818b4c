// The slopes that Newton's method takes of Coulomb's law, against differences.
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/constraints/joints/drive.hpp>
#include <delassus/constraints/joints/limit.hpp>
#include <delassus/constraints/joints/motor.hpp>
#include <delassus/constraints/law.hpp>

#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace tangents_tests {

using namespace delassus;

namespace {

Local<3> problem(const Vec3& u, const Vec3& lambda) {
  Local<3> c{Mat3::Zero(), u, lambda};
  c.W.diagonal() = Vec3(0.7, 0.2, 0.2);
  return c;
}

/// −∂λ/∂d by central differences against what `tangent(local)` says, at random points.
template <class Tangent>
int agreeing(const Tangent& tangent) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1, 1);
  int count = 0;
  for (int n = 0; n < 200; ++n) {
    const Vec3 u(any(random), any(random), any(random)), lambda(any(random) + 1, any(random), any(random));
    auto here = problem(u, lambda);
    const Mat3 slope = tangent(here);
    Mat3 difference;
    const double step = 1e-6;
    for (int k = 0; k < 3; ++k) {
      auto more = problem(u + step * Vec3::Unit(k), lambda), less = problem(u - step * Vec3::Unit(k), lambda);
      tangent(more);
      tangent(less);
      difference.col(k) = -(more.lambda - less.lambda) / (2 * step);
    }
    // Central differences err by the third derivative times step² and by rounding over the step: 1e-9 of slopes of order 10.
    count += (slope - difference).norm() < 1e-6;
  }
  return count;
}

}  // namespace

// A difference across a border between two cases agrees with neither side; at 200 random points one or two may.
TEST_CASE("the tangent of Coulomb's law is the slope of its impulse") {
  const Coulomb law;
  CHECK(agreeing([&](Local<3>& c) { return law.tangent({0.6}, c); }) >= 198);
}
TEST_CASE("the convex tangent of Coulomb's law is the slope of its impulse, symmetric, and at the true slip the law itself") {
  const Coulomb law;
  CHECK(agreeing([&](Local<3>& c) { return law.convex_tangent({0.6}, c, 0.3); }) >= 198);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int n = 0; n < 100; ++n) {
    auto c = problem(Vec3(any(random), any(random), any(random)), Vec3(any(random) + 1, any(random), any(random)));
    const Mat3 slope = law.convex_tangent({0.6}, c, 0.3);
    REQUIRE((slope - slope.transpose()).norm() <= 1e-14 * (1 + slope.norm()));
    REQUIRE(c.lambda.tail<2>().norm() <= 0.6 * c.lambda[0] * (1 + 1e-14));
    // A pair (λ, u) that meets the law is a fixed point of its projection, whatever W is.
    const Vec3 slip(0, any(random), any(random)), force(1, -0.6 * slip[1] / slip.norm(), -0.6 * slip[2] / slip.norm());
    auto fixed = problem(slip, force);
    law.convex_tangent({0.6}, fixed, slip.norm());
    REQUIRE((fixed.lambda - force).norm() <= 1e-13);
  }
}

static_assert(Differentiable<Limit<Turn>> && Differentiable<Motor<Turn>> && Differentiable<Drive<Slide>>);

// Both laws are piecewise linear: λ = P(λ − d/W), slope 1/W where P leaves it, and nothing where P cuts it.
TEST_CASE("the tangents of limits and motors are the slopes of their impulses") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  const double w = 0.7;
  for (int n = 0; n < 100; ++n) {
    const double first = any(random), second = any(random), before = any(random), after = any(random);
    Local<2> stops{w * Mat<2, 2>::Identity(), {first, second}, {before, after}};
    const Mat<2, 2> slopes = Limit<Turn>{}.tangent({}, stops);
    const double low = before - first / w, high = after - second / w;
    CHECK(stops.lambda[0] == std::max(0.0, low));
    CHECK(stops.lambda[1] == std::min(0.0, high));
    CHECK(slopes(0, 0) == (low >= 0 ? 1 / w : 0));
    CHECK(slopes(1, 1) == (high <= 0 ? 1 / w : 0));
    CHECK((slopes(0, 1) == 0 && slopes(1, 0) == 0));

    const Motor<Turn>::Memory<double> cap{0.4};
    Local<1> motor{Mat<1, 1>(w), Vec<1>(first), Vec<1>(before)};
    const Mat<1, 1> slope = Motor<Turn>{}.tangent(Motor<Turn>::Item{}, motor, cap);
    CHECK(motor.lambda[0] == std::clamp(low, -0.4, 0.4));
    CHECK(slope(0, 0) == (std::abs(low) <= 0.4 ? 1 / w : 0));
  }
}

}  // namespace tangents_tests
