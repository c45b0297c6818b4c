// Acceleration on flat impulses, deadlines and observers.
#include "scenes_of_step.hpp"

#include "catch.hpp"

#include <vector>

namespace light_solver_tests {

using namespace light;

namespace {

/// One island of the library with what it refers to.
template <class Problem>
struct TypedIsland {
  Problem& problem;
  LawSet<decltype(Problem::laws), double> book;
  NoObserver nobody;
  IslandProblem<decltype(book), typename Problem::Rows, decltype(Problem::W)> island;

  explicit TypedIsland(Problem& p)
      : problem(p), book(p.laws), island(book, p.rows, p.W, p.islands, 0, p.h, nobody) {
    p.W.reset(p.rows);
    book.prepare(p.W, p.rows, p.h);
  }
};

}  // namespace

// The order of W's sums differs in one row of three, by rounding, and mixing takes small differences of
// sweeps: hence 1e-6.
TEST_CASE("Anderson's mixing of flat sweeps goes as the library's does") {
  const auto loop = stack(5);
  FlatStep step(loop);
  TypedIsland typed(step.problem);
  Chase<decltype(typed.island)> theirs{typed.island, 1e-8, 400};
  inner::History history;
  inner::anderson(typed.island, theirs, history, [&] { return typed.island.sweep(); });
  const SolveReport mine = step.solve(light::Anderson{.tolerance = 1e-8, .max_sweeps = 400});
  CHECK(mine.status == Status::converged);
  CHECK(mine.sweeps == theirs.sweeps);
  CHECK(difference(step.rows.lambda, impulses(step.problem)) <= 1e-6);
  FlatStep plain(loop);
  CHECK(plain.solve(light::GaussSeidel{.tolerance = 1e-8, .max_iterations = 100000}).sweeps >
        2 * mine.sweeps);
}

TEST_CASE("mixing is the same without a matrix, whose velocities are told of every change") {
  const auto loop = mixed();
  FlatStep blocks(loop), bodies(loop, 0);
  for (auto* step : {&blocks, &bodies})
    CHECK(step->solve(light::Anderson{.tolerance = 1e-9}).status == Status::converged);
  CHECK(difference(bodies.rows.lambda, blocks.rows.lambda) <= 1e-6);  // two solves to 1e-9 of |d|
}

namespace {

/// A clock that goes on by one each time it is read.
double tick(void* clock) { return double(++*static_cast<int*>(clock)); }

/// The residuals that an observer has heard of.
void note(void* heard, int, const Measure& m) {
  static_cast<std::vector<double>*>(heard)->push_back(m.residual);
}

/// The longest span that a table of a law was given.
Index longest = 0;
double spy(light::Pool<double>& pool, const Span<double>& span, double relaxation) {
  longest = std::max(longest, span.count);
  return LawLoops<Contacts, double>::table.sweep(pool, span, relaxation);
}

}  // namespace

TEST_CASE(
    "an observer hears of every sweep, and an unwatched solve ends with the same bits as one of as many "
    "sweeps") {
  const auto loop = stack(4);
  FlatStep watched(loop), plain(loop);
  std::vector<double> heard;
  const SolveReport report =
      watched.solve(light::GaussSeidel{.tolerance = 1e-4}, {.observe = note, .observer = &heard});
  CHECK(int(heard.size()) == report.sweeps + 1);
  CHECK(heard.back() == report.measure.residual);
  plain.solve(light::GaussSeidel{.tolerance = 0, .max_iterations = report.sweeps});
  CHECK(difference(plain.rows.lambda, watched.rows.lambda) == 0);
}

TEST_CASE("with a deadline a span has at most 64 items, and the sweeps have the same bits") {
  const auto loop = cluster(30, 150);
  FlatStep timed(loop), plain(loop);
  auto table = LawLoops<Contacts, double>::table;
  table.sweep = spy;
  for (auto* step : {&timed, &plain}) step->pools.list[0]->sweeping = &table;
  int clock = 0;
  const light::GaussSeidel sweeps{.tolerance = 0, .max_iterations = 10};
  longest = 0;
  CHECK(timed.solve(sweeps, {.deadline = 1e9, .now = tick, .clock = &clock}).sweeps == 10);
  CHECK(longest == 64);
  CHECK(clock == 9 * 3);  // before each of three pieces, but of the first sweep
  plain.solve(sweeps);
  CHECK(longest == 150);
  CHECK(difference(timed.rows.lambda, plain.rows.lambda) == 0);
}

TEST_CASE("a solve whose time is up within a sweep gives back the best measured impulses") {
  const auto loop = cluster(30, 150);
  for (const int deadline : {1, 2, 3, 4, 8, 11}) {
    FlatStep timed(loop), plain(loop);
    int clock = 0;
    const SolveReport report = timed.solve(light::GaussSeidel{.tolerance = 0, .max_iterations = 100},
                                           {.deadline = double(deadline), .now = tick, .clock = &clock});
    CAPTURE(deadline);
    CHECK(report.status == Status::deadline);
    CHECK(report.sweeps ==
          1 + (deadline - 1) / 3);  // three pieces a sweep, the first sweep whatever the clock says
    plain.solve(light::GaussSeidel{.tolerance = 0, .max_iterations = report.sweeps});
    CHECK(difference(timed.rows.lambda, plain.rows.lambda) == 0);
  }
}

TEST_CASE("Nesterov's momentum over flat sweeps ends a stack in fewer of them") {
  const auto loop = stack(6);
  FlatStep plain(loop), fast(loop);
  const int sweeps = plain.solve(light::GaussSeidel{.tolerance = 1e-8, .max_iterations = 100000}).sweeps;
  const SolveReport report = fast.solve(light::Nesterov{.tolerance = 1e-8});
  CHECK(report.status == Status::converged);
  CHECK(3 * report.sweeps < sweeps);
  Array<double> u, v;  // of boxes with four contacts each many impulses make one motion
  fast.island(0).velocities(u);
  plain.island(0).velocities(v);
  double most = 0, size = 0;
  for (std::size_t k = 0; k < u.size(); ++k)
    most = std::max(most, std::abs(u[k] - v[k])), size = std::max(size, std::abs(fast.rows.d[k]));
  CHECK(most <= 1e-6 * size);
}

}  // namespace light_solver_tests
