#include "tool_scene.hpp"

#include "catch.hpp"

#include <cmath>
#include <limits>

using namespace tool_scene;

TEST_CASE("a tick with the device where the step took it gives the force of the step") {
  Scene<RigidBodies> s(path(0));
  for (int n = 0; n < 60; ++n) {
    s.step(path(n + 1), turn(n + 1));
    const HapticForce f = s.haptics().tick(arrival(n, n + 1));
    REQUIRE(f.sequence == std::uint64_t(n + 1));
    REQUIRE(f.snapshot_time == Approx(n * h).margin(1e-12));
    REQUIRE(f.solve.status <= Status::stalled);
    // Both solves stop at 1e-12 of their velocities, below 10 m/s (and rad/s); an impulse is less than h (h k + c) = 0.36 times
    // the error of a velocity times the condition of the contacts, < 1e4, and the force is that over h.
    CHECK((f.force - s.force().head<3>()).norm() < 1e-6);
    CHECK((f.torque - s.force().tail<3>()).norm() < 1e-6);
  }
  REQUIRE(s.force().norm() > 1);
}

TEST_CASE("a tick with the device elsewhere gives the force that the step would have had with the device there") {
  Scene<RigidBodies> there(path(0));
  double largest = 0;
  for (int n = 0; n < 60; ++n) {
    there.step(path(n + 1), turn(n + 1));
    if (n % 5 != 4) continue;
    Scene<RigidBodies> fork(path(0));  // comes to the same state, and takes another step
    for (int m = 0; m < n; ++m) fork.step(path(m + 1), turn(m + 1));
    const int m = n + (n % 7) - 2;  // up to two poses back and four ahead
    fork.step(path(m), turn(m));
    const HapticForce f = there.haptics().tick(arrival(n, m));
    CHECK((f.force - fork.force().head<3>()).norm() < 1e-6);  // as above
    CHECK((f.torque - fork.force().tail<3>()).norm() < 1e-6);
    largest = std::max(largest, (f.force - there.force().head<3>()).norm());
  }
  REQUIRE(largest > 0.5);
}

TEST_CASE("a tool on the ground is a spring of stiffness k and a damper to the device") {
  Scene<RigidBodies> s({-0.2, 0, 0.01});
  for (int n = 0; n < 100; ++n) s.step({-0.2, 0, 0.009});  // rests, pressed by 1 mm
  for (const double depth : {0.0, 0.002, 0.01, 0.05})
    for (const double speed : {-0.3, 0.0, 0.1}) {
      const HapticForce f =
          s.haptics().tick({.position = {-0.2, 0, 0.01 - depth}, .velocity = {0, 0, speed}});
      const double pull = s.k * depth - s.c * speed;  // N, up; the ground holds what presses: m g too
      if (pull < -s.mass * 9.81) continue;
      CHECK(f.force.z() == Approx(pull).margin(1e-6));  // the tool sank by less than 1e-12/h of a velocity 1 m/s
    }
}

TEST_CASE("in free space the device feels the tool's inertia over one step and no more") {
  Scene<RigidBodies> s({-0.2, 0, 0.5});
  s.set().gravity.setZero();
  s.step({-0.2, 0, 0.5});
  const double x = 0.003;
  const HapticForce f = s.haptics().tick({.position = {-0.2 + x, 0, 0.5}});
  // λ = (W + R)⁻¹ x (k/(h k + c)): the spring and the mass m/h² in series, the damper's share with them.
  const double W = 1 / s.mass, R = 1 / (h * h * s.k + h * s.c);
  CHECK(f.force.x() == Approx(-x * s.k / (h * s.k + s.c) / (W + R) / h).epsilon(1e-12));
  CHECK(std::abs(f.force.y()) < 1e-12);
}

TEST_CASE("without a snapshot, a coupling or a finite state there is no force") {
  Scene<RigidBodies> s(path(0));
  CHECK(s.haptics().tick({}).force == Vec3::Zero());
  CHECK(s.haptics().tick({}).sequence == 0);
  s.step(path(1));
  CHECK(s.haptics().tick({.position = {0, 0, 0.1}}).force.norm() > 0);

  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const DeviceState& bad : {DeviceState{.position = {nan, 0, 0}}, DeviceState{.velocity = {0, nan, 0}},
                                 DeviceState{.orientation = Quat(0, 0, 0, 0)}, DeviceState{.angular_velocity = {0, 0, nan}}}) {
    const HapticForce f = s.haptics().tick(bad);
    CHECK(f.force == Vec3::Zero());
    CHECK(f.torque == Vec3::Zero());
    CHECK(f.solve.status == Status::quarantined);
  }
  CHECK(s.haptics().device().position == Vec3(0, 0, 0.1));  // what is not finite is not handed on
  CHECK(s.haptics().tick({.position = {0, 0, 0.1}}).force.norm() > 0);

  s.loop.remove(s.coupling);
  s.loop.step(h);
  CHECK(s.haptics().tick({.position = {0, 0, 0.1}}).force == Vec3::Zero());
}

TEST_CASE("a problem that is not finite is kept back, and the last good one stays") {
  Scene<RigidBodies> s(path(0));
  s.step(path(1));
  s.set().apply_force(s.tool, {std::numeric_limits<double>::quiet_NaN(), 0, 0});
  s.step(path(2));
  const HapticForce f = s.haptics().tick(arrival(1, 2));
  CHECK(f.sequence == 1);
  CHECK(std::isfinite(f.force.norm()));
}

TEST_CASE("a tick that runs out of time returns what it has, and the next one goes on from there") {
  // A look at the clock each sweep, a second each, and one before the first: the third look after a sweep is too late.
  Scene<RigidBodies> s(path(0), 1.0, 2.5), patient(path(0));
  for (int n = 0; n < 40; ++n) {
    s.step(path(n + 1), turn(n + 1));
    patient.step(path(n + 1), turn(n + 1));
  }
  const DeviceState device = arrival(40, 44);
  const Vec3 wanted = patient.haptics().tick(device).force;
  const HapticForce first = s.haptics().tick(device);
  REQUIRE(first.solve.status == Status::deadline);
  REQUIRE(first.solve.sweeps == 3);
  HapticForce last = first;
  for (int n = 0; n < 2000; ++n) last = s.haptics().tick(device);
  CHECK((last.force - wanted).norm() < 0.01 * (first.force - wanted).norm());
}

TEST_CASE("bad parameters of a haptic channel are refused with their names") {
  REQUIRE_THROWS_WITH((Scene<RigidBodies>(path(0), 0, -1)), "delassus: HapticChannel: budget -1 s must be >= 0");
}
