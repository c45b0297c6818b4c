#include <delassus/math/pose.hpp>

#include "catch.hpp"

using namespace delassus;

TEST_CASE("the identity pose leaves a point where it is") {
  const Vec3 point(1, 2, 3);
  REQUIRE(Pose{}.to_world(point) == point);
  REQUIRE(Pose{}.to_local(point) == point);
}

TEST_CASE("a quarter turn about z takes x to y, then the position is added") {
  Mat3 quarter;
  quarter << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  const Pose pose{.position = {10, 20, 30}, .rotation = quarter};
  REQUIRE(pose.to_world({1, 0, 0}) == Vec3(10, 21, 30));
  REQUIRE(pose.to_local({10, 21, 30}) == Vec3(1, 0, 0));
}

TEST_CASE("to_local undoes to_world") {
  const Pose pose{.position = {0.3, -0.7, 2.0},
                  .rotation = Quat(Eigen::AngleAxisd(0.8, Vec3(1, 2, 2) / 3)).toRotationMatrix()};
  const Vec3 point(0.1, 0.2, -0.4);
  // Two rotations of a vector of length < 3 and two additions: about ten roundings of 3 eps.
  REQUIRE((pose.to_local(pose.to_world(point)) - point).norm() < 1e-14);
}
