// Also built with: -march=native
//
// A soft bar on a plane that SOFA was measured on (docs/evidence/performance.md): 20 mm cells cut in six, 60 kPa, ν =
// 0.4, 1000 kg/m³, Rayleigh 0.1/0.1, friction 0.5, h = 10 ms; nine nodes of one end are held by joints, all
// nodes of the underside touch. Whole steps stopped by the last change of the impulses, 1e-6 m a row, 200
// sweeps at most. CPU time of the thread. Counters: what the same criterion leaves by the residual (err_s),
// by how much SOFA's step, measured on a machine like this one, is longer, and how long the algorithm of the
// component that is modelled (factor, W, a free solve and a corrective one) takes on the A and H of the last
// step. Arguments: cells along, across, up; SOFA's ms a step.
#include <delassus/adapters/posix.hpp>
#include <delassus/compliance/lazy.hpp>
#include <delassus/compliance/precomputed.hpp>
#include <delassus/delassus.hpp>
#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>

#include "against.hpp"
#include "by_rows.hpp"

#include <array>
#include <optional>
#include <vector>

using namespace delassus;

namespace {

using Soft = TetrahedralFem<Corotational>;
constexpr double h = 0.01;

template <class Compliance>
auto bar(const std::array<Index, 3>& cells, const Compliance& compliance) {
  AnimationLoop loop{
      World{RigidBodies{}, Soft{}},
      Constraints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}},
      ImplicitEuler{.rayleigh_mass = 0.1, .rayleigh_stiffness = 0.1},
      NativeCollision{.margin = 0.002},
      GaussSeidel{.tolerance = 1e-6, .max_iterations = 200, .scale_tolerance = true, .criterion = Criterion::last_change},
      compliance};
  auto& soft = bodies<Soft>(loop.world());
  bodies<RigidBodies>(loop.world()).add_fixed(HalfSpace{});
  const auto beam = soft.add({.mesh = box_mesh({0.02 * cells[0], 0.02 * cells[1], 0.02 * cells[2]}, cells),
                              .elasticity = {.young = 6e4, .poisson = 0.4},
                              .density = 1000,
                              .position = {0, 0, 0.0021},
                              .contact_radius = 0.002});
  for (const Index j : {Index(0), cells[1] / 2, cells[1]})
    for (const Index k : {Index(0), cells[2] / 2, cells[2]}) {
      const auto node = soft.node(beam, (cells[0] + 1) * (j + (cells[1] + 1) * k));
      loop.add(BallJoint::Item{anchor(soft, node), world_anchor(soft.position(node))});
    }
  return loop;
}

template <class Compliance>
void bars(benchmark::State& state, const Compliance& compliance) {
  const std::array<Index, 3> cells{Index(state.range(0)), Index(state.range(1)), Index(state.range(2))};
  auto loop = bar(cells, compliance);
  const double first = against::seconds([&] { loop.step(h); });
  for (int n = 0; n < 30; ++n) loop.step(h);
  std::vector<double> times;
  double error = 0, sweeps = 0, violation = 0;
  for (auto _ : state) {
    times.push_back(against::seconds([&] { loop.step(h); }));
    state.SetIterationTime(times.back());
    error = std::max(error, loop.report().residual);
    sweeps += loop.report().sweeps;
    if constexpr (requires { loop.template get<Compliance>().report; })
      violation = std::max(violation, loop.template get<Compliance>().report.violation);
  }
  const double ours = against::median(times);
  std::optional<ByRows> theirs;
  const auto problem = loop.problem();
  bodies<Soft>(loop.world()).each_system([&](Index, auto, const auto& body, const auto&) {
    theirs.emplace(SparseOfBody(body).A, problem.rows.row_count());
    theirs->enter<1>(problem.rows.template pool<0>(), 0);
    theirs->enter<1>(problem.rows.template pool<1>(), 3 * problem.rows.template pool<0>().items());
  });
  state.counters["nodes"] = double(bodies<Soft>(loop.world()).blocks());
  state.counters["rows"] = double(loop.report().rows);
  state.counters["first_ms"] = 1e3 * first;
  state.counters["ours_ms"] = 1e3 * ours;
  state.counters["err_s"] = error;
  state.counters["violation"] = violation;
  state.counters["sweeps"] = sweeps / double(times.size());
  state.counters["SOFA/ours"] = 1e-3 * double(state.range(3)) / ours;
  const double model = theirs->step_seconds();
  state.counters["model_ms"] = 1e3 * model;
  state.counters["model/ours"] = model / ours;
}

void of_bars(benchmark::internal::Benchmark* b) {
  b->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(25);
  b->Args({19, 4, 4, 69})->Args({39, 4, 4, 483})->Args({29, 9, 9, 3990});
}

}  // namespace

BENCHMARK_CAPTURE(bars, exact, AssembledCompliance{})->Apply(of_bars);
BENCHMARK_CAPTURE(bars, float_factor, LazyCompliance{.max_iterations = 0})->Apply(of_bars);
BENCHMARK_CAPTURE(bars, reused, LazyCompliance{.violation = 1e-6})->Apply(of_bars);
BENCHMARK_CAPTURE(bars, precomputed, PrecomputedCompliance{.violation = 1e-6})->Apply(of_bars);
