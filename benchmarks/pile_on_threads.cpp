// Piles of spheres, one island each, and two hundred stacks of ten boxes, on several threads: whole steps by the
// clock on the wall. The last argument is the number of threads, on which the label, of the bits, does not depend.
#include "scenes.hpp"

#include <delassus/adapters/tbb.hpp>
#include <delassus/io/state_hash.hpp>
#include <delassus/solvers/coloured.hpp>

#include <cmath>
#include <string>

using namespace scenes;

namespace {

template <class Loop>
void step_on_the_wall(benchmark::State& state, Loop loop, double h) {
  for (auto _ : state) benchmark::DoNotOptimize(loop.step(h));
  state.SetLabel(std::to_string(state_hash(loop)));
}

/// The arguments: spheres along an edge, the tolerance as its negative power of ten.
void spheres(benchmark::State& state) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     Coloured{AcceleratedGaussSeidel{.tolerance = std::pow(10., -double(state.range(1)))}},
                     Threads{int(state.range(2))}};
  add_pile(bodies<RigidBodies>(loop.world()), int(state.range(0)));
  step_on_the_wall(state, std::move(loop), 5e-3);
}

/// Stacks whose boxes are a little off centre and hop, so that their islands have work.
void stacks(benchmark::State& state) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, Threads{int(state.range(0))}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 10; ++j)
      for (int k = 0; k < 10; ++k)
        rigid.add({.position = {3. * i + 0.02 * ((k * 7 + i * 3 + j * 5) % 5 - 2), 3. * j, 0.51 + 1.01 * k}, .mass = 1.0, .shape = Box{1, 1, 1}});
  step_on_the_wall(state, std::move(loop), 5e-3);
}

BENCHMARK(spheres)
    ->Name("spheres_on_threads")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->ArgsProduct({{10}, {1, 2}, {1, 2}})
    ->Iterations(100);
BENCHMARK(spheres)
    ->Name("spheres_on_threads")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->ArgsProduct({{20}, {1, 2}, {1, 2}})
    ->Iterations(40);
BENCHMARK(stacks)->Name("stacks_on_threads")->Unit(benchmark::kMillisecond)->UseRealTime()->Arg(1)->Arg(2)->Iterations(100);

}  // namespace
