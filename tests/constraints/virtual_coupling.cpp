#include <delassus/delassus.hpp>

#include "catch.hpp"

namespace virtual_coupling_tests {

using namespace delassus;

namespace {

auto scene() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{VirtualCoupling{}}, AcceleratedGaussSeidel{.tolerance = 1e-14}};
  bodies<RigidBodies>(loop.world()).gravity.setZero();
  return loop;
}

}  // namespace

TEST_CASE("a step of a virtual coupling is the spring and damper of implicit Euler") {
  auto loop = scene();
  auto& rigid = bodies<RigidBodies>(loop.world());
  const double h = 0.01, m = 0.3, k = 700, c = 5, I = 2e-3, kt = 4, ct = 0.1;
  const auto tool = rigid.add({.velocity = {0.1, 0, 0}, .angular_velocity = {0, 0.5, 0}, .mass = m,
                               .inertia = Mat3(I * Mat3::Identity())});
  const auto device = rigid.add({.position = {0.02, -0.01, 0}, .shape = Sphere{0.01}, .motion = Motion::kinematic});
  const Vec3 turn(0, 0.2, 0);
  rigid.move_to(device, {0.023, -0.012, 0}, exponential<double>(turn));
  const auto coupling = loop.add(VirtualCoupling::Item{anchor(rigid, tool), anchor(rigid, device), k, c, kt, ct});
  loop.step(h);
  const auto impulse = loop.impulse(coupling);
  const Vec3 taken = m * (rigid.velocity(tool) - Vec3(0.1, 0, 0));
  REQUIRE((taken - impulse.head<3>()).norm() < 1e-15);
  // The law itself, at the velocities of the rows: H v_tool at the middle of the anchors minus the device's.
  const Vec3 u = rigid.velocity(tool) + rigid.angular_velocity(tool).cross(Vec3(0.01, -0.005, 0)) -
                 (Vec3(0.003, -0.002, 0) / h + (turn / h).cross(Vec3(-0.01, 0.005, 0)));
  const Vec3 phi(-0.02, 0.01, 0);
  // The solver's tolerance is 1e-14 of the rows' velocities, below 100 rad/s, times 1/(W + R) < h (h k + c) = 0.12.
  REQUIRE((impulse.head<3>() + h * (k * (phi + h * u) + c * u)).norm() < 1e-12);
  const Vec3 w = rigid.angular_velocity(tool) - turn / h;
  REQUIRE((impulse.tail<3>() + h * (kt * (h * w) + ct * w)).norm() < 1e-12);
}

TEST_CASE("a virtual coupling draws its tool to the device's pose, however stiff it is") {
  for (const double stiffness : {10.0, 1e4, 1e9}) {
    auto loop = scene();
    auto& rigid = bodies<RigidBodies>(loop.world());
    const auto tool = rigid.add({.mass = 0.1, .inertia = Mat3(1e-4 * Mat3::Identity())});
    const Quat pose = exponential<double>(Vec3(0.3, -0.5, 1));
    loop.add(VirtualCoupling::Item{anchor(rigid, tool), world_anchor({0.1, 0.2, -0.1}, pose), stiffness,
                                   2 * std::sqrt(0.1 * stiffness), 1e-3 * stiffness, 2 * std::sqrt(1e-7 * stiffness)});
    for (int n = 0; n < 1000; ++n) loop.step(0.01);
    // Critically damped, ω = √(k/m) >= 10 /s: after 10 s what is left is below (1 + ωt) e^(−ωt) < 1e-40, so rounding.
    CHECK((rigid.position(tool) - Vec3(0.1, 0.2, -0.1)).norm() < 1e-12);
    CHECK(rigid.orientation(tool).angularDistance(pose) < 1e-7);  // acos near 1 shows the root of rounding
  }
}

TEST_CASE("a virtual coupling refuses what cannot be a spring") {
  auto loop = scene();
  auto& rigid = bodies<RigidBodies>(loop.world());
  const auto tool = rigid.add({.mass = 0.1, .shape = Sphere{0.01}});
  const auto with = [&](double k, double c, double kt, double ct) {
    loop.add(VirtualCoupling::Item{anchor(rigid, tool), world_anchor({0, 0, 0}), k, c, kt, ct});
  };
  REQUIRE_THROWS_WITH(with(0, 0, 1, 0), "delassus: VirtualCoupling: stiffness 0 N/m must be finite and > 0");
  REQUIRE_THROWS_WITH(with(1, -1, 1, 0), "delassus: VirtualCoupling: damping -1 N·s/m must be finite and >= 0");
  REQUIRE_THROWS_WITH(with(1, 0, 0, 0), "delassus: VirtualCoupling: angular_stiffness 0 N·m/rad must be finite and > 0");
  REQUIRE_THROWS_WITH(with(1, 0, 1, -2), "delassus: VirtualCoupling: angular_damping -2 N·m·s/rad must be finite and >= 0");
}

}  // namespace virtual_coupling_tests
