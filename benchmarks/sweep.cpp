// One Gauss-Seidel sweep per contact: W assembled, matrix-free and row by row the cheaper one, with more and more neighbours. And a warm start against
// a cold one.
#include <delassus/compliance/cheaper.hpp>

#include "scenes.hpp"

#include <span>

using namespace scenes;

namespace {

/// Plates on the ground, `contacts` points under each, of which `copies` are one: a contact has contacts − 1 neighbours.
struct Plates {
  using plays = role::Collision;
  int contacts = 4;
  int copies = 1;
  double gap = -1e-4;

  CollisionReport detect(std::span<const Collider> colliders, double, std::vector<ContactPoint>& out) const {
    out.clear();
    for (Index b = 1; b < Index(colliders.size()); ++b)
      for (int k = 0; k < contacts; ++k) {
        const double angle = 6.283185307179586 * (k / copies * copies) / contacts;
        const Vec3 point = colliders[b].pose.position + Vec3(std::cos(angle), std::sin(angle), -0.05);
        out.push_back({.a = 0, .b = b, .point_a = point - Vec3(0, 0, gap), .point_b = point, .gap = gap,
                       .pair = std::uint64_t(b), .feature = std::uint32_t(k)});
      }
    return {.points = Index(out.size())};
  }
};

template <class Compliance>
void sweep_per_contact(benchmark::State& state) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.3}}},
                     Plates{.contacts = int(state.range(0))}, Compliance{}, GaussSeidel{.max_iterations = 1}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(HalfSpace{});
  for (int i = 0; i < 64; ++i)
    set.add({.position = {3.0 * i, 0, 0.05}, .velocity = {1, 0.3, -0.1}, .mass = 1.0, .shape = Box{1.5, 1.5, 0.1}});
  loop.step(1e-3);
  auto problem = loop.problem();
  LawSet<std::remove_cvref_t<decltype(problem.laws)>, double> book(problem.laws);
  book.prepare(problem.W, problem.rows, problem.h);
  NoObserver nobody;
  for (auto _ : state)
    for (Index k = 0; k < problem.islands.count(); ++k) {
      IslandProblem island(book, problem.rows, problem.W, problem.islands, k, problem.h, nobody);
      benchmark::DoNotOptimize(island.sweep());
    }
  const double visits = double(state.iterations()) * 64 * double(state.range(0));
  state.counters["s/contact"] = benchmark::Counter(visits, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["blocks/row"] = double(state.range(0));
}
BENCHMARK(sweep_per_contact<AssembledCompliance>)->Arg(1)->Arg(4)->Arg(8)->Arg(16)->Arg(32);
BENCHMARK(sweep_per_contact<MatrixFreeCompliance>)->Arg(1)->Arg(4)->Arg(8)->Arg(16)->Arg(32);
BENCHMARK(sweep_per_contact<CheaperCompliance>)->Arg(1)->Arg(4)->Arg(8)->Arg(16)->Arg(32);

/// Plates on four points each, every point there `copies` times, pushed to and fro: a warm step, all of it. Friction in
/// percent; with none, and with 80 that hold them.
template <class Compliance>
void repeated(benchmark::State& state) {
  const int copies = int(state.range(0));
  const double friction = 0.01 * double(state.range(1));
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = friction}}},
                     Plates{.contacts = 4 * copies, .copies = copies}, Compliance{},
                     AcceleratedGaussSeidel{.tolerance = 1e-8, .max_iterations = 100000}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(HalfSpace{});
  for (int i = 0; i < 8; ++i) set.add({.position = {3.0 * i, 0, 0.05}, .mass = 2.0, .shape = Box{1.5, 1.5, 0.1}});
  double time = 0;
  for (auto _ : state) {
    set.gravity = {friction > 0 ? 1.5 * std::sin(0.3 * time++) : 0, 0, -9.81};
    loop.step(0.01);
  }
  const double rows = 3.0 * 8 * 4 * copies * double(state.iterations());
  state.counters["s/row"] = benchmark::Counter(rows, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(repeated<AssembledCompliance>)->ArgsProduct({{1, 2, 5, 10, 20, 50}, {0, 80}});
BENCHMARK(repeated<CheaperCompliance>)->ArgsProduct({{1, 2, 5, 10, 20, 50}, {0, 80}});

/// The standing stack's problem of one step, solved from the last step's impulses or from nothing.
template <bool is_warm>
void start(benchmark::State& state) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.6}}}};
  add_stack(bodies<RigidBodies>(loop.world()), 10);
  for (int i = 0; i < 200; ++i) loop.step(1.0 / 60);
  auto problem = loop.problem();
  const auto before = problem.rows.template pool<0>().lambda;
  const AcceleratedGaussSeidel solver{};
  double sweeps = 0;
  for (auto _ : state) {
    auto& lambda = problem.rows.template pool<0>().lambda;
    lambda = before;
    if (!is_warm)
      for (auto& x : lambda) x.setZero();
    sweeps += solve(problem, solver).sweeps;
  }
  state.counters["sweeps"] = sweeps / double(state.iterations());
}
void warm_start(benchmark::State& state) { start<true>(state); }
void cold_start(benchmark::State& state) { start<false>(state); }
BENCHMARK(warm_start)->Unit(benchmark::kMicrosecond);
BENCHMARK(cold_start)->Unit(benchmark::kMicrosecond);

}  // namespace
