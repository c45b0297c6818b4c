// A soft beam of n × n cells in the section and three times as many along: elements, A and its factor, a
// solve, and whole steps of a cube that lies on the ground. CPU time of one thread. Argument: n.
#include <delassus/delassus.hpp>
#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/elasticity/linear.hpp>
#include <delassus/fem/elasticity/stable_neo_hookean.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>

#include <benchmark/benchmark.h>

#include <vector>

using namespace delassus;

namespace {

template <class M>
struct Beam {
  TetrahedralFem<M> set;

  explicit Beam(Index n) {
    const auto beam = set.add({.mesh = box_mesh({3, 1, 1}, {3 * n, n, n}), .elasticity = {.young = 2000}});
    set.fix(beam, [](const Vec3& x) { return x[0] < 1e-9; });
  }
};

template <class M>
void elements(benchmark::State& state) {
  Beam<M> beam{Index(state.range(0))};
  for (auto _ : state) beam.set.factor({.mass = 1});
  state.counters["nodes"] = beam.set.blocks();
}

template <class M>
void elements_and_factor(benchmark::State& state) {
  Beam<M> beam{Index(state.range(0))};
  double h2 = 1e-4;  // another one each time, so that the factor of `Linear` is made too
  for (auto _ : state) beam.set.factor({.mass = 1, .stiffness = h2 += 1e-9});
  state.counters["nodes"] = beam.set.blocks();
}

void solve(benchmark::State& state) {
  Beam<Corotational> beam{Index(state.range(0))};
  beam.set.factor({.mass = 1, .stiffness = 1e-4});
  std::vector<Vec3> x(beam.set.blocks());
  for (auto _ : state) {
    for (Vec3& v : x) v = {1, 2, 3};
    beam.set.solve(x);
  }
}

void step_on_the_ground(benchmark::State& state) {
  using Soft = TetrahedralFem<Corotational>;
  AnimationLoop loop{World{RigidBodies{}, Soft{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     ImplicitEuler{}};
  bodies<RigidBodies>(loop.world()).add_fixed(HalfSpace{});
  auto& soft = bodies<Soft>(loop.world());
  const Index n = Index(state.range(0));
  soft.add({.mesh = box_mesh({1, 1, 1}, {n, n, n}),
            .elasticity = {.young = 1e5},
            .position = {0, 0, 0.02},
            .contact_radius = 0.02});
  for (int k = 0; k < 50; ++k) loop.step(0.01);
  for (auto _ : state) loop.step(0.01);
  state.counters["contacts"] = loop.report().contacts;
  state.counters["sweeps"] = loop.report().sweeps;
}

}  // namespace

BENCHMARK(elements<Linear>)->Arg(4)->Arg(9)->Unit(benchmark::kMillisecond);
BENCHMARK(elements<Corotational>)->Arg(4)->Arg(9)->Unit(benchmark::kMillisecond);
BENCHMARK(elements<StableNeoHookean>)->Arg(4)->Arg(9)->Unit(benchmark::kMillisecond);
BENCHMARK(elements_and_factor<Linear>)->Arg(4)->Arg(9)->Unit(benchmark::kMillisecond);
BENCHMARK(elements_and_factor<Corotational>)->Arg(4)->Arg(9)->Unit(benchmark::kMillisecond);
BENCHMARK(solve)->Arg(4)->Arg(9)->Unit(benchmark::kMillisecond);
BENCHMARK(step_on_the_ground)->Arg(4)->Arg(8)->Unit(benchmark::kMillisecond);
