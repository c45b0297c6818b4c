// A needle goes into soft tissue, and is tilted there.
#include "measure.hpp"
#include "needle.hpp"

namespace demonstration {

Scene needle(bool is_quick, const Watch& watch) {
  const double h = 0.01, seconds = is_quick ? 0.5 : 6;
  AnimationLoop loop{World{RigidBodies{}, SoftBodies{}},
                     Constraints{PointOnLine{}},
                     ImplicitEuler{.rayleigh_stiffness = 0.01},
                     StepTime{},
                     Stopwatch{},
                     Recorder{"Needle",
                              "A needle is pushed 6 cm into tissue and then tilted by 10°. Every centimetre "
                              "a point of the tissue that the tip passed is held on its axis.",
                              20}};
  NeedleInTissue needle(loop);
  Scene scene = measure(loop, "none", h, seconds, watch, [&](double time) { needle.drive(time); });
  scene.expect_below(1e3 * scene.max_joint_gap, 1, "the largest distance of a held point from the needle",
                     "mm");
  if (!is_quick) scene.expect_below(-double(needle.held()), -5, "less the number of held points", "");
  return scene;
}

}  // namespace demonstration
