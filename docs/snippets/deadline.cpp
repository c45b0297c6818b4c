// Solves with a time budget: in a loop, and of a problem that was taken out of the loop.
// prints: again: [a-z_]+, residual [0-9.]+e[-+][0-9]+
#include <delassus/delassus.hpp>

#include <cstdio>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     WithDeadline{AcceleratedGaussSeidel{.tolerance = 1e-6}, 2e-3}};  // 2 ms for all islands of a step
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  for (int i = 0; i < 20; ++i) rigid.add({.position = {0, 0, 0.5 + i}, .mass = 1.0, .shape = Box{1, 1, 1}});

  int cut_off = 0;
  for (int i = 0; i < 100; ++i) {
    const StepReport report = loop.step(5e-3);
    cut_off += report.status == Status::deadline;
    if (i == 50) loop.policy<role::Solver>().budget = 1e-3;  // it stands: 1 ms from here on
  }
  std::printf("100 steps, %d of them cut off\n", cut_off);

  auto problem = loop.problem();  // of the last step: laws, rows, W and the impulses λ
  const AcceleratedGaussSeidel solver{.tolerance = 1e-10};
  SolverWorkspace<decltype(problem), WithDeadline<AcceleratedGaussSeidel>> workspace;  // the first solve allocates in it
  const SolveReport again = solve_until(problem, solver, SteadyClock{}.now() + 1e-3, workspace);
  std::printf("again: %s, residual %.1e\n", name(again.status), again.measure.residual);
}
