// What a step says of itself, where its time goes, how its solve converged, and why a body was stopped.
// prints: quarantined: rigid body #1.*not finite
#include <delassus/delassus.hpp>

#include <algorithm>
#include <cstdio>
#include <limits>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, Stopwatch{},
                     ConvergenceRecord{}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  RigidBodies::Handle bottom;
  for (int i = 0; i < 10; ++i) {
    const auto box = rigid.add({.position = {0, 0, 0.5 + i}, .mass = 1.0, .shape = Box{1, 1, 1}});
    if (i == 0) bottom = box;
  }

  StepReport worst;
  for (int i = 0; i < 200; ++i) {
    const StepReport report = loop.step(5e-3);
    if (report.status > worst.status || report.residual > worst.residual) worst = report;
  }
  std::printf("worst %s at %.3f s: %d sweeps, residual %.1e, overlap %.1e m\n", name(worst.status), worst.time,
              worst.sweeps, worst.residual, worst.max_penetration);
  for (const SolveReport& island : loop.island_reports())
    std::printf("island: %s, %d sweeps, %d factorizations, ended by %s\n", name(island.status), island.sweeps,
                island.factorizations, island.ended_by);

  loop.get<Stopwatch>().print();  // ms of each stage, mean of all steps

  const auto& record = loop.get<ConvergenceRecord>();  // of the last step
  for (const auto& sweep : record.sweeps())
    std::printf("island %d, sweep %d: residual %.1e\n", sweep.island, sweep.sweep, sweep.measure.residual);
  const auto& rows = record.constraints();
  const auto worst_row = std::max_element(rows.begin(), rows.end(), [](const auto& p, const auto& q) { return p.error < q.error; });
  if (worst_row != rows.end()) std::printf("worst constraint: pool %d, item %d\n", worst_row->pool, worst_row->item);

  rigid.apply_force(bottom, {0, 0, std::numeric_limits<double>::max()});
  rigid.apply_force(bottom, {0, 0, std::numeric_limits<double>::max()});  // the sum is infinite
  loop.step(5e-3);
  std::printf("%s: %s\n", name(loop.report().status), why_quarantined(loop).c_str());
}
