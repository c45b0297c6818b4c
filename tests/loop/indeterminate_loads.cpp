// Loads that the motion alone does not decide: which are chosen decides what slips, and what joints bear.
#include <delassus/bodies/anchor_at.hpp>
#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/constraints/joints/hinge.hpp>
#include <delassus/constraints/joints/motor.hpp>
#include <delassus/loop/animation_loop.hpp>
#include <delassus/solvers/accelerated_gauss_seidel.hpp>
#include <delassus/solvers/gauss_seidel.hpp>
#include <delassus/solvers/minimum_norm.hpp>

#include "catch.hpp"

#include <array>
#include <cmath>
#include <utility>

namespace indeterminate_loads_tests {

using namespace delassus;

namespace {

constexpr double g = 9.81;

/// A parcel of 5 kg on two belts that run along x at 1 m/s and away from each other at 0.5 m/s, as kinematic bodies that are put back.
template <class Loop>
struct Belts {
  Loop loop;
  RigidBodies::Handle left, right, parcel;

  explicit Belts(Loop given) : loop(std::move(given)) {
    auto& rigid = bodies<RigidBodies>(loop.world());
    left = rigid.add({.position = {0, 1, -0.05}, .shape = Box{200, 2, 0.1}, .motion = Motion::kinematic});
    right = rigid.add({.position = {0, -1, -0.05}, .shape = Box{200, 2, 0.1}, .motion = Motion::kinematic});
    parcel = rigid.add({.position = {0, 0, 0.2}, .mass = 5, .shape = Box{0.6, 0.5, 0.4}});
  }
  StepReport step(double h) {
    auto& rigid = bodies<RigidBodies>(loop.world());
    rigid.place(left, Vec3(0, 1, -0.05), Quat::Identity()), rigid.place(right, Vec3(0, -1, -0.05), Quat::Identity());
    rigid.set_velocity(left, {1, -0.5, 0}), rigid.set_velocity(right, {1, 0.5, 0});
    return loop.step(h);
  }
  /// N.
  double load(RigidBodies::Handle belt, double h) {
    auto& rigid = bodies<RigidBodies>(loop.world());
    double sum = 0;
    for (const auto& contact : loop.contacts())
      if (rigid.handle(contact.record.a.block) == belt || rigid.handle(contact.record.b.block) == belt) sum += std::abs(contact.impulse.z()) / h;
    return sum;
  }
};

auto belts_loop(AcceleratedGaussSeidel solver = {}) {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, solver};
}

}  // namespace

// By symmetry each belt bears half the weight, from the first step on: so what they pull sideways cancels. The yaw is unstable in
// nature, each half's middle lying to one side of the parcel's, and grows at some 2 /s from rounding: in three seconds it turns by
// less than 1e-3 and no more than that enters y and the speed.
TEST_CASE("belts that pull against each other under a parcel bear half of it each") {
  const double h = GENERATE(1 / 60., 1 / 240.);
  Belts belts(belts_loop());
  const auto& rigid = bodies<RigidBodies>(belts.loop.world());
  for (int n = 0; n < 3 / h; ++n) {
    REQUIRE(belts.step(h).status == Status::converged);
    REQUIRE(belts.load(belts.left, h) == Approx(5 * g / 2).epsilon(0.01));
    REQUIRE(belts.load(belts.right, h) == Approx(5 * g / 2).epsilon(0.01));
    REQUIRE(std::abs(rigid.position(belts.parcel).y()) <= 1e-3);
    REQUIRE(rigid.velocity(belts.parcel).norm() <= 1.001);
    REQUIRE(rigid.position(belts.parcel).z() == Approx(0.2).margin(1e-6));  // no sinking
  }
}

// A cart of 26 kg with four wheels in line with their motors: at constant speed nothing needs a torque, and the least of all loads are
// equal.
TEST_CASE("a cart at constant speed bears a quarter of its weight on each wheel and asks no torque of its motors") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.8}}, Hinge{}, Motor<Turn>{}}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  const double R = 0.15, h = 2e-3;
  const auto chassis = rigid.add({.position = {0, 0, 0.25 + 0.1}, .mass = 20.0, .shape = Box{1.0, 0.3, 0.15}});
  const Quat axis = frame_along({0, 1, 0});
  std::array<RigidBodies::Handle, 4> wheels;
  const auto add_motor = [&](const Anchor& a, const Anchor& b) { return loop.add(Motor<Turn>::Item{.a = a, .b = b, .speed = 1.0 / R, .max_force = 6}); };
  std::array<decltype(add_motor({}, {})), 4> motors;
  for (int k = 0; k < 4; ++k) {
    const Vec3 at(k < 2 ? 0.35 : -0.35, k % 2 ? -0.3 : 0.3, R);
    wheels[k] = rigid.add({.position = at, .orientation = axis, .mass = 1.5, .shape = Cylinder{R, 0.1}});
    const Anchor a = anchor_at(rigid, chassis, at, axis), b = anchor_at(rigid, wheels[k], at, axis);
    loop.add(Hinge::Item{a, b});
    motors[k] = add_motor(a, b);
  }
  for (int n = 0; n < 1000; ++n) {
    REQUIRE(loop.step(h).status == Status::converged);
    if (n < 200) continue;  // until it runs at 1 m/s
    std::array<double, 4> load{};
    for (const auto& c : loop.contacts())
      for (int k = 0; k < 4; ++k)
        if (rigid.handle(c.record.a.block) == wheels[k] || rigid.handle(c.record.b.block) == wheels[k]) load[k] += std::abs(c.impulse.z()) / h;
    for (int k = 0; k < 4; ++k) {
      REQUIRE(load[k] == Approx(26 * g / 4).epsilon(0.01));
      REQUIRE(std::abs(loop.impulse(motors[k])[0] / h) <= 0.01);
    }
  }
}

// The same with more contacts than are asked by default, and none: what sweeps find first is 37 and 12 N.
TEST_CASE("loads of islands that are not asked are left to the order of sweeps") {
  const auto first_load = [](int share_loads_up_to) {
    Belts belts(belts_loop({.share_loads_up_to = share_loads_up_to}));
    belts.step(1 / 60.);
    return belts.load(belts.left, 1 / 60.);
  };
  CHECK(first_load(8) == Approx(5 * g / 2).epsilon(0.01));
  CHECK(std::abs(first_load(7) - 5 * g / 2) > 1);
  CHECK(std::abs(first_load(0) - 5 * g / 2) > 1);
}

// A parcel that slides on two belts: decided by the rule, unless nobody asks it. A box at rest on its four corners is not asked, for its loads
// move nothing, and MinimumNorm decides them. One ball has one load.
TEST_CASE("the report counts the loads that no rule decides") {
  Belts shared(belts_loop()), unshared(belts_loop({.share_loads_up_to = 0}));
  CHECK(shared.step(1 / 60.).undecided_loads == 0);
  CHECK(unshared.step(1 / 60.).undecided_loads == unshared.loop.report().contacts);
  CHECK(unshared.loop.report().contacts >= 4);
  const auto at_rest = [](auto loop, const Shape& shape, double height) {
    auto& rigid = bodies<RigidBodies>(loop.world());
    rigid.add_fixed(HalfSpace{});
    rigid.add({.position = {0, 0, height}, .mass = 1, .shape = shape});
    for (int n = 0; n < 9; ++n) loop.step(1 / 60.);
    return loop.step(1 / 60.).undecided_loads;
  };
  const Constraints rough{Contact{Coulomb{.friction = 0.5}}};
  CHECK(at_rest(AnimationLoop{World{RigidBodies{}}, rough}, Box{1, 1, 1}, 0.5) == 4);
  CHECK(at_rest(AnimationLoop{World{RigidBodies{}}, rough, GaussSeidel{}}, Box{1, 1, 1}, 0.5) == 4);
  CHECK(at_rest(AnimationLoop{World{RigidBodies{}}, rough, MinimumNorm{GaussSeidel{}}}, Box{1, 1, 1}, 0.5) == 0);
  CHECK(at_rest(AnimationLoop{World{RigidBodies{}}, rough}, Sphere{0.5}, 0.5) == 0);
}

}  // namespace indeterminate_loads_tests
