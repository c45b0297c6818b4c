// A step of hanging chains, the last link 10^range(1) times as heavy: the time of a link, which does not grow
// with their number.
#include "scenes.hpp"

#include <delassus/solvers/direct_gauss_seidel.hpp>
#include <delassus/steppers/newton_midpoint.hpp>

#include <cmath>

using namespace scenes;

namespace {

/// `range(0)` rods of 0.2 m and 1 kg on ball joints, 20° from the vertical.
template <class... Policies>
void swing(benchmark::State& state, double h, Policies... policies) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, policies...};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const int links = int(state.range(0));
  const Vec3 way(std::sin(0.35), 0, -std::cos(0.35));
  const Quat turned = frame_along(-way);
  Anchor end = world_anchor({0, 0, 0});
  for (int k = 0; k < links; ++k) {
    const double mass = k == links - 1 ? std::pow(10.0, double(state.range(1))) : 1;
    const auto link = rigid.add({.position = (k + 0.5) * 0.2 * way,
                                 .orientation = turned,
                                 .mass = mass,
                                 .shape = Box{0.02, 0.02, 0.2}});
    loop.add(BallJoint::Item{end, anchor(rigid, link, {0, 0, 0.1})});
    end = anchor(rigid, link, {0, 0, -0.1});
  }
  double factorizations = 0;
  for (auto _ : state) {
    loop.step(h);
    factorizations += loop.island_reports()[0].factorizations;
  }
  state.counters["factorizations"] = factorizations / double(state.iterations());
  state.SetComplexityN(links);
  state.SetItemsProcessed(state.iterations() * links);
}

void newton_midpoint(benchmark::State& state) { swing(state, 1.0 / 60, NewtonMidpoint{}); }
BENCHMARK(newton_midpoint)
    ->ArgsProduct({{10, 32, 100, 316, 1000}, {4}})
    ->Unit(benchmark::kMicrosecond)
    ->Complexity();
BENCHMARK(newton_midpoint)->Args({100, 3})->Unit(benchmark::kMicrosecond);

void direct_path(benchmark::State& state) { swing(state, 1e-4, DirectGaussSeidel{}); }
BENCHMARK(direct_path)
    ->ArgsProduct({{10, 32, 100, 316, 1000}, {3}})
    ->Unit(benchmark::kMicrosecond)
    ->Complexity();

}  // namespace
