// Newton's method on bodies of single precision.
#include "newton_tests.hpp"

namespace proximal_newton_float_tests {

using namespace newton_tests;

// Single precision holds a residual of 1e-5 above its rounding floor of about 1e-6; Newton's own sums are double.
TEST_CASE("five boxes of single precision stand, and every step converges") {
  AnimationLoop loop{World{RigidBodiesF{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     ProximalNewton{.tolerance = 1e-5}};
  add_stack(rigid_bodies(loop), 5, Box{1, 1, 1});
  const Warm seen = run(loop, 120);
  CHECK(seen.unconverged == 0);
  CHECK(loop.report().residual > 0);
  CHECK(kinetic_energy(rigid_bodies(loop)) < 1e-6);
}

}  // namespace proximal_newton_float_tests
