// The parts of a loop that stand for the fields of SOFA's ConstraintAnimationLoop.
// prints: converged; [0-9]+ sweeps recorded, [0-9]+ constraints; box at 0\.5000 m
#include <delassus/delassus.hpp>

#include <cstdio>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Contact{Coulomb{.friction = 0.6}}},
                     GaussSeidel{.tolerance = 1e-5, .max_iterations = 1000, .relaxation = 1.0},
                     Stopwatch{},              // displayTime
                     ConvergenceRecord{true},  // graphErrors, graphConstraints, graphForces
                     DoubleBuffer{}};          // doubleBuffer
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  const auto box = rigid.add({.position = {0, 0, 0.5}, .mass = 1, .shape = Box{1, 1, 1}});

  StepReport report;
  for (int i = 0; i < 100; ++i) report = loop.step(0.01);
  const auto& record = loop.get<ConvergenceRecord>();
  std::printf("%s; %zu sweeps recorded, %zu constraints; box at %.4f m\n", name(report.status), record.sweeps().size(),
              record.constraints().size(), rigid.position(box).z());

  auto problem = loop.problem();  // getConstraintProblem
  solve(problem, AcceleratedGaussSeidel{.tolerance = 1e-9});
}
