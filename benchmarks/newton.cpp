// A warm step of standing stacks under Newton's method: the step by stage, and its factorizations.
#include "scenes.hpp"

#include <delassus/solvers/proximal_newton.hpp>

#include <algorithm>

using namespace scenes;

namespace {

/// `range(0)` boxes of 1 kg; the top one has 10^`range(1)` kg.
void standing_under_newton(benchmark::State& state) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, ProximalNewton{}, Stopwatch{1}};
  auto& set = bodies<RigidBodies>(loop.world());
  const int count = int(state.range(0));
  add_stack(set, count - 1);
  set.add({.position = {0, 0, count - 0.5}, .mass = std::pow(10.0, double(state.range(1))), .shape = Box{1, 1, 1}});
  for (int i = 0; i < 60; ++i) loop.step(1.0 / 60);
  step_by_stage(state, loop, 1.0 / 60);
  int factorizations = 0;
  for (const SolveReport& r : loop.island_reports()) factorizations = std::max(factorizations, r.factorizations);
  state.counters["factorizations"] = factorizations;
}
BENCHMARK(standing_under_newton)->Args({10, 0})->Args({100, 0})->Args({2, 6})->Unit(benchmark::kMicrosecond);

}  // namespace
