// The slopes that Newton's method takes of Coulomb's law, against differences.
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/constraints/contact/rolling_coulomb.hpp>
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

template <int R>
Local<R> problem(const Vec<R>& u, const Vec<R>& lambda) {
  constexpr double diagonal[6] = {0.7, 0.2, 0.2, 0.3, 0.3, 0.4};  // alike in the rows of one disc
  Local<R> c{Mat<R, R>::Zero(), u, lambda};
  for (int k = 0; k < R; ++k) c.W(k, k) = diagonal[k];
  return c;
}

/// −∂λ/∂d by central differences against what `tangent(local)` says, at random points.
template <int R = 3, class Tangent>
int agreeing(const Tangent& tangent) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1, 1);
  int count = 0;
  for (int n = 0; n < 200; ++n) {
    Vec<R> u, lambda;
    for (double& x : u) x = any(random);
    for (double& x : lambda) x = any(random);
    lambda[0] += 1;
    auto here = problem<R>(u, lambda);
    const Mat<R, R> slope = tangent(here);
    Mat<R, R> difference;
    const double step = 1e-6;
    for (int k = 0; k < R; ++k) {
      const Vec<R> aside = step * Vec<R>::Unit(k);
      auto more = problem<R>(u + aside, lambda), less = problem<R>(u - aside, lambda);
      tangent(more);
      tangent(less);
      difference.col(k) = -(more.lambda - less.lambda) / (2 * step);
    }
    // Central differences err by the third derivative times step² and by rounding over the step: 1e-9 of
    // slopes of order 10.
    count += (slope - difference).norm() < 1e-6;
  }
  return count;
}

}  // namespace

// A difference across a border between two cases agrees with neither side; at 200 random points one or two
// may.
TEST_CASE("the tangent of Coulomb's law is the slope of its impulse") {
  const Coulomb law;
  CHECK(agreeing([&](Local<3>& c) { return law.tangent({0.6}, c); }) >= 198);
}
TEST_CASE("the tangent of rolling friction is the slope of its impulse, which is the one of a visit") {
  const RollingCoulomb law;
  const RollingCoulomb::Parameters p{0.6, 0.4, 0.3};
  // Three borders in the place of one: four of 200 points may lie on one.
  CHECK(agreeing<6>([&](Local<6>& c) { return law.tangent(p, c); }) >= 196);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> any(-1, 1);
  int closed = 0, sliding = 0;
  for (int n = 0; n < 200; ++n) {
    Vec<6> b;
    for (double& x : b) x = any(random);
    auto c = problem<6>(b, Vec<6>::Zero());
    RollingCoulomb::Memory<double> memory;
    law.prepare(c.W, memory);
    const Vec<6> visited = law.solve_local(p, c.W, b, memory);
    law.tangent(p, c);
    REQUIRE((c.lambda - visited).norm() <= 1e-12 * b.norm() / 0.2);
    closed += c.lambda[0] > 0;
    sliding += law.is_sliding(p, c.lambda);
  }
  CHECK(closed >= 50);
  CHECK(sliding >= 20);
}
TEST_CASE(
    "the convex tangent of Coulomb's law is the slope of its impulse, symmetric, and at the true slip the "
    "law itself") {
  const Coulomb law;
  CHECK(agreeing([&](Local<3>& c) { return law.convex_tangent({0.6}, c, 0.3); }) >= 198);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int n = 0; n < 100; ++n) {
    const Vec3 start{any(random), any(random), any(random)};
    auto c = problem<3>(start, Vec3{any(random) + 1, any(random), any(random)});
    const Mat3 slope = law.convex_tangent({0.6}, c, 0.3);
    REQUIRE((slope - slope.transpose()).norm() <= 1e-14 * (1 + slope.norm()));
    REQUIRE(c.lambda.tail<2>().norm() <= 0.6 * c.lambda[0] * (1 + 1e-14));
    // A pair (λ, u) that meets the law is a fixed point of its projection, whatever W is.
    const Vec3 slip{0, any(random), any(random)},
        force(1, -0.6 * slip[1] / slip.norm(), -0.6 * slip[2] / slip.norm());
    auto fixed = problem<3>(slip, force);
    law.convex_tangent({0.6}, fixed, slip.norm());
    REQUIRE((fixed.lambda - force).norm() <= 1e-13);
  }
}

static_assert(refines<Limit<Turn>>(refine::tangent) && refines<Motor<Turn>>(refine::tangent) && refines<Drive<Slide>>(refine::tangent));

// Both laws are piecewise linear: λ = P(λ − d/W), slope 1/W where P leaves it, and nothing where P cuts it.
TEST_CASE("the tangents of limits and motors are the slopes of their impulses") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  const double w = 0.7;
  for (int n = 0; n < 100; ++n) {
    const double first = any(random), second = any(random), before = any(random), after = any(random);
    Local<2> stops{w * Mat<2, 2>::Identity(), {first, second}, {before, after}};
    const Mat<2, 2> slopes = Limit<Turn>{}.tangent(Limit<Turn>::Item{}, stops);
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
