// The stack of ten boxes again, at four tolerances: what accuracy costs, and what it buys.
#include "scene.hpp"
#include "stack_of_boxes.hpp"
#include "thread_time.hpp"

#include <delassus/delassus.hpp>

#include <algorithm>
#include <cmath>

namespace demonstration {

Table table_of_accuracy(bool is_quick, const Watch& watch) {
  const double h = 1.0 / 60;
  const int steps = is_quick ? 30 : 600;
  Table table{.title = "What accuracy costs: the stack of ten at four tolerances",
              .caption = "Steps of 1/60 s. The drift is how far the top box ends from where it was set; the "
                         "kinetic energy is what moves at the end. Solve times are of one processor core.",
              .columns = {"tolerance", "sweeps mean", "sweeps p95", "residual max", "drift of the top (mm)",
                          "kinetic energy at rest (J)", "solve median (ms)", "steps not converged"}};
  const double tolerances[] = {1e-3, 1e-5, 1e-7, 1e-9};
  for (int k = 0; k < 4; ++k) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.6}}},
                       AcceleratedGaussSeidel{.tolerance = tolerances[k]}, SolveTime{}};
    auto& rigid = bodies<RigidBodies>(loop.world());
    const auto top = add_stack_of_boxes(rigid);
    const Vec3 start = rigid.position(top);
    std::vector<double> sweeps;
    double residual = 0;
    int not_converged = 0;
    for (int i = 0; i < steps; ++i) {
      const StepReport report = loop.step(h);
      sweeps.push_back(report.sweeps);
      residual = std::max(residual, report.residual);
      not_converged += report.status != Status::converged;
      watch((k + double(i) / steps) / 4);
    }
    table.add({Cell(tolerances[k], 1), Cell(mean_of(sweeps)), Cell(quantile_of(sweeps, 0.95)), Cell(residual, 2),
               Cell(1e3 * (rigid.position(top) - start).norm()), Cell(kinetic_energy(rigid), 2),
               Cell(quantile_of(loop.get<SolveTime>().milliseconds(), 0.5)), not_converged});
  }
  return table;
}

}  // namespace demonstration
