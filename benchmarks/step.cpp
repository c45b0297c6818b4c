// One step by stage: ten standing boxes, and a pile of a thousand spheres. Native collision.
#include "scenes.hpp"

using namespace scenes;

namespace {

template <class Stabilisation>
void standing_stack(benchmark::State& state) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.6}}}, Stabilisation{}, Stopwatch{1}};
  add_stack(bodies<RigidBodies>(loop.world()), int(state.range(0)));
  for (int i = 0; i < 200; ++i) loop.step(1.0 / 60);
  step_by_stage(state, loop, 1.0 / 60);
}
BENCHMARK(standing_stack<WholeViolation>)->Arg(10)->Unit(benchmark::kMillisecond);
BENCHMARK(standing_stack<Baumgarte>)->Arg(10)->Unit(benchmark::kMillisecond);

/// The argument is the edge of the pile: 10 is a thousand spheres.
template <class Stabilisation>
void pile_of_spheres(benchmark::State& state) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     AcceleratedGaussSeidel{.tolerance = 1e-2}, Stabilisation{}, Stopwatch{1}};
  add_pile(bodies<RigidBodies>(loop.world()), int(state.range(0)));
  for (int i = 0; i < 100; ++i) loop.step(5e-3);
  step_by_stage(state, loop, 5e-3);
}
BENCHMARK(pile_of_spheres<Baumgarte>)->Arg(10)->Unit(benchmark::kMillisecond)->Iterations(50);
BENCHMARK(pile_of_spheres<SoftContact>)->Arg(10)->Unit(benchmark::kMillisecond)->Iterations(50);

}  // namespace
