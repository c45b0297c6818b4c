#include <delassus/delassus.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>
#include <delassus/stabilisation/closed_joints.hpp>

#include "catch.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace closed_joints_tests {

using namespace delassus;

namespace {

/// Three rods of 1 m that turn about each other at 10 rad/s and more, on hinges of different axes.
struct Whirl {
  double worst = 0;  ///< distance of two ends that a joint holds together, after any step, m

  explicit Whirl(auto stabilisation, double h) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, BallJoint{}},
                       DirectGaussSeidel{.tolerance = 1e-10}, stabilisation};
    auto& set = bodies<RigidBodies>(loop.world());
    std::vector<std::pair<Anchor, Anchor>> joints;
    Anchor end = world_anchor(Vec3::Zero(), frame_along({0, 1, 0}));
    for (int k = 0; k < 3; ++k) {
      const auto rod = set.add({.position = {k + 0.5, 0, 0},
                                .velocity = {0, 0, -10.0 * (k + 0.5)},
                                .angular_velocity = {0, 10, 0},
                                .mass = 1.0,
                                .shape = Box{1, 0.1, 0.1}});
      const Anchor begin = anchor_at(set, rod, {double(k), 0, 0}, frame_along({0, 1, 0}));
      if (k == 1)
        loop.add(BallJoint::Item{end, begin});
      else
        loop.add(Hinge::Item{end, begin});
      joints.emplace_back(end, begin);
      end = anchor_at(set, rod, {k + 1.0, 0, 0}, frame_along({0, 1, 0}));
    }
    for (int n = 0; n < 200; ++n) {
      REQUIRE(loop.step(h).status == Status::converged);
      for (const auto& [a, b] : joints)
        worst = std::max(worst, (loop.world().point(a) - loop.world().point(b)).norm());
    }
  }
};

}  // namespace

// A step turns the rods by h ω = 0.05 rad: a joint in velocities leaves r (h ω)²/2 = 6e-4 m open at r = 0.5
// m, and Baumgarte's rate of 0.2 more. `tolerance` bounds each of the three numbers of a gap.
TEST_CASE("closed joints leave no gap after any step where Baumgarte leaves a millimetre") {
  CHECK(Whirl(Baumgarte{}, 5e-3).worst > 1e-4);
  CHECK(Whirl(ClosedJoints{}, 5e-3).worst <= std::sqrt(3.0) * 1e-7);
  CHECK(Whirl(ClosedJoints{.tolerance = 1e-10}, 5e-3).worst <= std::sqrt(3.0) * 1e-10);
}

TEST_CASE("closed joints bring ends that start apart together within one step") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, DirectGaussSeidel{}, ClosedJoints{}};
  auto& set = bodies<RigidBodies>(loop.world());
  const auto bob = set.add({.position = {1.1, 0, 0}, .mass = 1.0, .shape = Box{1, 1, 1}});
  const Anchor a = world_anchor(Vec3::Zero()), b = anchor(set, bob, {-1, 0, 0});
  loop.add(BallJoint::Item{a, b});
  REQUIRE((loop.world().point(a) - loop.world().point(b)).norm() > 0.09);
  loop.step(0.01);
  CHECK((loop.world().point(a) - loop.world().point(b)).norm() <= std::sqrt(3.0) * 1e-7);
}

// Two pins 2 m apart on a body whose own places for them are 1.9 m apart: 0.1 m stays open whatever is done,
// and half of it at each is the least of the worst.
TEST_CASE("closed joints that contradict each other are not torn apart") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, DirectGaussSeidel{}, ClosedJoints{}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.gravity.setZero();
  const auto bar = set.add({.position = {0, 0, 0}, .mass = 1.0, .shape = Box{2, 0.1, 0.1}});
  for (const double side : {-1.0, 1.0})
    loop.add(BallJoint::Item{world_anchor({side, 0, 0}), anchor(set, bar, {0.95 * side, 0, 0})});
  for (int n = 0; n < 20; ++n) {
    loop.step(0.01);
    REQUIRE(std::abs(set.position(bar).x()) <= 0.05);
    REQUIRE(set.position(bar).norm() <= 0.05);
  }
}

}  // namespace closed_joints_tests
