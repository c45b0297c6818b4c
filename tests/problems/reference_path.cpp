// The path of smoothed laws as the reference goes along it: Newton's steps alone, contacts beside joints.
#include "reference_tests.hpp"

namespace reference_path_tests {

using namespace reference_tests;

namespace {

/// A box that slides on a floor, with an arm on a ball joint.
template <class Loop>
void add_box_with_arm(Loop& loop) {
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  const auto foot =
      rigid.add({.position = {0, 0, 0.5}, .velocity = {1, 0.3, -1}, .mass = 3.0, .shape = Box{1, 1, 1}});
  const auto arm = rigid.add({.position = {0.2, 0, 1.6}, .mass = 1.0, .shape = Box{0.2, 0.2, 1}});
  loop.add(BallJoint::Item{anchor(rigid, foot, {0.2, 0, 0.6}), anchor(rigid, arm, {0, 0, -0.5})});
}

template <class Problem>
void check_solved(Problem& problem) {
  for_each_index<2>([&](auto p) {
    for (auto& lambda : problem.rows.template pool<p>().lambda) lambda.setZero();
  });
  const SolveReport report = solve(problem, PathNewton{.tolerance = 1e-10, .max_iterations = 500, .max_sweeps = 0});
  CAPTURE(report.factorizations, report.measure.residual);
  CHECK(report.status == Status::converged);
  CHECK(report.factorizations > 2);
  // The laws are met by λ itself, whatever the method thinks of it.
  CHECK(solve(problem, GaussSeidel{.max_iterations = 0, .min_iterations = 0}).measure.residual <= 1e-10);
}

template <class Law>
auto loop_with(Law law) {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{law}, BallJoint{}}, NativeCollision{},
                       AcceleratedGaussSeidel{.tolerance = 1e-8}};
}

}  // namespace

TEST_CASE(
    "the path of smoothed laws: contacts that slide and a joint, with friction and with a coefficient of "
    "zero") {
  for (const double friction : {0.4, 0.0}) {
    auto loop = loop_with(Coulomb{.friction = friction});
    add_box_with_arm(loop);
    for (const int steps : {1, 30}) {
      run(loop, 1.0 / 240, steps);
      auto problem = loop.problem();
      CAPTURE(friction, steps);
      check_solved(problem);
    }
  }
}

// Without friction the motion is unique, and so is the joint's impulse, which alone moves the arm.
TEST_CASE("the path of smoothed laws: frictionless contacts and a joint as Gauss-Seidel has them") {
  auto loop = loop_with(Frictionless{});
  add_box_with_arm(loop);
  loop.step(1.0 / 240);
  auto problem = loop.problem(), swept = problem;
  check_solved(problem);
  REQUIRE(solve(swept, AcceleratedGaussSeidel{.tolerance = 1e-10, .max_iterations = 20000}).status ==
          Status::converged);
  // Two residuals of 1e-10 in velocities of some 2 m/s, an arm of 1 kg, and ten for the levers.
  CHECK((problem.rows.pool<1>().lambda[0] - swept.rows.pool<1>().lambda[0]).norm() <= 1e-8);
}

}  // namespace reference_path_tests
