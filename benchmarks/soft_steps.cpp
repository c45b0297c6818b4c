// Also built with: -march=native
//
// Whole steps of a soft bar, clamped at both ends, whose middle lies on a block, some twenty contacts with
// friction: A factored in each step (in double: exact; in float with conjugate gradients to 1e-6), and one
// factor for many steps. CPU time of the thread. Beside it what the algorithm of the component that is
// modelled takes (factor, W, a free and a corrective solve) on the A and H of the last step. Counters: the
// least and the largest violation that was left, as a share of the bar's height. Arguments: cells along,
// across, up.
#include <delassus/compliance/lazy.hpp>
#include <delassus/delassus.hpp>
#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>

#include "against.hpp"
#include "by_rows.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

using namespace delassus;

namespace {

using Soft = TetrahedralFem<Corotational>;

/// Soft tissue: 2 cm cells, 20 kPa, ν = 0.3, 1000 kg/m³, Rayleigh 0.1/0.01, h = 10 ms, friction 0.4.
template <class Compliance>
void steps(benchmark::State& state, const Compliance& compliance) {
  constexpr double h = 0.01, side = 0.02;
  const std::array<Index, 3> cells{Index(state.range(0)), Index(state.range(1)), Index(state.range(2))};
  AnimationLoop loop{World{RigidBodies{}, Soft{}},
                     Constraints{Contact{Coulomb{.friction = 0.4}}},
                     ImplicitEuler{.rayleigh_mass = 0.1, .rayleigh_stiffness = 0.01},
                     NativeCollision{.margin = 0.002},
                     AcceleratedGaussSeidel{.tolerance = 1e-6},
                     compliance};
  auto& soft = bodies<Soft>(loop.world());
  const double height = side * cells[2], length = side * cells[0];
  // Two columns of nodes are above the block.
  const double middle = side * (cells[0] / 2 + 0.5);
  bodies<RigidBodies>(loop.world())
      .add_fixed(Box{1.5 * side, 2 * side * cells[1], 0.1}, {middle, 0.5 * side * cells[1], -0.05});
  const auto bar = soft.add({.mesh = box_mesh({length, side * cells[1], height}, cells),
                             .elasticity = {.young = 2e4},
                             .position = {0, 0, 0.005},
                             .contact_radius = 0.004});
  soft.fix(bar, [&](const Vec3& x) { return x.x() < 1e-9 || x.x() > length - 1e-9; });
  for (int n = 0; n < 60; ++n) loop.step(h);
  std::vector<double> times;
  double violation = 0, contacts = 0, factorizations = 0;
  for (auto _ : state) {
    times.push_back(against::seconds([&] { loop.step(h); }));
    state.SetIterationTime(times.back());
    contacts += loop.report().contacts;
    if constexpr (requires { loop.template get<Compliance>().report; }) {
      violation = std::max(violation, loop.template get<Compliance>().report.violation);
      factorizations += loop.template get<Compliance>().report.factorizations;
    }
  }
  const double ours = against::median(times);
  std::optional<ByRows> theirs;
  const auto problem = loop.problem();
  soft.each_system([&](Index, auto, const auto& body, const auto&) {
    theirs.emplace(SparseOfBody(body).A, problem.rows.row_count());
    theirs->enter<1>(problem.rows.template pool<0>(), 0);
  });
  const double model = theirs->step_seconds();
  state.counters["nodes"] = double(soft.blocks());
  state.counters["contacts"] = contacts / double(times.size());
  state.counters["ours_ms"] = 1e3 * ours;
  state.counters["model_ms"] = 1e3 * model;
  state.counters["model/ours"] = model / ours;
  state.counters["violation/height"] = violation / height;
  state.counters["factorizations"] = factorizations / double(times.size());
}

void of_bars(benchmark::internal::Benchmark* b) {
  b->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(60);
  b->Args({23, 4, 4})->Args({29, 9, 9});
}

}  // namespace

BENCHMARK_CAPTURE(steps, exact, AssembledCompliance{})->Apply(of_bars);
BENCHMARK_CAPTURE(steps, float_factor, LazyCompliance{.violation = 1e-7, .max_iterations = 0})
    ->Apply(of_bars);
BENCHMARK_CAPTURE(steps, reused, LazyCompliance{.violation = 1e-5, .tolerance = 1e-4})->Apply(of_bars);
