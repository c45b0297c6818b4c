// The wall and the pile of the demonstration at steps of theirs, solved by Gauss-Seidel to 1e-10, against the
// reference. docs/reference/limits.md says at which steps neither gets there.
#include "reference_tests.hpp"

#include "../examples/demonstration/pile_of_shapes.hpp"
#include "../examples/demonstration/wall_of_boxes.hpp"

namespace reference_impacts_tests {

using namespace reference_tests;

TEST_CASE("a wall of a hundred boxes agrees with the reference while it stands") {
  auto loop = contact_loop(0.5, 0.034, 1e-10);
  demonstration::add_wall_of_boxes(bodies<RigidBodies>(loop.world()));
  // Stepped to 1e-4 the wall is wedged from step 3 on, and sweeps do not get there.
  compare_at(loop, 1.0 / 240, {1, 3, 10, 40, 61});
}

// Rounding decides which steps of a wedged wall sweeps end, and so does the compiler: by g++ at eight of these.
TEST_CASE("a wall that a ball wedges agrees with the reference wherever sweeps end") {
  auto loop = contact_loop(0.5, 0.034, 1e-4);
  demonstration::add_wall_of_boxes(bodies<RigidBodies>(loop.world()));
  run(loop, 1.0 / 240, 65);
  int swept = 0;
  for (int n = 66; n < 75; ++n) {
    loop.step(1.0 / 240);
    auto problem = loop.problem();
    if (solve(problem, AcceleratedGaussSeidel{.tolerance = 1e-10, .max_iterations = 2500}).status != Status::converged)
      continue;
    ++swept;
    const ReferenceCheck check = check_against_reference(problem);
    CAPTURE(n, check.text());
    CHECK(check.reached);
    CHECK(check.reference.measure.residual <= 1e-10);
    CHECK(check.reference.factorizations < 2000);  // by the slips; from nothing it takes thousands, if it gets there
  }
  CHECK(swept > 0);
}

TEST_CASE("the reference agrees in a pile of two hundred, while it lands and after") {
  auto loop = contact_loop(0.4, NativeCollision{}.margin, 1e-4);
  demonstration::add_pile_of_shapes(bodies<RigidBodies>(loop.world()));
  compare_at(loop, 1.0 / 240, {12, 24, 36, 48, 52, 72, 102});
}

}  // namespace reference_impacts_tests
