// Piles and a wall of many bodies, whole steps from the start of the fall, stage by stage. The arguments:
// bodies along an edge (of a wall: rows), the solver's tolerance as its negative power of ten, and the step
// in tenths of a millisecond.
#include "scenes.hpp"
#include "siconos/contact_scenes.hpp"

using namespace scenes;

namespace {

template <class Add>
void steps_of(benchmark::State& state, Add add) {
  const int side = int(state.range(0));
  AnimationLoop loop{
      World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
      AcceleratedGaussSeidel{.tolerance = std::pow(10., -double(state.range(1))), .max_iterations = 4000},
      Stopwatch{}};
  add(bodies<RigidBodies>(loop.world()), side);
  step_by_stage(state, loop, 1e-4 * double(state.range(2)));
}

void spheres(benchmark::State& state) { steps_of(state, add_pile); }
void boxes(benchmark::State& state) {
  steps_of(state,
           [](RigidBodies& set, int side) { problems::add_boxes(set, side * side * side, 0.25 * side); });
}
void mixed(benchmark::State& state) {
  steps_of(state,
           [](RigidBodies& set, int side) { problems::add_mixed(set, side * side * side, 0.23 * side); });
}
void wall(benchmark::State& state) {
  steps_of(state, [](RigidBodies& set, int rows) { problems::add_wall(set, rows, 2 * rows); });
}

/// A thousand bodies: quick games, exact contacts, tight ones.
void thousand(benchmark::internal::Benchmark* b) {
  b->Unit(benchmark::kMillisecond)
      ->Args({10, 1, 167})
      ->Args({10, 2, 167})
      ->Args({10, 3, 50})
      ->Args({10, 4, 50});
}
BENCHMARK(spheres)->Apply(thousand)->Iterations(200);
BENCHMARK(boxes)->Apply(thousand)->Iterations(60);
BENCHMARK(mixed)->Apply(thousand)->Iterations(60);
BENCHMARK(wall)
    ->Unit(benchmark::kMillisecond)
    ->Args({17, 1, 167})
    ->Args({17, 2, 50})
    ->Args({17, 3, 50})
    ->Iterations(60);
/// Eight thousand, and how the cost of a step grows with their number.
BENCHMARK(spheres)
    ->Name("spheres_growth")
    ->Unit(benchmark::kMillisecond)
    ->ArgsProduct({{5, 10, 20}, {1, 3}, {50}})
    ->Iterations(90);

}  // namespace
