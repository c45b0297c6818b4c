#include "catch.hpp"
#include "collision/samples.hpp"

#include <delassus/collision/inner/ahead.hpp>

#include <cmath>
#include <random>

namespace stay_apart_tests {

using namespace delassus;

namespace {

struct Movers {
  std::mt19937 random;
  std::uniform_real_distribution<double> uniform{-1, 1};

  Vec3 any(double size) {
    return Vec3(size * uniform(random), size * uniform(random), size * uniform(random));
  }
  Collider collider(const Shape& shape, std::uint32_t key, double speed) {
    return {.shape = shape,
            .pose = {any(0.8), samples::any_rotation(random)},
            .velocity = any(speed),
            .angular_velocity = any(4 * speed),
            .key = key};
  }
  /// A box, a capsule, a ball, a half-space beside a box, a capsule, a cylinder.
  std::pair<Collider, Collider> pair(int i, double speed) {
    const Shape shapes[] = {Box{0.3, 0.2, 0.4}, Capsule{0.1, 0.4}, Sphere{0.2}, HalfSpace{}},
                others[] = {Box{0.2, 0.5, 0.1}, Capsule{0.05, 0.4}, Cylinder{0.1, 0.3}};
    Collider a = collider(shapes[i % 4], 0, speed), b = collider(others[i / 4 % 3], 1, speed);
    if (i % 4 == 3) a.angular_velocity = Vec3::Zero();
    return {a, b};
  }
};

SignedPair distance(const Collider& a, const Collider& b, double t) {
  Patch patch;
  const Pose x = inner::pose_after(a, t), y = inner::pose_after(b, t);
  SignedPair r = inner::distance_of(a.shape, b.shape, x.to_local(y), std::numeric_limits<double>::infinity(),
                                    0.2, zero<Vec3>(), patch);
  r.normal = x.rotation * r.normal;
  return r;
}
/// The least of many moments: what is between two is no more than their way nearer.
double least_distance(const Collider& a, const Collider& b, double h) {
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k <= 60; ++k) least = std::min(least, distance(a, b, h * k / 60).distance);
  return least;
}

constexpr double h = 0.02, target = 2e-5;

}  // namespace

TEST_CASE("where a plane keeps two bodies apart no moment of the step finds them nearer") {
  Movers movers{std::mt19937(3)};
  int apart = 0, turning = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto [a, b] = movers.pair(i, i % 5 == 0 ? 10. : 1.);
    const SignedPair now = distance(a, b, 0);
    if (!inner::stay_apart(a, b, now.normal, h, target)) continue;
    ++apart;
    // The search has 1e-9 of the size.
    REQUIRE(least_distance(a, b, h) > target - 1e-9);
    REQUIRE_FALSE(inner::time_of_impact(a, b, h, 0.2, target).is_found);
    turning += inner::may_close(a, b, now.normal, now.distance - target, h);
  }
  CHECK(apart > 800);
  CHECK(turning > 10);  // which the speeds alone do not tell
}

TEST_CASE("a half-space that turns and a normal that is none prove nothing") {
  Movers movers{std::mt19937(4)};
  auto [a, b] = movers.pair(3, 0.1);
  a.pose = Pose{}, a.velocity = Vec3::Zero();
  b.pose.position = {0, 0, 5};
  CHECK(inner::stay_apart(a, b, {0, 0, 1}, h, target));
  CHECK_FALSE(inner::stay_apart(a, b, {0, 0, 0}, h, target));
  CHECK_FALSE(inner::stay_apart(a, b, {0, 0.6, 0.8}, h, target));
  // Far beside the origin of the half-space a lean of 4e-8, whose cosine is 1, is as much as 0.4 mm.
  Collider ball{.shape = Sphere{0.2}, .pose = {{1e4, 0, 0.2 + 1e-6}, Mat3::Identity()}, .key = 1};
  CHECK_FALSE(inner::stay_apart(a, ball, Vec3(4e-8, 0, 1).normalized(), h, target));
  ball.pose.position[2] += 1e-4;
  CHECK(inner::stay_apart(a, ball, {0, 0, 1}, h, target));
  a.angular_velocity = {1, 0, 0};
  CHECK_FALSE(inner::stay_apart(a, b, {0, 0, 1}, h, target));
  b.velocity = {0, 0, std::nan("")};
  a.angular_velocity = Vec3::Zero();
  CHECK_FALSE(inner::stay_apart(a, b, {0, 0, 1}, h, target));
}

TEST_CASE("a search for an impact finds one exactly where some moment is within its target") {
  Movers movers{std::mt19937(5)};
  int met = 0, none = 0;
  for (int i = 0; i < 3000; ++i) {
    auto [a, b] = movers.pair(i, i % 3 == 0 ? 30. : 3.);
    const SignedPair now = distance(a, b, 0);
    if (i % 2 == 0) b.pose.position -= (now.distance - 2 * target) * now.normal;  // beside each other
    if (!(distance(a, b, 0).distance > target)) continue;
    const inner::Impact hit = inner::time_of_impact(a, b, h, 0.2, target);
    if (hit.is_found) {
      ++met;
      REQUIRE(hit.time < h);
      REQUIRE(distance(a, b, hit.time).distance <= target + 1e-9);
    } else {
      ++none;
      REQUIRE(least_distance(a, b, h) > target - 1e-9);
    }
  }
  CHECK(met > 200);
  CHECK(none > 200);
}

}  // namespace stay_apart_tests
