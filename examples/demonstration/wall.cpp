// A wall of a hundred boxes, hit by a heavy ball.
#include "measure.hpp"
#include "wall_of_boxes.hpp"

namespace demonstration {

Scene wall(bool is_quick, const Watch& watch) {
  const double h = 1.0 / 240, seconds = is_quick ? 0.15 : 5;
  // The margin is as long as the way of the ball in a step: boxes that it throws meet their neighbours in
  // that step. To 1e-4 of speeds
  // and masses like the ball's a light box may be a centimetre off in a step: overlaps are 2 to 10 mm, as the
  // run chances; with 3e-5 they were 1.8 to 2.5 at four margins.
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Contact{Coulomb{.friction = 0.5}}},
                     NativeCollision{.margin = 0.034},
                     AcceleratedGaussSeidel{.tolerance = 3e-5},
                     StepTime{},
                     Stopwatch{},
                     Recorder{"Wall", "A hundred boxes in running bond, hit by a ball of 1.4 t at 8 m/s."}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const auto boxes = add_wall_of_boxes(rigid);
  Scene scene = measure(loop, "native", h, seconds, watch);

  for (std::size_t b = 1; b <= boxes.size(); ++b) scene.recording.bodies[b].colour = (b - 1) / 10 % 2 ? 1 : 7;
  scene.recording.bodies.back().colour = 0;

  int fallen = 0;
  for (const auto box : boxes) fallen += rigid.position(box).x() > wall_depth;
  if (!is_quick) scene.expect_below(100 - fallen, 80, "the number of boxes left in place", "");
  scene.expect_below(1e3 * scene.max_penetration, 8, "the largest penetration", "mm");
  scene.expect_below(scene.energy_rise(), 1, "the largest rise of the energy", "J");
  return scene;
}

}  // namespace demonstration
