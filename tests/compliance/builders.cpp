// One contract for every builder of W: those that are exact, and the one that is not meant to be.
#include <delassus/compliance/lazy.hpp>
#include <delassus/compliance/uncoupled.hpp>

#include "catch.hpp"
#include "compliance/builder_scenes.hpp"

namespace builders_tests {

using namespace builder_scenes;

// cond A < 1e4 here (the beam's fastest mode against its slowest, times h²), so both inverses are right to
// 1e-12; 1e-10 leaves two digits. Δv is by the same factor, or by conjugate gradients to 1e-13.
TEMPLATE_TEST_CASE("an exact builder agrees with whole solves, and H dv = W lambda", "", AssembledCompliance,
                   BasicLazyCompliance<double>) {
  TestType policy;
  if constexpr (requires { policy.tolerance; }) policy.tolerance = 1e-13, policy.max_iterations = 0;
  Scene scene;
  scene.bend(1.5);
  Built<TestType> built;
  built.build(scene, policy);
  CHECK(built.error() < 1e-10);
  CHECK(built.asymmetry() < 1e-12);
  CHECK((built.change - built.made * built.lambda).norm() < 1e-10 * built.change.norm());
  CHECK(built.change.norm() > 1e-2);
}

// W̃ takes each node's mass alone. How wrong, measured on this soft beam: every row yields 2.4 to 4.5 times
// too much, and the rows are off by (W − W̃) λ after a step.
TEST_CASE("the uncoupled builder yields too much, and the rows miss (W - W~) lambda") {
  Scene scene;
  Built<UncoupledCompliance> built;
  built.build(scene, {});
  CHECK((built.change - built.exact * built.lambda).norm() < 1e-10 * built.change.norm());
  double least = 1e300, most = 0;
  for (Index i = 0; i < built.made.rows(); ++i) {
    if (i / 3 % 4 == 0) continue;  // the rigid body's part is exact
    const double times = built.made(i, i) / built.exact(i, i);
    least = std::min(least, times), most = std::max(most, times);
  }
  CHECK(least > 2.3);
  CHECK(most > 4.4);
  CHECK(most < 4.6);
}

}  // namespace builders_tests
