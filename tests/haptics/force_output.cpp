#include <delassus/haptics/force_output.hpp>

#include "catch.hpp"

#include <cmath>
#include <limits>
#include <numbers>

using namespace delassus;

TEST_CASE("without a cutoff and a limit a force passes unchanged") {
  const ForceOutput output;
  Vec3 memory = Vec3::Zero();
  REQUIRE(output({1, -2, 3}, output.max_force, memory) == Vec3(1, -2, 3));
  REQUIRE(output({-9, 0, 1e6}, output.max_force, memory) == Vec3(-9, 0, 1e6));
}

TEST_CASE("the filter answers a step with 1 - exp(-2 pi f t)") {
  const ForceOutput output{.cutoff = 30, .period = 1e-3};
  Vec3 memory = Vec3::Zero();
  for (int n = 1; n <= 100; ++n) {
    const Vec3 y = output({2, 0, 0}, output.max_force, memory);
    REQUIRE(y.x() == Approx(2 * (1 - std::exp(-2 * std::numbers::pi * 30 * 1e-3 * n))).epsilon(1e-12));
  }
}

TEST_CASE("the limit shortens a force and keeps its direction, and the filter does not see it") {
  const ForceOutput output{.max_force = 5};
  Vec3 memory = Vec3::Zero();
  const Vec3 y = output({30, 0, -40}, output.max_force, memory);
  REQUIRE((y - Vec3(3, 0, -4)).norm() < 1e-14);
  REQUIRE(memory == Vec3(30, 0, -40));
  REQUIRE(output({0, 4.9, 0}, output.max_force, memory) == Vec3(0, 4.9, 0));
}

TEST_CASE("a force that is not finite becomes none, and leaves nothing behind") {
  const ForceOutput output{.cutoff = 100};
  Vec3 memory(7, 7, 7);
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const Vec3& bad : {Vec3(nan, 0, 0), Vec3(0, inf, 0)}) {
    REQUIRE(output(bad, output.max_force, memory) == Vec3::Zero());
    REQUIRE(memory == Vec3::Zero());
  }
}

TEST_CASE("bad parameters of a force output are refused") {
  REQUIRE_THROWS_WITH(ForceOutput{.cutoff = 0}.check(), "delassus: ForceOutput: cutoff 0 Hz must be > 0");
  REQUIRE_THROWS_WITH(ForceOutput{.period = -1}.check(), "delassus: ForceOutput: period -1 s must be finite and > 0");
  REQUIRE_THROWS_WITH(ForceOutput{.max_force = -1}.check(), "delassus: ForceOutput: max_force -1 N must be >= 0");
  REQUIRE_THROWS_WITH(ForceOutput{.max_torque = std::nan("")}.check(),
                      "delassus: ForceOutput: max_torque nan N·m must be >= 0");
}
