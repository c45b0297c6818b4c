// Friction problems from the folder DELASSUS_PROBLEMS: what a sweep costs per 3 × 3 block beside a plain loop of Eigen over the
// same blocks, and what a solve to 1e-3, 1e-6 and 1e-8 of Siconos' error costs from λ = 0.
#include <delassus/io/problem_file.hpp>
#include <delassus/problems/friction_problem.hpp>
#include <delassus/solvers/accelerated_gauss_seidel.hpp>
#include <delassus/solvers/law_set.hpp>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

using namespace delassus;

namespace {

using Book = LawSet<std::remove_cvref_t<decltype(FrictionProblem::laws)>, double>;
using Solver = AcceleratedSweeps;

double blocks_of(const FrictionProblem& p) {
  return double(p.W.blocks<0, 0>().column.size()) + double(p.rows.pool<0>().items());
}

void per_block(benchmark::State& state, double blocks) {
  state.counters["s/block"] =
      benchmark::Counter(blocks * double(state.iterations()), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// Sweeps near the solution, as most are.
void sweep(benchmark::State& state, const std::string& path) {
  FrictionProblem p = read_problem(path);
  Book book(p.laws);
  book.prepare(p.W, p.rows, p.h);
  NoObserver nobody;
  IslandProblem island(book, p.rows, p.W, p.islands, 0, p.h, nobody);
  for (int k = 0; k < 50; ++k) island.sweep();
  for (auto _ : state) benchmark::DoNotOptimize(island.sweep());
  per_block(state, blocks_of(p));
}

/// The product of the same blocks alone, one after the other, without any law.
void plain_product(benchmark::State& state, const std::string& path) {
  const FrictionProblem p = read_problem(path);
  const auto W = p.W.blocks<0, 0>();
  const auto& pool = p.rows.pool<0>();
  auto x = pool.d, u = x;
  for (auto _ : state) {
    for (Index i = 0; i < pool.items(); ++i) {
      Vec3 sum = pool.d[i];
      sum.noalias() += p.W.diagonal<0>(i) * x[i];
      for (Index e = W.start[i]; e < W.start[i + 1]; ++e) sum.noalias() += W.block[e] * x[W.column[e]];
      u[i] = sum;
    }
    benchmark::DoNotOptimize(u.data());
    benchmark::ClobberMemory();
  }
  per_block(state, blocks_of(p));
}

/// A whole solve, the own blocks' factors included.
void solve_to(benchmark::State& state, const std::string& path, double tolerance) {
  FrictionProblem p = read_problem(path);
  const Solver solver{.tolerance = tolerance, .max_iterations = 20000, .min_iterations = 0, .criterion = Criterion::siconos_error};
  SolveReport r;
  for (auto _ : state) {
    for (auto& x : p.rows.pool<0>().lambda) x.setZero();
    r = solve(p, solver);
  }
  state.counters["sweeps"] = r.sweeps;
  state.counters["err"] = r.measure.siconos;
  state.counters["err_s"] = r.measure.residual;
  state.SetLabel(std::string(name(r.status)) + ", " + r.ended_by);
}

const bool are_registered = [] {
  const char* folder = std::getenv("DELASSUS_PROBLEMS");
  if (folder == nullptr) {
    std::fprintf(stderr, "benchmark_problems: set DELASSUS_PROBLEMS to a folder of .fcp files\n");
    return false;
  }
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".fcp") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const auto& file : files) {
    const std::string path = file.string(), name = file.stem().string();
    benchmark::RegisterBenchmark(("sweep/" + name).c_str(), sweep, path);
    benchmark::RegisterBenchmark(("plain_product/" + name).c_str(), plain_product, path);
    for (const auto& [text, tolerance] : {std::pair{"1e-3", 1e-3}, {"1e-6", 1e-6}, {"1e-8", 1e-8}})
      benchmark::RegisterBenchmark(("solve_to_" + std::string(text) + '/' + name).c_str(), solve_to, path, tolerance)
          ->Unit(benchmark::kMicrosecond);
  }
  return true;
}();

}  // namespace
