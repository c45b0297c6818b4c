// The standing stack with FCL: what its step and its solve cost. Never built with -march=native: FCL from a package is not.
#include "scenes.hpp"

#include <delassus/adapters/fcl.hpp>

using namespace scenes;

namespace {

template <class Stabilisation>
void standing_stack_fcl(benchmark::State& state) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.6}}}, FclCollision{.margin = 0.01},
                     AcceleratedGaussSeidel{.tolerance = 1e-6}, Stabilisation{}, Stopwatch{1}};
  add_stack(bodies<RigidBodies>(loop.world()), int(state.range(0)));
  for (int i = 0; i < 300; ++i) loop.step(1.0 / 60);
  step_by_stage(state, loop, 1.0 / 60);
}
BENCHMARK(standing_stack_fcl<WholeViolation>)->Arg(10)->Unit(benchmark::kMillisecond);
BENCHMARK(standing_stack_fcl<Baumgarte>)->Arg(10)->Unit(benchmark::kMillisecond);

}  // namespace
