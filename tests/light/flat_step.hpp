/// One step of a loop both as the library's problem and on flat arrays.
#pragma once

#include "acceleration.hpp"
#include "flat_pools.hpp"
#include "gauss_seidel.hpp"
#include "scenes.hpp"
#include "stages.hpp"

namespace light {

/// The stages of a loop up to W, so that bodies, A and rows are of one moment.
template <class Loop>
void stop_before_solve(Loop& loop, double h) {
  auto& step = loop.data();
  stage::begin(step, h);
  stage::detect(step);
  linearize_to_build(step);
}

/// H, W, islands and the solve are the example's own; what Bias and FreeMotion write (d, compliance) and the
/// first λ are the library's, since they are no part of the form that is tried.
template <class Problem, class PoolList>
struct FlatStep {
  Problem problem;  ///< the library's, with the items that the pools refer to
  PoolList pools;
  WorldView<double> world;
  Rows<double> rows;
  Islands<double> islands;
  Delassus<double> W;

  template <class Loop>
  explicit FlatStep(const Loop& loop, Index most_partners = Delassus<double>::all_blocks)
      : problem(loop.problem()), pools(problem.laws), world(loop.world()) {
    linearize<double>(pools.list, world, rows);
    take_numbers();
    islands.find(world, pools.list, rows);
    W.build(world, pools.list, rows, most_partners);
  }
  FlatStep(const FlatStep&) = delete;

  Island<double> island(Index k, const SolveControl& control = {}) {
    Island<double> island(pools.list, rows, W, islands, k, control);
    island.prepare(problem.h);
    return island;
  }
  template <class Solver>
  SolveReport solve(const Solver& solver, const SolveControl& control = {}) {
    SolveReport worst;
    for (Index k = 0; k < islands.count(); ++k) {
      Island<double> here = island(k, control);
      const SolveReport r = solver.solve(here);
      if (r.measure.residual >= worst.measure.residual) worst.measure = r.measure;
      worst.status = worse(worst.status, r.status);
      worst.sweeps = std::max(worst.sweeps, r.sweeps);
      worst.factorizations = std::max(worst.factorizations, r.factorizations);
    }
    return worst;
  }

 private:
  void take_numbers() {
    Index row = 0;
    for_each_index<decltype(problem.laws)::pool_count>([&](auto p) {
      const auto& from = problem.rows.template pool<p>();
      for (Index i = 0; i < from.items(); ++i)
        for (int k = 0; k < from.rows; ++k, ++row) {
          rows.d[row] = from.d[i][k];
          rows.compliance[row] = from.compliance[i][k];
          rows.relative_compliance[row] = from.relative_compliance[i][k];
          rows.lambda[row] = from.lambda[i][k];
        }
    });
  }
};

template <class Laws>
struct pools_of;
template <class... Laws>
struct pools_of<Constraints<Laws...>> {
  using type = Pools<Laws...>;
};
template <class Loop>
FlatStep(const Loop&)
    -> FlatStep<decltype(std::declval<const Loop&>().problem()),
                typename pools_of<decltype(std::declval<const Loop&>().problem().laws)>::type>;
template <class Loop>
FlatStep(const Loop&, Index)
    -> FlatStep<decltype(std::declval<const Loop&>().problem()),
                typename pools_of<decltype(std::declval<const Loop&>().problem().laws)>::type>;

/// λ of a problem of the library in the order of the flat rows.
template <class Problem>
Array<double> impulses(const Problem& problem) {
  Array<double> all;
  for_each_index<decltype(problem.laws)::pool_count>([&](auto p) {
    for (const auto& x : problem.rows.template pool<p>().lambda) all.append(x.data(), x.data() + x.size());
  });
  return all;
}

/// max |a − b| / max |b|.
inline double difference(const Array<double>& a, const Array<double>& b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double most = 0, size = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    most = std::max(most, std::abs(a[i] - b[i]));
    size = std::max(size, std::abs(b[i]));
  }
  return most == 0 ? 0 : most / size;
}

}  // namespace light
