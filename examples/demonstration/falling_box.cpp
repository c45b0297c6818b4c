// A box thrown up tumbles about its middle axis and falls: no constraint, no collision, no solver.
#include "measure.hpp"

namespace demonstration {

Scene falling_box(bool is_quick, const Watch& watch) {
  const double h = 1.0 / 240, seconds = is_quick ? 0.25 : 1.6;
  AnimationLoop loop{World{RigidBodies{}}, ImplicitMidpoint{}, StepTime{}, Stopwatch{},
                     Recorder{"Falling box", "Thrown up and left alone: a loop without constraints compiles none of "
                                             "their stages. The middle axis is unstable, so the box flips; the "
                                             "midpoint rule keeps its energy."}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const Vec3 start(0, 0, 1);
  const double up = 0.5 * 9.81 * 1.6;  // back at the start when the scene ends
  const auto box = rigid.add({.position = start,
                              .velocity = {0, 0, up},
                              .angular_velocity = {0.2, 10, 0.1},
                              .mass = 2,
                              .shape = Box{1.5, 1, 0.4}});
  Scene scene = measure(loop, "none", h, seconds, watch);

  // The midpoint rule integrates a constant force exactly, and keeps the energy of each body.
  const double t = h * scene.steps, height = start.z() + up * t - 0.5 * 9.81 * t * t;
  scene.expect_below(std::abs(rigid.position(box).z() - height), 1e-9, "the distance from the parabola", "m");
  scene.expect_below(std::abs(scene.energy_lost()), 1e-8, "the change of energy", "J");
  return scene;
}

}  // namespace demonstration
