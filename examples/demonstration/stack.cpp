// Ten boxes on each other, a little off centre, come to rest and stay.
#include "measure.hpp"

#include "stack_of_boxes.hpp"

namespace demonstration {

Scene stack(bool is_quick, const Watch& watch) {
  const double h = 1.0 / 120, seconds = is_quick ? 0.5 : 6;
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.6}}},
                     AcceleratedGaussSeidel{.tolerance = 1e-6}, StepTime{}, Stopwatch{},
                     Recorder{"Stack of ten", "Ten boxes of one metre, set down a little off centre, stand still: at "
                                              "the bottom each contact carries a quarter of all ten."}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const auto top = add_stack_of_boxes(rigid);
  const Vec3 start = rigid.position(top);
  Scene scene = measure(loop, "native", h, seconds, watch);

  scene.expect_below(std::abs(scene.mean_contacts - 40), 0.5, "the difference from four contacts a box", "");
  scene.expect_below(1e3 * (rigid.position(top) - start).norm(), 2, "the drift of the top box", "mm");
  scene.expect_below(1e3 * scene.max_penetration, 10, "the largest penetration", "mm");
  scene.expect_below(scene.energy_rise(), 1e-2, "the largest rise of the energy", "J");
  if (!is_quick) scene.expect_below(scene.kinetic_energy, 1e-6, "the kinetic energy at the end", "J");
  return scene;
}

}  // namespace demonstration
