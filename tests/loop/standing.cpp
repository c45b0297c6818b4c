#include "scenes.hpp"

#include "catch.hpp"

namespace standing_tests {

using namespace scenes;

namespace {

template <class Policy>
Standing stand_ten(const Shape& shape, Policy stabilisation) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     AcceleratedGaussSeidel{.tolerance = 1e-6}, stabilisation};
  const auto boxes = add_stack(rigid_bodies(loop), 10, shape);
  return stand(loop, boxes.back());
}

/// A residual of 1e-6 leaves velocities of about 1e-6 h g = 2e-7 m/s a step, which the next step sees and takes back:
/// the energy is that of ten masses at ten times that speed, 2e-11 J by a margin of 500. The top drifts by what adds up in
/// ten seconds without being taken back, 2e-6 m, by a margin of 1000; and contacts are 0.5 mm deep at most by claim.
void check(const Standing& seen) {
  CHECK(seen.unconverged == 0);
  CHECK(seen.residual <= 1e-6);
  CHECK(seen.drift < 2e-3);
  CHECK(seen.penetration < 5e-4);
  CHECK(seen.kinetic_energy < 1e-8);
}

}  // namespace

TEST_CASE("ten boxes stand for a minute when the whole violation is corrected") {
  check(stand_ten(Box{1, 1, 1}, WholeViolation{}));
}
TEST_CASE("ten boxes stand for a minute under Baumgarte's rate") { check(stand_ten(Box{1, 1, 1}, Baumgarte{})); }
TEST_CASE("ten boxes stand for a minute when positions are projected") {
  check(stand_ten(Box{1, 1, 1}, PositionProjection{}));
}
TEST_CASE("ten cubes given as points stand for a minute") { check(stand_ten(cube_of_points(), Baumgarte{})); }
TEST_CASE("ten cylinders stand for a minute") { check(stand_ten(Cylinder{0.5, 1}, Baumgarte{})); }

}  // namespace standing_tests
