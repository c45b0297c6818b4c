// Twenty links on ball joints, released horizontally, swing and whip.
#include "hanging_chain.hpp"
#include "measure.hpp"

namespace demonstration {

Scene chain(bool is_quick, const Watch& watch) {
  const double h = 1.0 / 2400, seconds = is_quick ? 0.25 : 8;
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{BallJoint{}},
                     ImplicitMidpoint{},
                     PositionProjection{.rate = 1},
                     AcceleratedGaussSeidel{.tolerance = 1e-8},
                     StepTime{},
                     Stopwatch{},
                     Recorder{"Hanging chain",
                              "Twenty links on ball joints, released horizontally. Ideal joints do no "
                              "work: by the midpoint rule, with gaps closed by position "
                              "projection, the energy stays."}};
  add_hanging_chain(loop);
  Scene scene = measure(loop, "none", h, seconds, watch);

  scene.expect_below(1e3 * scene.max_joint_gap, 1, "the widest joint gap", "mm");
  // Of 245 J that the links can lose.
  scene.expect_below(scene.energy_rise(), 0.1, "the largest rise of the energy", "J");
  scene.expect_below(std::abs(scene.energy_lost()), 0.1, "the change of energy", "J");
  return scene;
}

}  // namespace demonstration
