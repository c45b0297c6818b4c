// Newton's method on limits, motors and drives.
#include <delassus/solvers/proximal_newton.hpp>

#include <delassus/delassus.hpp>

#include <algorithm>
#include <vector>

#include "catch.hpp"

namespace proximal_newton_axes_tests {

using namespace delassus;

namespace {

/// An arm of four links on hinges: a motor with a cap at its root, a drive and limits further out, 50 kg at
/// its end. It falls against its limits and is held there.
template <class Solver>
auto arm(Solver solver) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, Limit<Turn>{}, Motor<Turn>{}, Drive<Turn>{}},
                     std::move(solver)};
  auto& set = bodies<RigidBodies>(loop.world());
  const Quat axis = frame_along({0, -1, 0});
  Anchor end = world_anchor(Vec3::Zero(), axis);
  for (int k = 0; k < 4; ++k) {
    const auto link = set.add(
        {.position = {0.3 * k + 0.15, 0, 0}, .mass = k == 3 ? 50. : 1., .shape = Box{0.3, 0.05, 0.05}});
    const Anchor near = anchor(set, link, {-0.15, 0, 0}, axis);
    loop.add(Hinge::Item{end, near});
    if (k == 0) loop.add(Motor<Turn>::Item{.a = end, .b = near, .speed = 0.2, .max_force = 30});
    if (k == 1)
      loop.add(Drive<Turn>::Item{.a = end, .b = near, .target = 0.1, .stiffness = 500, .damping = 20});
    loop.add(Limit<Turn>::Item{.a = end, .b = near, .lower = -0.3, .upper = 0.3});
    end = anchor(set, link, {0.15, 0, 0}, axis);
  }
  return loop;
}

}  // namespace

// Both solve each step to 1e-10 of its speeds; 60 steps part them by no more than a thousand times that.
TEST_CASE(
    "Newton's method moves an arm with limits, a motor and a drive as tight sweeps do, without a sweep") {
  auto newton = arm(ProximalNewton{.tolerance = 1e-10});
  auto swept = arm(AcceleratedSweeps{.tolerance = 1e-10, .max_iterations = 100000});
  int sweeps = 0, without = 0, unconverged = 0, pure = 0;
  double apart = 0;
  for (int n = 0; n < 60; ++n) {
    const StepReport report = newton.step(1.0 / 60);
    sweeps += report.sweeps;
    pure += report.sweeps == 0;
    unconverged += report.status > Status::stalled;
    without += swept.step(1.0 / 60).sweeps;
    const auto &a = newton.world().set<0>(), &b = swept.world().set<0>();
    for (Index k = 0; k < a.blocks(); ++k)
      apart = std::max(apart, (a.velocity()[k] - b.velocity()[k]).norm());
  }
  CAPTURE(sweeps, without, pure, unconverged, apart);
  CHECK(unconverged == 0);
  CHECK(pure >= 30);
  CHECK(4 * sweeps <= without);
  CHECK(apart <= 1e-6);
}

}  // namespace proximal_newton_axes_tests
