#include <delassus/math/free_turns.hpp>

#include "catch.hpp"

namespace free_turns_tests {

using namespace delassus;

namespace {

const Vec3 momentum(0.7, -1.9, 1.1);
/// A body whose axes are not those of its inertia.
Mat3 inverse_inertia() {
  Mat3 I;
  I << 2, 0.3, -0.2, 0.3, 3, 0.5, -0.2, 0.5, 1.5;
  return inverse(I);
}
const Quat start = exponential<double>({0.4, -0.8, 1.3});

}  // namespace

// A central difference at 1e-5 errs by 1e-10 of its third derivative and by 2^-53/1e-5 = 1e-11 of rounding.
TEST_CASE("the response of a free rotation is the derivative of where it ends") {
  Mat3 response;
  const double h = 0.3, e = 1e-5;
  const Quat end = turn_freely<double>(inverse_inertia(), start, momentum, h, &response);
  for (int k = 0; k < 3; ++k) {
    const Vec3 by = e * Vec3::Unit(k);
    const Quat more = turn_freely<double>(inverse_inertia(), start, Vec3(momentum + by), h),
               less = turn_freely<double>(inverse_inertia(), start, Vec3(momentum - by), h);
    const Vec3 slope =
        (logarithm<double>(more * end.conjugate()) - logarithm<double>(less * end.conjugate())) / (2 * e);
    for (int i = 0; i < 3; ++i) REQUIRE(response(i, k) == Approx(slope[i]).epsilon(0).margin(1e-9));
  }
}

// Symmetric: the same turns in the same order backwards. Ten turns round by 2^-53 each.
TEST_CASE("a free rotation and the same with the opposite momentum come back to the start") {
  const Quat there = turn_freely<double>(inverse_inertia(), start, momentum, 0.3);
  const Quat back = turn_freely<double>(inverse_inertia(), there, Vec3(-momentum), 0.3);
  REQUIRE((back.coeffs() - start.coeffs()).norm() <= 1e-14);
  REQUIRE((there.coeffs() - start.coeffs()).norm() >= 0.01);
}

TEST_CASE("a ball turns about its momentum, however long the step") {
  const Quat end = turn_freely<double>(Mat3(0.5 * Mat3::Identity()), Quat::Identity(), Vec3(0, 0, 2), 3.0);
  REQUIRE((end.coeffs() - exponential<double>({0, 0, 3}).coeffs()).norm() <= 1e-14);
}

}  // namespace free_turns_tests
