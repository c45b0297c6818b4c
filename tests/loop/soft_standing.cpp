#include "scenes.hpp"

#include "catch.hpp"

namespace soft_standing_tests {

using namespace scenes;

namespace {

/// How deep the lowest corner contacts of `count` unit cubes of 1 kg lie in each other at rest, by the definition of the
/// stiffness, k = m_eff ω², m_eff = 1/W_nn. For a corner at (½, ½, ½) of a cube with I = m/6, W = 1/m + |r × n|²/I = 4/m;
/// it is that on the ground and twice that between two cubes. Four corners carry N g: sag = N g W/(4 ω²).
double expected_height(int count, double omega) {
  double height = count - 0.5;
  for (int below = 0; below < count; ++below) {
    const double carried = (count - below) * g, W = below == 0 ? 4 : 8;
    height -= carried * W / (4 * omega * omega);
  }
  return height;
}

double height_at_rest(int count, double frequency, double seconds) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     AcceleratedGaussSeidel{.tolerance = 1e-9}, SoftContact{.frequency = frequency}};
  const auto boxes = add_stack(rigid_bodies(loop), count, Box{1, 1, 1}, 0);
  stand(loop, boxes.back(), seconds);
  return rigid_bodies(loop).position(boxes.back()).z();
}

}  // namespace

// The steady state of implicit Euler is the spring's own, whatever h. The solver leaves 1e-9 of the velocities h g, and a
// velocity error v moves the equilibrium by about v/(h ω²) (2ζ + h ω): 1e-10 m.
TEST_CASE("a soft contact sags by the weight over its stiffness") {
  for (const double frequency : {15.0, 30.0, 60.0, 240.0}) {
    CAPTURE(frequency);
    const double omega = 2 * M_PI * frequency;
    REQUIRE(height_at_rest(1, frequency, 5) == Approx(expected_height(1, omega)).epsilon(0).margin(1e-8));
    REQUIRE(height_at_rest(3, frequency, 20) == Approx(expected_height(3, omega)).epsilon(0).margin(1e-7));
  }
}

TEST_CASE("ten boxes on soft contacts sag by what each of them carries") {
  const double omega = 2 * M_PI * 60;
  REQUIRE(height_at_rest(10, 60, 60) == Approx(expected_height(10, omega)).epsilon(0).margin(1e-6));
}

}  // namespace soft_standing_tests
