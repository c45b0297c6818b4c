// A ball falls on a soft beam.
#include "measure.hpp"
#include "soft_beam.hpp"

#include <delassus/compliance/lazy.hpp>

namespace demonstration {

Scene soft_beam(bool is_quick, const Watch& watch) {
  const double h = 0.01, seconds = is_quick ? 0.3 : 4;
  AnimationLoop loop{
      World{RigidBodies{}, SoftBodies{}},
      Constraints{Contact{Coulomb{.friction = 0.8}}},
      ImplicitEuler{.rayleigh_stiffness = 0.005},
      LazyCompliance{},
      NativeCollision{.margin = 0.05},
      StepTime{},
      Stopwatch{},
      Recorder{"Soft beam",
               "A ball of 2 kg falls on a beam that is clamped at both ends. One factor of its "
               "matrix serves many steps, turned with the nodes.",
               20}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const auto ball = add_soft_beam(loop);
  double violation = 0, deepest = 0;
  int factorizations = 0;
  Scene scene = measure(loop, "native", h, seconds, watch, [&](double) {
    const ComplianceReport& report = loop.template get<LazyCompliance>().report;
    violation = std::max(violation, report.violation);
    factorizations += report.factorizations;
    deepest = std::min(deepest, rigid.position(ball).z() - 0.17);
  });
  scene.expect_below(1e6 * violation, 10.001, "the largest violation of a row", "µm");
  if (!is_quick) {
    scene.expect_below(1e3 * deepest, -10, "how deep the ball pressed the beam, negative,", "mm");
    scene.expect_below(std::abs(rigid.position(ball).x() - 0.5), 0.1, "how far the ball rolled", "m");
    scene.expect_below(factorizations, scene.steps / 2, "the number of factorizations", "");
  }
  return scene;
}

}  // namespace demonstration
