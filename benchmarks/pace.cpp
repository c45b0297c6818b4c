// How well a paced loop keeps its period when each step works for 40 % of it: ten seconds on the wall clock.
#include <delassus/delassus.hpp>
#include <delassus/listeners/real_time_pace.hpp>

#include <benchmark/benchmark.h>

using namespace delassus;

namespace {

/// Keeps the processor busy for so many seconds a step.
struct Busy {
  using plays = role::Listener;
  using listens = Listens<stage::Begin>;
  double seconds = 0;
  void after(stage::Begin, const auto&) const {
    const SteadyClock clock;
    for (const double end = clock.now() + seconds; clock.now() < end;) {}
  }
};

void paced(benchmark::State& state) {
  const double h = double(state.range(0)) * 1e-3;
  for (auto _ : state) {
    AnimationLoop loop{World{RigidBodies{}}, RealTimePace{1e9}, Busy{0.4 * h}};
    bodies<RigidBodies>(loop.world()).add({.mass = 1.0, .shape = Box{1, 1, 1}});
    for (long n = std::lround(10 / h); n > 0; --n) loop.step(h);
    const auto s = loop.get<RealTimePace>().statistics();
    state.counters["period/h"] = s.mean_period / h;
    state.counters["work p50 ms"] = 1e3 * s.p50;
    state.counters["work p99 ms"] = 1e3 * s.p99;
    state.counters["late"] = double(s.late);
    state.counters["worst ms"] = 1e3 * s.worst_lateness;
  }
}
BENCHMARK(paced)->Name("pace/40%_of_h/ms")->Arg(1)->Arg(10)->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
