// Scenes of the demonstration at steps of theirs, solved by Gauss-Seidel to 1e-10, against the reference.
#include <delassus/problems/reference_check.hpp>

#include "reference_tests.hpp"

#include "../examples/demonstration/blocks_on_slope.hpp"
#include "../examples/demonstration/stack_of_boxes.hpp"

namespace reference_check_tests {

using namespace reference_tests;

TEST_CASE("a falling box has nothing to compare") {
  AnimationLoop loop{World{RigidBodies{}}};
  bodies<RigidBodies>(loop.world()).add({.mass = 1.0, .shape = Box{1, 1, 1}});
  loop.step(0.01);
  const ReferenceCheck check = check_against_reference(loop);
  CHECK(check.constraints.empty());
  CHECK(check.reached);
  CHECK(check.text() == "no constraint to compare");
}

TEST_CASE("the stack of ten boxes agrees with the reference, and the loop is left as it was") {
  auto loop = contact_loop(0.6);
  demonstration::add_stack_of_boxes(bodies<RigidBodies>(loop.world()));
  compare(loop, 1.0 / 120, 1);
  const auto before = state_hash(loop);
  check_against_reference(loop);
  CHECK(state_hash(loop) == before);
}

// Four contacts of one face do not lie in a plane to rounding: in all steps but the first Gauss-Seidel stays
// at 1e-8.
TEST_CASE("the stack reaches the reference's tolerance at every step tried") {
  auto loop = contact_loop(0.6);
  demonstration::add_stack_of_boxes(bodies<RigidBodies>(loop.world()));
  // A gap closes at once and an overlap by a share, so the corners of a face that tilts by 1e-12 ask for velocities that no box
  // has. In step 3 that leaves 3e-10 to both solvers, which agree to 1e-15 m/s.
  compare_at(loop, 1.0 / 120, {1, 2, 4, 50, 200, 500});
}

TEST_CASE("one wrong impulse in the stack is found and named") {
  auto loop = contact_loop(0.6);
  demonstration::add_stack_of_boxes(bodies<RigidBodies>(loop.world()));
  loop.step(1.0 / 120);
  auto problem = loop.problem();
  REQUIRE(solve(problem, AcceleratedGaussSeidel{.tolerance = 1e-10}).status == Status::converged);
  // Along the line through two contacts of one face both push the bodies alike, and nothing can tell them
  // apart: so the error of friction points at none.
  for (const Index wrong : {0, 3, 17, 38})
    for (const Vec3& error : {Vec3(0.1, 0, 0), Vec3(0, 0.02, 0.01)}) {
      auto broken = problem;
      broken.rows.pool<0>().lambda[wrong] += error;
      const ReferenceCheck check = check_against_reference(broken);
      CAPTURE(wrong, check.text());
      CHECK(check.reached);
      CHECK(check.constraints.front().item == wrong);
      CHECK(check.residual > 1e-3);
      // The constraint sees what it was given, through its own block of W.
      CHECK(check.constraints.front().velocity ==
            Approx((broken.W.diagonal<0>(wrong) * error).norm()).epsilon(1e-6));
      CHECK_THAT(check.text(), Catch::Contains("constraint " + std::to_string(wrong) + " of pool 0"));
    }
}

TEST_CASE("blocks that slide down a slope and blocks that stick agree with the reference") {
  auto loop = contact_loop(0.5);
  demonstration::BlocksOnSlope{}.add_to(loop);
  compare_at(loop, 1.0 / 240, {1, 2, 10, 60, 150, 300, 600});
}

TEST_CASE("a reference that did not get there says so") {
  auto loop = contact_loop(0.6);
  demonstration::add_stack_of_boxes(bodies<RigidBodies>(loop.world()));
  loop.step(1.0 / 120);
  const ReferenceCheck check = check_against_reference(loop.problem(), 0);
  CHECK_FALSE(check.reached);
  CHECK(check.reference.measure.residual > 0);
  CHECK(check.reference.measure.residual < 1e-9);
  CHECK_THAT(check.text(), Catch::Contains("did not reach its tolerance"));
}

}  // namespace reference_check_tests
