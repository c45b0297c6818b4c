// Two resting scenes that SOFA was measured on (docs/evidence/performance.md): ten unit cubes, 6 × 6 × 6 spheres; whole steps, stopped by
// the same criterion at the same tolerance. The counters: the error that criterion leaves, by the residual (err_s), and by how
// much SOFA's processor time a step, measured on a machine like this one, is longer: of both the mean over the steps of a run.
#include "scenes.hpp"

#include <algorithm>
#include <ctime>
#include <vector>

using namespace scenes;

namespace {

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

void add_cubes(RigidBodies& set) { add_stack(set, 10); }
void add_lattice(RigidBodies& set) {
  set.add_fixed(HalfSpace{});
  const double radius = 0.25;
  for (int k = 0; k < 216; ++k)
    set.add({.position = {2 * radius * (k % 6), 2 * radius * (k / 6 % 6), radius * (1 + 2 * (k / 36))},
             .mass = 1.0,
             .shape = Sphere{radius}});
}

template <class Solver, class Compliance>
void rest(benchmark::State& state, void (*add)(RigidBodies&), const Solver& solver, Compliance compliance, double sofa) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, NativeCollision{.margin = 0.05}, solver, compliance};
  add(bodies<RigidBodies>(loop.world()));
  for (int n = 0; n < 100; ++n) loop.step(0.01);
  std::vector<double> times;
  double residual = 0, sweeps = 0, contacts = 0;
  for (auto _ : state) {
    const double start = thread_seconds();
    const StepReport report = loop.step(0.01);
    times.push_back(thread_seconds() - start);
    residual = std::max(residual, report.residual);
    sweeps += report.sweeps;
    contacts = report.contacts;
  }
  double all = 0;
  for (const double time : times) all += time;
  const double mean = all / double(times.size());
  std::nth_element(times.begin(), times.begin() + long(times.size() / 2), times.end());
  state.counters["mean us"] = 1e6 * mean;
  state.counters["median us"] = 1e6 * times[times.size() / 2];
  state.counters["err_s"] = residual;
  state.counters["sweeps"] = sweeps / double(times.size());
  state.counters["contacts"] = contacts;
  state.counters["SOFA / ours"] = sofa / mean;
}

/// SOFA's tolerance is a displacement in metres for each row.
const GaussSeidel by_change{.tolerance = 1e-6, .max_iterations = 200, .scale_tolerance = true, .criterion = Criterion::last_change};
const AcceleratedGaussSeidel by_residual{.tolerance = 1e-6};


constexpr double sofa_cubes = 27.6e-3, sofa_spheres = 176e-3;  // s; its Gauss-Seidel does not converge on the cubes

const AssembledCompliance assembled{};
const MatrixFreeCompliance matrix_free{};

BENCHMARK_CAPTURE(rest, ten_cubes, add_cubes, by_change, assembled, sofa_cubes)->Iterations(2000);
BENCHMARK_CAPTURE(rest, ten_cubes_matrix_free, add_cubes, by_change, matrix_free, sofa_cubes)->Iterations(2000);
BENCHMARK_CAPTURE(rest, ten_cubes_by_residual, add_cubes, by_residual, assembled, sofa_cubes)->Iterations(2000);
BENCHMARK_CAPTURE(rest, ten_cubes_matrix_free_by_residual, add_cubes, by_residual, matrix_free, sofa_cubes)->Iterations(2000);
BENCHMARK_CAPTURE(rest, spheres_216, add_lattice, by_change, assembled, sofa_spheres)->Iterations(500);
BENCHMARK_CAPTURE(rest, spheres_216_matrix_free, add_lattice, by_change, matrix_free, sofa_spheres)->Iterations(500);
BENCHMARK_CAPTURE(rest, spheres_216_by_residual, add_lattice, by_residual, assembled, sofa_spheres)->Iterations(500);

}  // namespace
