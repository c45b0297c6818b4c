// How late a solve with a deadline returns, and how much nearer to the laws a prediction brings an inexact W.
#include <delassus/compliance/uncoupled.hpp>

#include "scenes.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
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

/// Figures of how late the calls of a run were, s: of all, and of those during which no other program ran.
class Lateness {
 public:
  /// `call(deadline)` returns when it is done.
  template <class Call>
  void add(double budget, const Call& call) {
    const SteadyClock clock;
    const long before = preemptions();
    const double deadline = clock.now() + budget;
    call(deadline);
    all_.push_back(clock.now() - deadline);
    if (preemptions() == before) undisturbed_.push_back(all_.back());
  }
  void tell(benchmark::State& state) {
    std::sort(all_.begin(), all_.end());
    state.counters["p50 us"] = 1e6 * all_[all_.size() / 2];
    state.counters["p99 us"] = 1e6 * all_[all_.size() * 99 / 100];
    state.counters["max us"] = 1e6 * all_.back();
    state.counters["preempted"] = double(all_.size() - undisturbed_.size());
    if (undisturbed_.empty()) return;
    std::sort(undisturbed_.begin(), undisturbed_.end());
    state.counters["p99 us undisturbed"] = 1e6 * undisturbed_[undisturbed_.size() * 99 / 100];
    state.counters["max us undisturbed"] = 1e6 * undisturbed_.back();
  }

 private:
  std::vector<double> all_, undisturbed_;
};

/// A loop that only reads the clock: how late the machine itself makes whoever waits for a moment. What a host
/// does to its guests comes at regular times: budgets of one to two milliseconds do not run beside it.
void clock_alone(benchmark::State& state) {
  Lateness late;
  double share = 0;
  for (auto _ : state) {
    share = std::fmod(share + 0.6180339887, 1);
    late.add(1e-3 * (1 + share), [](double deadline) {
      while (SteadyClock{}.now() < deadline) {
      }
    });
  }
  late.tell(state);
}
BENCHMARK(clock_alone)->Name("deadline/lateness/clock_alone")->Iterations(2000)->Unit(benchmark::kMillisecond);

/// A tower of boxes in the first step of its fall: no tolerance ends this solve, the deadline does, but for ten boxes whose error Newton's
/// stage brings down to rounding. What the system adds when it runs another program meanwhile is not the solve's: those calls are counted,
/// and the rest has figures of its own.
template <class Solver, class Compliance = AssembledCompliance>
void lateness(benchmark::State& state) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, Compliance{}, GaussSeidel{.max_iterations = 0}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(HalfSpace{});
  for (int i = 0; i < int(state.range(0)); ++i)
    set.add({.position = {1e-3 * (i % 2), 0, 0.5 + i}, .mass = 1.0, .shape = Box{1, 1, 1}});
  loop.step(1.0 / 60);
  const auto start = loop.problem();
  SolverWorkspace<decltype(loop.problem()), WithDeadline<Solver>> workspace;
  const double budget = 1e-3 * double(state.range(1));
  Lateness late;
  for (auto _ : state) {
    auto problem = start;
    late.add(budget, [&](double deadline) {
      benchmark::DoNotOptimize(solve_until(problem, Solver{.tolerance = 0, .max_iterations = 1 << 30}, deadline, workspace));
    });
  }
  late.tell(state);
}
void towers(benchmark::internal::Benchmark* b) {
  b->ArgNames({"boxes", "ms"})->Args({10, 1})->Args({100, 1})->Iterations(2000)->Unit(benchmark::kMillisecond);
}
/// Of a thousand boxes a sweep alone takes half a millisecond, and 5 ms are too short for Newton's method.
void high_tower(benchmark::internal::Benchmark* b) {
  b->ArgNames({"boxes", "ms"})->Args({1000, 5})->Args({1000, 30})->Iterations(500)->Unit(benchmark::kMillisecond);
}
BENCHMARK(lateness<AcceleratedSweeps>)->Name("deadline/lateness/sweeps")->Apply(towers);
BENCHMARK(lateness<AcceleratedSweeps>)->Name("deadline/lateness/sweeps")->Apply(high_tower);
BENCHMARK(lateness<AcceleratedSweeps, MatrixFreeCompliance>)->Name("deadline/lateness/matrix_free")->Apply(high_tower);
BENCHMARK(lateness<AcceleratedGaussSeidel>)->Name("deadline/lateness/default")->Apply(towers);
BENCHMARK(lateness<AcceleratedGaussSeidel>)->Name("deadline/lateness/default")->Apply(high_tower);

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
