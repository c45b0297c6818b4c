// A stack under too few sweeps, and then a force that is not a number: what the reports say.
// prints: rigid body #10: the force or torque it was given for this step is not finite
#include <delassus/delassus.hpp>

#include <algorithm>
#include <cstdio>
#include <limits>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Contact{Coulomb{.friction = 0.6}}},
                     AcceleratedGaussSeidel{.tolerance = 1e-6, .max_iterations = 5}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  RigidBodies::Handle top;
  for (int i = 0; i < 10; ++i)
    top = rigid.add({.position = {0, 0, 0.5 + i}, .mass = 1.0, .shape = Box{1, 1, 1}});

  int unconverged = 0;
  double residual = 0, depth = 0;
  for (int i = 0; i < 200; ++i) {
    const StepReport report = loop.step(5e-3);
    if (report.status != Status::converged) ++unconverged;
    residual = std::max(residual, report.residual);
    depth = std::max(depth, report.max_penetration);
  }
  std::printf("%d of 200 steps unconverged, residual up to %.1e, %.4f m deep\n", unconverged, residual, depth);
  for (const SolveReport& island : loop.island_reports())
    std::printf("%s after %d sweeps, ended by %s\n", name(island.status), island.sweeps, island.ended_by);

  rigid.apply_force(top, {0, 0, std::numeric_limits<double>::quiet_NaN()});
  if (loop.step(5e-3).status == Status::quarantined) std::puts(why_quarantined(loop).c_str());
}
