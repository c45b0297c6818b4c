// A ball falls on a soft beam.
#include "measure.hpp"

#include <delassus/bodies/elasticity/corotational.hpp>
#include <delassus/bodies/tetrahedral_fem.hpp>
#include <delassus/compliance/lazy.hpp>
#include <delassus/geometry/box_mesh.hpp>

namespace demonstration {

Scene soft_beam(bool is_quick, const Watch& watch) {
  using Soft = TetrahedralFem<Corotational>;
  const double h = 0.01, seconds = is_quick ? 0.3 : 4;
  AnimationLoop loop{
      World{RigidBodies{}, Soft{}},
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
  auto& soft = bodies<Soft>(loop.world());
  const auto beam = soft.add(
      {.mesh = box_mesh({1, 0.16, 0.08}, {16, 4, 2}), .elasticity = {.young = 2e5}, .contact_radius = 0.01});
  soft.fix(beam, [](const Vec3& x) { return x.x() < 1e-9 || x.x() > 1 - 1e-9; });
  const auto ball = rigid.add({.position = {0.5, 0.08, 0.3}, .mass = 2, .shape = Sphere{0.08}});
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
