// A row whose terms cancel: W_ii = 0, no impulse does anything. Everything else moves as if it were not there.
#include <delassus/constraints/joints/drive.hpp>
#include <delassus/constraints/joints/hinge.hpp>
#include <delassus/constraints/joints/limit.hpp>
#include <delassus/constraints/joints/motor.hpp>
#include <delassus/constraints/joints/rotation_angle.hpp>
#include <delassus/constraints/joints/tendon.hpp>
#include <delassus/delassus.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>
#include <delassus/solvers/proximal_newton.hpp>

#include "catch.hpp"

namespace rows_without_effect_tests {

using namespace delassus;

namespace {

/// A body falls beside a ball on a plane; `add` gives the body a constraint in vain.
template <class Law, class Solver, class Add>
void falls_freely(const Solver& solver, const Add& add) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Law{}, Contact{Coulomb{.friction = 0.5}}}, solver};
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(HalfSpace{});
  const auto body = set.add({.position = {5, 0, 9}, .mass = 2, .inertia = Mat3(Vec3(0.2, 0.3, 0.4).asDiagonal())});
  const auto ball = set.add({.position = {0, 0, 0.1}, .velocity = {1, 0, 0}, .mass = 1, .shape = Sphere{0.1}});
  add(loop, anchor(set, body));
  for (int k = 0; k < 20; ++k) {
    loop.step(0.01);
    REQUIRE(loop.report().status == Status::converged);
  }
  // Twenty additions of g h: each rounds once.
  CHECK(set.velocity(body)[2] == Approx(-9.81 * 0.2).epsilon(20 * 2.3e-16));
  CHECK(set.velocity(ball)[0] < 0.9);  // friction works
  CHECK(set.velocity(ball)[2] == Approx(0).margin(1e-8));
}
template <class Law, class Add>
void falls_freely_by_all(const Add& add) {
  SECTION("GaussSeidel") { falls_freely<Law>(GaussSeidel{.tolerance = 1e-9}, add); }
  SECTION("AcceleratedGaussSeidel") { falls_freely<Law>(AcceleratedGaussSeidel{.tolerance = 1e-9}, add); }
  SECTION("DirectGaussSeidel") { falls_freely<Law>(DirectGaussSeidel{.tolerance = 1e-9}, add); }
  SECTION("ProximalNewton") { falls_freely<Law>(ProximalNewton{.tolerance = 1e-9}, add); }
}
std::array<TendonPart, 2> cancelling(const Anchor& b) {
  const TendonPart part{.a = world_anchor({5, 0, 9}), .b = b, .coefficient = 1, .kind = AxisKind::turn};
  TendonPart back = part;
  back.coefficient = -1;
  return {part, back};
}

}  // namespace

TEST_CASE("a motor on a tendon whose parts cancel does nothing") {
  falls_freely_by_all<TendonMotor<2>>([](auto& loop, const Anchor& body) {
    loop.add(TendonMotor<2>::Item{.parts = cancelling(body), .max_force = 3, .speed = 1});
  });
}
TEST_CASE("limits of a tendon whose parts cancel do nothing") {
  falls_freely_by_all<TendonLimit<2>>([](auto& loop, const Anchor& body) {
    loop.add(TendonLimit<2>::Item{.parts = cancelling(body), .lower = 0, .upper = 0.1});
  });
}
TEST_CASE("a tendon whose parts cancel does nothing") {
  falls_freely_by_all<Tendon<2>>([](auto& loop, const Anchor& body) {
    loop.add(Tendon<2>::Item{.parts = cancelling(body)});
  });
}
TEST_CASE("a motor of the angle between two frames does nothing while the angle has no axis") {
  falls_freely_by_all<Motor<RotationAngle>>([](auto& loop, const Anchor& body) {
    loop.add(Motor<RotationAngle>::Item{.a = world_anchor({5, 0, 9}), .b = body, .speed = 1, .max_force = 3});
  });
}

}  // namespace rows_without_effect_tests
