// Twenty links on ball joints, released horizontally, swing and whip.
#include "measure.hpp"

namespace demonstration {

Scene chain(bool is_quick, const Watch& watch) {
  const double h = 1.0 / 2400, seconds = is_quick ? 0.25 : 8;
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, ImplicitMidpoint{},
                     PositionProjection{.rate = 1}, AcceleratedGaussSeidel{.tolerance = 1e-8}, StepTime{},
                     Stopwatch{},
                     Recorder{"Hanging chain", "Twenty links on ball joints, released horizontally. Ideal joints do no "
                                               "work: by the midpoint rule, with gaps closed by position "
                                               "projection, the energy stays."}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const double length = 0.25, radius = 0.06;
  const Quat lying(Eigen::AngleAxisd(EIGEN_PI / 2, Vec3::UnitY()));
  Anchor end = world_anchor({0, 0, 5.5});
  for (int k = 0; k < 20; ++k) {
    const auto link = rigid.add({.position = {length * (k + 0.5), 0, 5.5},
                                 .orientation = lying,
                                 .mass = 0.5,
                                 .shape = Capsule{radius, length - 2 * radius}});
    loop.add(BallJoint::Item{end, anchor(rigid, link, {0, 0, -length / 2})});
    end = anchor(rigid, link, {0, 0, length / 2});
  }
  Scene scene = measure(loop, "none", h, seconds, watch);

  scene.expect_below(1e3 * scene.max_joint_gap, 1, "the widest joint gap", "mm");
  // Of 245 J that the links can lose.
  scene.expect_below(scene.energy_rise(), 0.1, "the largest rise of the energy", "J");
  scene.expect_below(std::abs(scene.energy_lost()), 0.1, "the change of energy", "J");
  return scene;
}

}  // namespace demonstration
