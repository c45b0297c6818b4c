// Scenes of the demonstration step by step: where Gauss-Seidel solves a step to 1e-10, whether the reference does, and how
// long it takes.
#include "scenes.hpp"

#include "../examples/demonstration/blocks_on_slope.hpp"
#include "../examples/demonstration/hanging_chain.hpp"
#include "../examples/demonstration/needle.hpp"
#include "../examples/demonstration/pile_of_shapes.hpp"
#include "../examples/demonstration/soft_beam.hpp"
#include "../examples/demonstration/soft_grip.hpp"
#include "../examples/demonstration/stack_of_boxes.hpp"
#include "../examples/demonstration/wall_of_boxes.hpp"

#include <delassus/compliance/lazy.hpp>
#include <delassus/problems/reference_check.hpp>

#include <algorithm>
#include <vector>

namespace {

using namespace delassus;
using demonstration::SoftBodies;

/// Steps 1 … `last` of a loop, every `every`-th of them compared; `drive(time)` before each.
template <class Loop, class Drive>
void compare(benchmark::State& state, Loop& loop, double h, int last, int every, const Drive& drive) {
  int compared = 0, swept = 0, agreed = 0;
  double slowest = 0;
  std::vector<double> apart;
  for (auto _ : state) {
    for (int n = 1; n <= last; ++n) {
      drive(h * (n - 1));
      loop.step(h);
      if (n % every != 0) continue;
      auto problem = loop.problem();
      ++compared;
      if (solve(problem, AcceleratedGaussSeidel{.tolerance = 1e-10, .max_iterations = 20000}).status != Status::converged) continue;
      ++swept;
      const SteadyClock clock;
      const double before = clock.now();
      const ReferenceCheck check = check_against_reference(problem);
      slowest = std::max(slowest, clock.now() - before);
      agreed += check.reached;
      apart.push_back(check.velocity);
    }
  }
  state.counters["steps"] = compared;
  state.counters["swept to 1e-10"] = swept;
  state.counters["and the reference"] = agreed;
  std::sort(apart.begin(), apart.end());
  state.counters["apart m/s"] = apart.empty() ? 0 : apart[apart.size() / 2];
  state.counters["apart at most"] = apart.empty() ? 0 : apart.back();
  state.counters["slowest s"] = slowest;
}
template <class Loop>
void compare(benchmark::State& state, Loop& loop, double h, int last, int every) {
  compare(state, loop, h, last, every, [](double) {});
}

auto rigid_loop(double friction, double tolerance, double margin = NativeCollision{}.margin) {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = friction}}},
                       NativeCollision{.margin = margin}, AcceleratedGaussSeidel{.tolerance = tolerance}};
}

void stack(benchmark::State& state) {
  auto loop = rigid_loop(0.6, 1e-6);
  demonstration::add_stack_of_boxes(bodies<RigidBodies>(loop.world()));
  compare(state, loop, 1.0 / 120, 720, 8);
}
void slope(benchmark::State& state) {
  auto loop = rigid_loop(0.5, 1e-6);
  demonstration::BlocksOnSlope{}.add_to(loop);
  compare(state, loop, 1.0 / 240, 1440, 12);
}
void chain(benchmark::State& state) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, ImplicitMidpoint{}, PositionProjection{.rate = 1},
                     AcceleratedGaussSeidel{.tolerance = 1e-8}};
  demonstration::add_hanging_chain(loop);
  compare(state, loop, 1.0 / 2400, 19200, 160);
}
void pile(benchmark::State& state) {
  auto loop = rigid_loop(0.4, 1e-4);
  demonstration::add_pile_of_shapes(bodies<RigidBodies>(loop.world()));
  compare(state, loop, 1.0 / 240, 360, 12);
}
/// The ball hits it in step 62. What a loose solve leaves of velocities wedges the boxes from step 3 on, so that it is also stepped
/// to 1e-10.
void wall(benchmark::State& state, double tolerance) {
  auto loop = rigid_loop(0.5, tolerance, 0.034);
  demonstration::add_wall_of_boxes(bodies<RigidBodies>(loop.world()));
  compare(state, loop, 1.0 / 240, int(state.range(0)), 1);
}
void soft_beam(benchmark::State& state) {
  AnimationLoop loop{World{RigidBodies{}, SoftBodies{}}, Constraints{Contact{Coulomb{.friction = 0.8}}},
                     ImplicitEuler{.rayleigh_stiffness = 0.005}, LazyCompliance{}, NativeCollision{.margin = 0.05}};
  demonstration::add_soft_beam(loop);
  compare(state, loop, 0.01, 400, 4);
}
void soft_grip(benchmark::State& state) {
  AnimationLoop loop{World{RigidBodies{}, SoftBodies{}}, Constraints{Contact{Coulomb{}}, Slider{}},
                     ImplicitEuler{.rayleigh_stiffness = 0.01}};
  demonstration::SoftGrip grip(loop);
  compare(state, loop, 0.01, 300, 3, [&](double time) { grip.drive(time); });
}
void needle(benchmark::State& state) {
  AnimationLoop loop{World{RigidBodies{}, SoftBodies{}}, Constraints{PointOnLine{}}, ImplicitEuler{.rayleigh_stiffness = 0.01}};
  demonstration::NeedleInTissue scene(loop);
  compare(state, loop, 0.01, 600, 6, [&](double time) { scene.drive(time); });
}

void once(benchmark::internal::Benchmark* b) { b->Iterations(1)->Unit(benchmark::kSecond); }
BENCHMARK(stack)->Name("reference/stack")->Apply(once);
BENCHMARK(slope)->Name("reference/slope")->Apply(once);
BENCHMARK(chain)->Name("reference/chain")->Apply(once);
BENCHMARK(pile)->Name("reference/pile")->Apply(once);
BENCHMARK(soft_beam)->Name("reference/soft_beam")->Apply(once);
BENCHMARK(soft_grip)->Name("reference/soft_grip")->Apply(once);
BENCHMARK(needle)->Name("reference/needle")->Apply(once);
BENCHMARK_CAPTURE(wall, as_shown, 3e-5)->Name("reference/wall/to_3e-5/steps")->Arg(150)->Apply(once);
BENCHMARK_CAPTURE(wall, tight, 1e-10)->Name("reference/wall/to_1e-10/steps")->Arg(61)->Arg(200)->Apply(once);

}  // namespace
