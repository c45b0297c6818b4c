// The same sweeps as the library's, on flat arrays.
#include "scenes_of_step.hpp"

#include "catch.hpp"

namespace light_sweep_tests {

using namespace light;

namespace {

/// The two W, entry by entry of the pools with themselves, relative to the largest.
template <class Step>
double difference_of_diagonals(const Step& step) {
  double most = 0, size = 0;
  for_each_index<decltype(step.problem.laws)::pool_count>([&](auto p) {
    const auto& pool = step.problem.rows.template pool<p>();
    for (Index i = 0; i < pool.items(); ++i) {
      const auto& theirs = step.problem.W.template diagonal<p>(i);
      const double* const mine = step.W.diagonal(p, i);
      for (int k = 0; k < pool.rows * pool.rows; ++k) {
        most = std::max(most, std::abs(mine[k] - theirs.data()[k]));
        size = std::max(size, std::abs(theirs.data()[k]));
      }
    }
  });
  return most / size;
}

/// Gives the library's problem the blocks of the flat W: Eigen sums the third row of a product of 3 × 6 and 6
/// × 3 in another order than the first two, and the example all from left to right. Returns how far they were
/// apart.
template <class Step>
double give_blocks(Step& step) {
  const Span<double> mine = step.W.span(0, nullptr, 0);
  auto& W = step.problem.W.template blocks<0, 0>();
  const Index items = step.pools.list[0]->items;
  if (!std::equal(W.start.begin(), W.start.end(), mine.start)) return 1;
  if (!std::equal(W.column.begin(), W.column.end(), mine.column)) return 1;
  double most = difference_of_diagonals(step);
  for (Index e = 0; e < Index(W.column.size()); ++e) {
    const Mat3 block = Eigen::Map<const Mat3>(mine.block + 9 * std::size_t(e));
    most = std::max(most, (block - W.block[e]).norm() / W.block[e].norm());
    W.block[e] = block;
  }
  for (Index i = 0; i < items; ++i)
    step.problem.W.template diagonal<0>(i) = Eigen::Map<const Mat3>(mine.diagonal + 9 * std::size_t(i));
  return most;
}

template <class Step>
SolveReport solve_by_library(Step& step, int sweeps, double relaxation = 1) {
  return delassus::solve(
      step.problem,
      delassus::GaussSeidel{.tolerance = 0, .max_iterations = sweeps, .relaxation = relaxation});
}
template <class Step>
SolveReport solve_flat(Step& step, int sweeps, double relaxation = 1) {
  return step.solve(light::GaussSeidel{.tolerance = 0, .max_iterations = sweeps, .relaxation = relaxation});
}

}  // namespace

TEST_CASE("one pool of contacts between rigid bodies is swept to the library's bits") {
  const auto loop = cluster(12, 40);
  for (const double relaxation : {1.0, 1.3}) {
    FlatStep step(loop);
    CHECK(give_blocks(step) <= 1e-13);
    const SolveReport theirs = solve_by_library(step, 25, relaxation),
                      mine = solve_flat(step, 25, relaxation);
    CHECK(mine.sweeps == theirs.sweeps);
    CHECK(mine.measure.residual == theirs.measure.residual);
    CHECK(mine.measure.siconos == theirs.measure.siconos);
    CHECK(difference(step.rows.lambda, impulses(step.problem)) == 0);
  }
}

TEST_CASE("a stack is solved to the library's bits, in as many sweeps") {
  const auto loop = stack(6);
  FlatStep step(loop);
  CHECK(give_blocks(step) <= 1e-13);
  const SolveReport theirs =
      delassus::solve(step.problem, delassus::GaussSeidel{.tolerance = 1e-8, .max_iterations = 100000});
  const SolveReport mine = step.solve(light::GaussSeidel{.tolerance = 1e-8, .max_iterations = 100000});
  CHECK(mine.status == Status::converged);
  CHECK(mine.sweeps == theirs.sweeps);
  CHECK(difference(step.rows.lambda, impulses(step.problem)) == 0);
}

// Not the same bits: what other pools add to a row is summed before its own pool's share, and products with
// three and five rows run in another order.
TEST_CASE("pools of one, three and five rows on bodies of three kinds are swept to the library's impulses") {
  const auto loop = mixed();
  FlatStep step(loop);
  REQUIRE(step.islands.count() == step.problem.islands.count());
  REQUIRE(step.rows.count() == step.problem.rows.row_count());
  solve_by_library(step, 30);
  solve_flat(step, 30);
  CHECK(difference_of_diagonals(step) <= 1e-13);
  CHECK(difference(step.rows.lambda, impulses(step.problem)) <= 1e-12);
}

TEST_CASE("the natural maps of all laws add up to the measured residual") {
  const auto loop = mixed();
  FlatStep step(loop);
  solve_flat(step, 3);
  for (Index k = 0; k < step.islands.count(); ++k) {
    Island<double> island = step.island(k);
    Array<double> u, map(step.rows.lambda.size());
    island.velocities(u);
    for (const auto& part : island.parts()) {
      const Index row = part.pool->first_row;
      part.pool->sweeping->natural_map(*part.pool, part.span, u.data() + row, map.data() + row);
    }
    double maps = 0, velocities = 0, free = 0;
    for (const Index r : island.order()) {
      maps += map[r] * map[r];
      velocities += u[r] * u[r];
      free += step.rows.d[r] * step.rows.d[r];
    }
    CHECK(island.measure().residual == Approx(std::sqrt(maps / std::max(velocities, free))).epsilon(1e-12));
  }
}

TEST_CASE("phi, springs and H of a law are what the library's writer makes of it") {
  const auto loop = mixed();
  FlatStep step(loop);
  Index row = 0, entries = 0;
  for_each_index<4>([&](auto p) {
    const auto& pool = step.problem.rows.template pool<p>();
    for (Index i = 0; i < pool.items(); ++i)
      for (int k = 0; k < pool.rows; ++k, ++row) {
        CHECK(step.rows.phi[row] == pool.phi[i][k]);
        CHECK(step.rows.stiffness[row] == pool.stiffness[i][k]);
        CHECK(step.rows.damping[row] == pool.damping[i][k]);
      }
    std::apply([&](const auto&... s) { entries += (Index(s.block.size()) + ...); }, pool.sets);
  });
  CHECK(Index(step.rows.entries.size()) == entries);
  CHECK(step.rows.entries.back().width == 3);
}

TEST_CASE("islands are numbered as the library numbers them") {
  const auto loop = mixed();
  FlatStep step(loop);
  for (Index k = 0; k < step.islands.count(); ++k)
    for (int p = 0; p < 4; ++p) {
      const auto mine = step.islands.items(p, k), theirs = step.problem.islands.items(p, k);
      CHECK(std::equal(mine.begin(), mine.end(), theirs.begin(), theirs.end()));
    }
}

}  // namespace light_sweep_tests
