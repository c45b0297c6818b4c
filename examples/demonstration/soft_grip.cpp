// Two soft cubes, each lifted by two fingers: one with friction just above what holds it, one just below.
#include "measure.hpp"
#include "soft_grip.hpp"

namespace demonstration {

Scene soft_grip(bool is_quick, const Watch& watch) {
  const double h = 0.01, seconds = is_quick ? 0.2 : 3;
  AnimationLoop loop{World{RigidBodies{}, SoftBodies{}},
                     Constraints{Contact{Coulomb{}}, Slider{}},
                     ImplicitEuler{.rayleigh_stiffness = 0.01},
                     StepTime{},
                     Stopwatch{},
                     Recorder{"Soft grip",
                              "Fingers press two soft cubes with 20 N each and lift them. Friction holds "
                              "from μ = m g/(2 N) on: 5 % above it does, 5 % below it does not.",
                              20}};
  SoftGrip grip(loop);
  Scene scene = measure(loop, "native", h, seconds, watch, [&](double time) { grip.drive(time); });
  if (!is_quick) {
    scene.expect_below(1e3 * std::abs(grip.slip(0)), 1, "the slip of the cube that is held", "mm");
    scene.expect_below(-1e3 * grip.slip(1), -50, "less the slip of the cube that is not", "mm");
  }
  return scene;
}

}  // namespace demonstration
