#include "tool_scene.hpp"

#include "catch.hpp"

using namespace tool_scene;

TEST_CASE("a loop in single precision feeds a device") {
  Scene<RigidBodiesF> s({-0.2, 0, 0.5});
  s.set().gravity.setZero();
  s.step({-0.2, 0, 0.5});
  const double x = 0.003;
  const HapticForce f = s.haptics().tick({.position = {-0.2 + x, 0, 0.5}});
  // As in double: the spring, the damper and the mass m/h² in series. Places of 0.2 m are kept to 1.5e-8 m, 5e-6 of x.
  const double W = 1 / s.mass, R = 1 / (h * h * s.k + h * s.c);
  CHECK(f.force.x() == Approx(-x * s.k / (h * s.k + s.c) / (W + R) / h).epsilon(2e-5));

  Scene<RigidBodiesF> pressed({-0.2, 0, 0.01});
  for (int n = 0; n < 100; ++n) pressed.step({-0.2, 0, 0.009});
  // k times the depth; a place of 0.2 m (the tool's x) is kept to 1.5e-8 m, of 0.01 m better, and the ground gives way by what
  // the solve leaves, 1e-6 of 1 m/s for one step: 2e-8 m each of 800 N/m.
  CHECK(pressed.haptics().tick({.position = {-0.2, 0, 0.005}}).force.z() == Approx(800 * 0.005).margin(1e-3));
}
