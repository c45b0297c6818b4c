// Blocks of different friction on one slope: below tan θ they slip as the parabola says, above it they stay.
#include "blocks_on_slope.hpp"
#include "measure.hpp"

namespace demonstration {

namespace {

/// How far symplectic Euler takes a block down the slope in `t` seconds of steps h, m.
double slide(double friction, double t, double h) {
  return 0.5 * 9.81 *
         std::max(0.0, std::sin(BlocksOnSlope::angle) - friction * std::cos(BlocksOnSlope::angle)) * t *
         (t + h);
}

}  // namespace

Scene slope(bool is_quick, const Watch& watch) {
  const double h = 1.0 / 240, seconds = is_quick ? 0.25 : 6, before_floor = 1.5;
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Contact{Coulomb{}}},
                     AcceleratedGaussSeidel{.tolerance = 1e-6},
                     StepTime{},
                     Stopwatch{},
                     Recorder{"Slope",
                              "Friction 0.1 to 0.5 on a slope of 20°, whose tangent is 0.364: three blocks "
                              "slip, two stay. Orange impulses slide, blue ones stick."}};
  const BlocksOnSlope blocks;
  blocks.add_to(loop);
  Scene scene = measure(loop, "native", h, seconds, watch);

  double error = 0;
  for (const RecordedFrame& frame : scene.recording.frames)
    for (std::size_t k = 0; k < blocks.frictions.size() && frame.time < before_floor; ++k) {
      const double gone = blocks.down.dot(frame.poses[blocks.first + k].position - blocks.start(k));
      error = std::max(error, std::abs(gone - slide(blocks.frictions[k], frame.time, h)));
    }
  scene.expect_below(1e3 * error, 0.1, "the distance from the parabola before the floor", "mm");
  scene.expect_below(1e3 * scene.max_penetration, 6, "the largest penetration", "mm");
  return scene;
}

}  // namespace demonstration
