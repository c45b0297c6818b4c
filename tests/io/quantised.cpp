#include <delassus/io/inner/quantised.hpp>

#include "catch.hpp"

#include <random>

using namespace delassus;

namespace {

/// The rotation of three words, as the page reads them.
Quat turn_value(const inner::TurnCode& words) {
  const Index largest = (words[0] & 1) << 1 | (words[1] & 1);
  Vec<4> q = Vec<4>::Zero();
  for (Index k = 0, i = 0; k < 4; ++k)
    if (k != largest) q[k] = ((words[i++] >> 1) / 32767.0 - 0.5) * std::sqrt(2.0);
  q[largest] = std::sqrt(std::max(0.0, 1 - q.squaredNorm()));
  return Quat(q);
}

}  // namespace

TEST_CASE("sixteen bits miss a number by at most half a part of its interval") {
  inner::Interval box;
  for (const double x : {-3.0, 17.0, 0.1, std::nan(""), HUGE_VAL}) box.include(x);
  REQUIRE(box.low == -3.0);
  REQUIRE(box.high == 17.0);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> inside(-3, 17);
  // Half of 20/65535, and the rounding of a few operations on numbers below 32.
  const double bound = 20.0 / 131070 + 8 * 32 * 2.3e-16;
  for (int i = 0; i < 10000; ++i) {
    const double x = inside(random);
    REQUIRE(std::abs(box.value(box.code(x)) - x) <= bound);
  }
  REQUIRE(box.value(box.code(-3)) == -3);
  REQUIRE(box.value(box.code(17)) == 17);
}

TEST_CASE("an interval of one number gives that number back") {
  inner::Interval one;
  one.include(0.3);
  REQUIRE(one.value(one.code(0.3)) == 0.3);
}

TEST_CASE("three words miss a rotation by at most 1.5e-4 rad") {
  // e = √2/65534 a component; the quaternion errs by √12 e to first order, the angle by twice that. The
  // second order of the largest component, |error|²/(2·½), is below 3 e² = 1.4e-9, hence the last factor.
  const double bound = 2 * std::sqrt(12.0) * std::sqrt(2.0) / 65534 * 1.001;
  REQUIRE(bound < 1.5e-4);
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 20000; ++i) {
    Quat q{normal(random), normal(random), normal(random), normal(random)};
    q.normalize();
    const Quat back = turn_value(inner::turn_code(q));
    REQUIRE(back.norm() == Approx(1).epsilon(1e-15));
    // 2 asin|Im(q* back)| keeps its digits for small angles.
    REQUIRE(2 * std::asin((q.conjugate() * back).vec().norm()) <= bound);
  }
}

TEST_CASE("rotations about the axes and by half a turn survive") {
  for (int axis = 0; axis < 4; ++axis) {
    Quat q(0, 0, 0, 0);
    q.coeffs()[axis] = -1;
    const Quat back = turn_value(inner::turn_code(q));
    REQUIRE(std::abs(back.dot(q)) > 1 - 1e-8);
  }
}
