// A thousand stacks of ten boxes with a thousand frictions. The argument is the number of workers;
// `hashes_equal` is 1 where all worlds have the bits of one worker. Whole runs of fifty steps, loops made by
// who runs them, and steps in turn of loops that are all there.
#include "scenes.hpp"

#include <delassus/adapters/tbb.hpp>
#include <delassus/study/batch.hpp>
#include <delassus/study/ensemble.hpp>

#include <vector>

using namespace scenes;

namespace {

auto make_stack(double friction) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = friction}}}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.gravity = 9.81 * Vec3(0.3, 0, -1).normalized();  // some slide, some stay
  add_stack(rigid, 10);
  return loop;
}

std::vector<double> frictions() {
  std::vector<double> list;
  for (int i = 0; i < 1000; ++i) list.push_back(0.1 + 0.5e-3 * i);
  return list;
}

EnsembleResults run(const Ensemble<decltype(&make_stack), double>& ensemble, const Threads& threads) {
  const EnsemblePlan plan{
      .name = "stacks", .steps = 50, .h = 5e-3, .observations = {"top (m)"}, .is_quiet = true};
  return ensemble.run(
      plan,
      [](const auto& loop) {
        const auto& rigid = bodies<RigidBodies>(loop.world());
        return rigid.position(rigid.handle(10)).x();
      },
      threads);
}

void whole_runs(benchmark::State& state) {
  const Ensemble ensemble{&make_stack, frictions()};
  const EnsembleResults alone = run(ensemble, Threads(1));
  const Threads threads(int(state.range(0)));
  bool is_equal = true;
  for (auto _ : state) {
    const EnsembleResults results = run(ensemble, threads);
    for (std::size_t i = 0; i < alone.runs.size(); ++i)
      is_equal = is_equal && results.runs[i].hash == alone.runs[i].hash;
  }
  state.counters["hashes_equal"] = is_equal;
  state.counters["steps"] = benchmark::Counter(50e3, benchmark::Counter::kIsIterationInvariantRate);
}

void steps_in_turn(benchmark::State& state) {
  Batch batch{make_stack, frictions(), Threads(int(state.range(0)))};
  for (auto _ : state) {
    state.PauseTiming();
    batch.reset();
    state.ResumeTiming();
    for (int n = 0; n < 50; ++n) batch.step(5e-3);
  }
  state.counters["steps"] = benchmark::Counter(50e3, benchmark::Counter::kIsIterationInvariantRate);
}

BENCHMARK(whole_runs)
    ->Name("ensemble/whole_runs")
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(steps_in_turn)
    ->Name("ensemble/steps_in_turn")
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
