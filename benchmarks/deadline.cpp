// How late a solve with a deadline returns, and how much nearer to the laws a prediction brings an inexact W.
#include <delassus/compliance/uncoupled.hpp>

#include "scenes.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <span>
#include <vector>

using namespace scenes;

namespace {

/// How often the system has taken the processor from this thread.
long preemptions() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_nivcsw;
}

/// A tower of boxes in the first step of its fall: no tolerance ends this solve, the deadline does, but for ten boxes whose error Newton's
/// stage brings down to rounding. What the system adds when it runs another program meanwhile is not the solve's: those calls are counted,
/// and the rest has figures of its own.
template <class Solver>
void lateness(benchmark::State& state) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, GaussSeidel{.max_iterations = 0}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(HalfSpace{});
  for (int i = 0; i < int(state.range(0)); ++i)
    set.add({.position = {1e-3 * (i % 2), 0, 0.5 + i}, .mass = 1.0, .shape = Box{1, 1, 1}});
  loop.step(1.0 / 60);
  const auto start = loop.problem();
  const SteadyClock clock;
  const double budget = std::max(1e-3, 5e-6 * double(state.range(0)));  // of a thousand boxes a sweep alone takes half a millisecond
  std::vector<double> late, undisturbed;
  for (auto _ : state) {
    auto problem = start;
    const long before = preemptions();
    const double deadline = clock.now() + budget;
    const SolveReport r = solve_until(problem, Solver{.tolerance = 0, .max_iterations = 1 << 30}, deadline);
    late.push_back(clock.now() - deadline);
    if (preemptions() == before) undisturbed.push_back(late.back());
    benchmark::DoNotOptimize(r);
  }
  std::sort(late.begin(), late.end());
  state.counters["p50 us"] = 1e6 * late[late.size() / 2];
  state.counters["p99 us"] = 1e6 * late[late.size() * 99 / 100];
  state.counters["max us"] = 1e6 * late.back();
  state.counters["preempted"] = double(late.size() - undisturbed.size());
  if (undisturbed.empty()) return;
  std::sort(undisturbed.begin(), undisturbed.end());
  state.counters["p99 us undisturbed"] = 1e6 * undisturbed[undisturbed.size() * 99 / 100];
  state.counters["max us undisturbed"] = 1e6 * undisturbed.back();
}
void towers(benchmark::internal::Benchmark* b) { b->Arg(10)->Arg(100)->Iterations(2000)->Unit(benchmark::kMillisecond); }
void high_tower(benchmark::internal::Benchmark* b) { b->Arg(1000)->Iterations(500)->Unit(benchmark::kMillisecond); }
BENCHMARK(lateness<AcceleratedSweeps>)->Name("deadline/lateness/sweeps/boxes")->Apply(towers);
BENCHMARK(lateness<AcceleratedSweeps>)->Name("deadline/lateness/sweeps/boxes")->Apply(high_tower);
BENCHMARK(lateness<AcceleratedGaussSeidel>)->Name("deadline/lateness/boxes")->Apply(towers);
BENCHMARK(lateness<AcceleratedGaussSeidel>)->Name("deadline/lateness/boxes")->Apply(high_tower);

/// Two rods hold a string of particles on springs: the farthest a particle is from where the exact W puts it, m.
template <class Compliance, class Scheme>
std::vector<Vec3> path(int sweeps) {
  AnimationLoop loop{World{Particles{}}, Constraints{DistanceJoint{}}, ImplicitEuler{}, Compliance{}, Scheme{},
                     GaussSeidel{.tolerance = 0, .max_iterations = sweeps}};
  auto& set = bodies<Particles>(loop.world());
  std::vector<Particles::Handle> p;
  for (int i = 0; i < 8; ++i) p.push_back(set.add({.position = {0.2 * i, 0, 0}, .mass = 0.1}));
  for (int i = 0; i + 1 < 8; ++i) set.add_spring(p[i], p[i + 1], 50, 0.5, 0.2);
  loop.add(DistanceJoint::Item{anchor(set, p[0]), world_anchor({0, 0, 0.5}), 0.5});
  loop.add(DistanceJoint::Item{anchor(set, p[7]), world_anchor({1.4, 0, 0.5}), 0.5});
  std::vector<Vec3> path;
  for (int n = 0; n < 200; ++n) {
    loop.step(0.01);
    path.push_back(set.position(p[7]));
  }
  return path;
}
template <class Scheme>
void inexact(benchmark::State& state) {
  const int sweeps = int(state.range(0));
  const std::vector<Vec3> exact = path<AssembledCompliance, PlainOrder>(200);
  double worst = 0;
  for (auto _ : state) {
    const std::vector<Vec3> mine = path<UncoupledCompliance, Scheme>(sweeps);
    for (std::size_t n = 0; n < exact.size(); ++n) worst = std::max(worst, (mine[n] - exact[n]).norm());
  }
  state.counters["error m"] = worst;
}
BENCHMARK(inexact<PlainOrder>)->Name("uncoupled/plain/sweeps")->Arg(1)->Arg(4)->Arg(20)->Unit(benchmark::kMillisecond);
BENCHMARK(inexact<PredictiveScheme>)->Name("uncoupled/predictive/sweeps")->Arg(1)->Arg(4)->Arg(20)->Unit(benchmark::kMillisecond);

}  // namespace
