#include <delassus/solvers/direct_gauss_seidel.hpp>
#include <delassus/solvers/path_newton.hpp>
#include <delassus/solvers/proximal_newton.hpp>

#include "scenes.hpp"

#include "catch.hpp"

#include <algorithm>

namespace with_deadline_tests {

using namespace scenes;

namespace {

constexpr double h = 1.0 / 60;

long calls = 0;  ///< of a `CountedCoulomb`

/// Coulomb's law, which counts what is asked of it.
struct CountedCoulomb : Coulomb {
  template <class T>
  Vec<3, T> solve_local(const Parameters& p, const Mat<3, 3, T>& W, const Vec<3, T>& b, Memory<T>& memory) const {
    return ++calls, Coulomb::solve_local(p, W, b, memory);
  }
  template <class T>
  Vec<2, T> natural_squares(const Parameters& p, const Vec<3, T>& lambda, const Vec<3, T>& u, T scale) const {
    return ++calls, Coulomb::natural_squares(p, lambda, u, scale);
  }
  template <class T>
  Mat<3, 3, T> tangent(const Parameters& p, Local<3, T>& c) const {
    return ++calls, Coulomb::tangent(p, c);
  }
};

/// A second for each call.
struct WorkClock {
  double now() const { return double(calls); }
};

/// Stacks of `count` boxes beside each other, in the first step of their fall.
template <class Law, class Compliance = AssembledCompliance>
auto problem_of_law(int stacks, int count) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Law{}}}, Compliance{},
                     GaussSeidel{.max_iterations = 0, .min_iterations = 0}};
  for (int k = 0; k < stacks; ++k) add_stack(rigid_bodies(loop), count, Box{1, 1, 1}, 1e-3, Vec3(3 * k, 0, 0));
  loop.step(h);
  return loop.problem();
}

auto problem_of(int stacks, int count) { return problem_of_law<Coulomb>(stacks, count); }

template <class Problem>
double residual_of(Problem problem) {
  return solve(problem, GaussSeidel{.max_iterations = 0, .min_iterations = 0}).measure.residual;
}

template <class Problem>
bool same_bits(const Problem& a, const Problem& b) {
  return a.rows.template pool<0>().lambda == b.rows.template pool<0>().lambda;
}

}  // namespace

TEMPLATE_TEST_CASE("a solve returns at its first look at the clock after the deadline", "", GaussSeidel,
                   AcceleratedSweeps) {
  const auto start = problem_of(1, 10);
  for (const int looks : {1, 2, 9, 16, 40, 77}) {
    auto p = start;
    double time = 5;
    // A second per look, one look per sweep: look k sees 5 + (k − 1) s.
    const SolveReport r = solve_until(p, TestType{.tolerance = 1e-12, .max_iterations = 100000}, 5.0 + looks - 1,
                                      ScriptedClock{&time, 1});
    CAPTURE(looks);
    REQUIRE(r.status == Status::deadline);
    REQUIRE(r.sweeps == looks);
    REQUIRE(time == 5.0 + looks);
    REQUIRE(r.measure.residual == residual_of(p));
  }
}

TEST_CASE("at the deadline the impulses are those of the smallest residual") {
  const auto start = problem_of(1, 10);
  double least = residual_of(start);
  int best = 0;
  constexpr int sweeps = 14;  // up to here every sweep is measured
  for (int k = 1; k <= sweeps; ++k) {
    auto p = start;
    const double residual =
        solve(p, GaussSeidel{.tolerance = 1e-12, .max_iterations = k, .relaxation = 1.9}).measure.residual;
    if (residual < least) least = residual, best = k;
  }
  auto p = start;
  double time = 0;
  const SolveReport r = solve_until(p, GaussSeidel{.tolerance = 1e-12, .relaxation = 1.9}, sweeps - 1,
                                    ScriptedClock{&time, 1});
  REQUIRE(r.sweeps == sweeps);
  REQUIRE(best < sweeps);  // or the test says nothing
  REQUIRE(r.measure.residual == least);
  REQUIRE(residual_of(p) == least);
}

TEMPLATE_TEST_CASE("a deadline that never comes changes no bit", "", GaussSeidel, AcceleratedGaussSeidel) {
  const TestType solver{.tolerance = 1e-6, .max_iterations = 3000};
  auto with = problem_of(2, 3), without = with;
  const SolveReport a = solve_until(with, solver, 1e300), b = solve(without, solver);
  REQUIRE(a.status == b.status);
  REQUIRE(a.sweeps == b.sweeps);
  REQUIRE(same_bits(with, without));
}

TEMPLATE_TEST_CASE("a workspace changes no bit of a problem, whatever it was used for before", "", GaussSeidel,
                   AcceleratedGaussSeidel, ProximalNewton, DirectGaussSeidel, PathNewton) {
  using Problem = decltype(problem_of(1, 1));
  const TestType solver{.tolerance = 1e-9};
  SolverWorkspace<Problem, TestType> workspace;
  SolverWorkspace<Problem, WithDeadline<TestType>> timed;
  for (const auto& [stacks, boxes] : {std::pair(1, 6), std::pair(3, 2), std::pair(1, 12), std::pair(1, 6)}) {
    const Problem start = problem_of(stacks, boxes);
    Problem fresh = start, used = start, until = start;
    CAPTURE(stacks, boxes);
    const SolveReport r = solve(fresh, solver);
    REQUIRE(solve(used, solver, workspace).sweeps == r.sweeps);
    REQUIRE(solve_until(until, solver, 1e300, timed).sweeps == r.sweeps);
    REQUIRE(same_bits(fresh, used));
    REQUIRE(same_bits(fresh, until));
  }
}

TEST_CASE("a solve that meets its tolerance before the deadline is converged") {
  auto p = problem_of(1, 3);
  double time = 0;
  const SolveReport r = solve_until(p, AcceleratedGaussSeidel{.tolerance = 1e-6}, 1e6, ScriptedClock{&time, 1});
  REQUIRE(r.status == Status::converged);
  REQUIRE(r.measure.residual <= 1e-6);
}

TEST_CASE("islands after the deadline get the sweeps that are their due, and no more") {
  auto p = problem_of(3, 4);
  REQUIRE(p.islands.count() == 3);
  double time = 0;
  solve_until(p, GaussSeidel{.tolerance = 1e-12, .min_iterations = 2}, 9.0, ScriptedClock{&time, 1});
  // Looks after sweeps 2 … 11 of the first island; one look after sweep 2 of each of the others.
  REQUIRE(time == 12);
  for (Index k = 0; k < 3; ++k) {
    double sum = 0;
    for (const Index i : p.islands.items(0, k)) sum += p.rows.template pool<0>().lambda[i][0];
    REQUIRE(sum > 0);
  }
}

TEST_CASE("a budget counts from the first island of each step, and the report says when it ran out") {
  double time = 0;
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     WithDeadline{AcceleratedGaussSeidel{.tolerance = 1e-10}, 20.0, ScriptedClock{&time, 1}}};
  add_stack(rigid_bodies(loop), 10, Box{1, 1, 1});
  for (int n = 0; n < 5; ++n) {
    const double before = time;
    const StepReport r = loop.step(h);
    REQUIRE(r.status == Status::deadline);
    REQUIRE(r.sweeps == 20);          // the look at 20 s after the first is the twentieth after a sweep
    REQUIRE(time - before == 21.0);   // and the first one, before any
  }
}

// Gathering, and two factorizations and what goes with them, take as long as some fifty sweeps of ten boxes.
TEST_CASE("Newton's stage is not begun where it would end after the deadline") {
  const auto start = problem_of(1, 10);
  for (const auto& [looks, is_begun] : {std::pair(30, false), std::pair(300, true)}) {
    auto p = start;
    double time = 0;
    const SolveReport r = solve_until(p, AcceleratedGaussSeidel{.tolerance = 1e-12, .max_iterations = 100000},
                                      looks - 1.0, ScriptedClock{&time, 1});
    CAPTURE(looks);
    REQUIRE((r.factorizations > 0) == is_begun);
    if (!is_begun) REQUIRE(r.status == Status::deadline);
    if (!is_begun) REQUIRE(r.sweeps >= 20);
  }
}

TEST_CASE("Newton's method alone ends at the first look after the deadline, with the status that says so") {
  auto p = problem_of(1, 10);
  double time = 0;
  const SolveReport r = solve_until(p, ProximalNewton{.tolerance = 0}, 2.0, ScriptedClock{&time, 1});
  REQUIRE(r.status == Status::deadline);
  REQUIRE(r.factorizations <= 3);
}

// 200 contacts are three looks inside each sweep, each measure and each extrapolation, so that consecutive deadlines come in
// all of them, and in Newton's method in its gathering, its evaluations and its factorizations. A tick per look: what reads the
// clock once more after the deadline moves it once more.
TEMPLATE_TEST_CASE("in the midst of a sweep, a measure or a factorization too a solve returns at its first look after the deadline", "",
                   GaussSeidel, AcceleratedSweeps, AcceleratedGaussSeidel, DirectGaussSeidel, PathNewton) {
  const auto start = problem_of(1, 50);
  int after_factorizations = 0;
  const int last = std::is_same_v<TestType, PathNewton> ? 40 : 1200;  // its looks are whole factorizations apart
  for (int deadline = 8; deadline < last; deadline += 1 + deadline / 20) {
    double time = 0;
    auto p = start;
    const SolveReport r = solve_until(p, TestType{.tolerance = 1e-14}, deadline, ScriptedClock{&time, 1});
    CAPTURE(deadline, r.sweeps, r.factorizations, r.ended_by);
    if (r.status != Status::deadline) break;
    REQUIRE(time == deadline + 1.0);
    REQUIRE(r.measure.residual == residual_of(p));
    REQUIRE(r.measure.residual < residual_of(start));
    after_factorizations += r.factorizations > 0;
    double again = 0;
    auto q = start;
    solve_until(q, TestType{.tolerance = 1e-14}, deadline, ScriptedClock{&again, 1});
    REQUIRE(same_bits(p, q));
  }
  if constexpr (std::is_same_v<TestType, AcceleratedGaussSeidel>) REQUIRE(after_factorizations > 10);
}

/// Time all but stands until a look that jumps over the deadline: work is begun as if there were enough of it.
struct JumpingClock {
  int* looks;
  int jump = 0;
  double now() const { return ++*looks >= jump ? 1.0 : 1e-9 * *looks; }
};

TEST_CASE("whichever look is the first after the deadline, the solve ends there with the best impulses") {
  const auto start = problem_of(1, 70);
  int sweeping = 0, by_newton = 0;
  for (int jump = 40; jump < 1000; ++jump) {
    auto p = start;
    int looks = 0;
    const SolveReport r = solve_until(p, AcceleratedGaussSeidel{.tolerance = 1e-14}, 0.5, JumpingClock{&looks, jump});
    CAPTURE(jump, r.sweeps, r.factorizations);
    REQUIRE(r.status == Status::deadline);
    REQUIRE(looks == jump);
    REQUIRE(r.measure.residual == residual_of(p));
    REQUIRE(r.measure.residual < residual_of(start));
    ++(r.factorizations > 0 ? by_newton : sweeping);
  }
  REQUIRE(sweeping > 100);
  REQUIRE(by_newton > 100);
}

TEST_CASE("Newton's method that came to nothing before a deadline is passed over in more and more steps") {
  const auto start = problem_of(1, 70);
  const AcceleratedGaussSeidel solver{.tolerance = 1e-14};
  int looks = 0, jump = 40;
  const auto factorizations = [&] {
    auto p = start;
    looks = 0;
    return solve_until(p, solver, 0.5, JumpingClock{&looks, jump}).factorizations;
  };
  while (factorizations() == 0) ++jump;
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     WithDeadline{solver, 0.5, JumpingClock{&looks, jump + 3}}};
  add_stack(rigid_bodies(loop), 70, Box{1, 1, 1}, 1e-3);
  std::vector<int> begun;
  for (int n = 0; n < 30; ++n) {
    looks = 0;
    REQUIRE(loop.step(h).status == Status::deadline);
    if (loop.island_reports()[0].factorizations > 0) begun.push_back(n);
  }
  REQUIRE(begun == std::vector{0, 2, 5, 10, 19});  // after 1, 2, 4 and 8 steps without
}

// No more than 64 constraints lie between two looks, and what is left of one pass before the next begins: without looks inside, a
// sweep and a measure are 1600 calls of 200 boxes. Before the deadline is kept what loading the best takes, which are no calls.
TEMPLATE_TEST_CASE("how much is done after the deadline does not grow with the problem", "", GaussSeidel, AcceleratedSweeps,
                   AcceleratedGaussSeidel) {
  for (const int boxes : {25, 50, 200}) {
    const auto start = problem_of_law<CountedCoulomb>(1, boxes);
    for (int k = 0; k < 60; ++k) {
      auto p = start;
      calls = 0;
      const long deadline = boxes * (20 + 7 * k) + k;
      const SolveReport r = solve_until(p, TestType{.tolerance = 1e-14}, double(deadline), WorkClock{});
      CAPTURE(boxes, deadline, r.sweeps, r.factorizations);
      if (r.status != Status::deadline) break;
      const double kept = inner::load_share_of_blocks * 8 * boxes;
      REQUIRE(double(calls) >= double(deadline) - kept);
      REQUIRE(double(calls) < double(deadline) - kept / 2 + 128);
    }
  }
}

// A thousand boxes that all press are 4000 calls a sweep, and as many a measure; what is kept of them is more than lies between two looks, so that all
// calls are before the deadline. Loading the best is no call, and takes the time kept on a real clock.
TEMPLATE_TEST_CASE("a solve ends before its deadline by the time that loading its best impulses takes", "", AssembledCompliance,
                   MatrixFreeCompliance) {
  auto start = problem_of_law<CountedCoulomb, TestType>(1, 1000);
  for (auto& lambda : start.rows.template pool<0>().lambda) lambda = {1, 0, 0};
  const double share = (std::is_same_v<TestType, AssembledCompliance> ? inner::load_share_of_blocks : inner::load_share_otherwise);
  for (int k = 3; k < 12; ++k) {
    auto p = start;
    calls = 0;
    const double deadline = 8000 * k + 7 * k;
    const SolveReport r = solve_until(p, AcceleratedSweeps{.tolerance = 1e-14}, deadline, WorkClock{});
    const double pace = double(calls) / r.sweeps;  // of the mean sweep, its measure included
    CAPTURE(deadline, r.sweeps, calls, pace);
    REQUIRE(r.status == Status::deadline);
    CHECK(double(calls) >= deadline - share * std::max(1.5 * pace, 8000.0));  // a sweep with its measure is 8000
    CHECK(double(calls) < deadline - 0.75 * share * pace + 128);
    CHECK(double(calls) < deadline);
  }
}

// Measures are up to 64 sweeps apart: where no other would end in time the next sweep is measured. What comes after that is at most
// the sweep that would have been too late, or two where that one's pace was overrated.
TEST_CASE("what a sweep that was cut off leaves is one of the last iterates before it, to the bit") {
  const auto start = problem_of(1, 50);
  for (int deadline = 60; deadline < 600; deadline += 17) {
    auto p = start;
    double time = 0;
    const SolveReport r = solve_until(p, GaussSeidel{.tolerance = 1e-14}, deadline, ScriptedClock{&time, 1});
    REQUIRE(r.status == Status::deadline);
    int found = 0;
    for (int k = r.sweeps; k >= r.sweeps - 3; --k) {
      auto q = start;
      solve(q, GaussSeidel{.tolerance = 1e-14, .max_iterations = k});
      if (same_bits(p, q)) found = k;
    }
    CAPTURE(deadline, r.sweeps);
    REQUIRE(found > 0);
  }
}

TEST_CASE("a budget below zero and a deadline that is no number are refused") {
  const auto loop_with = [](double budget, double deadline) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                       WithDeadline{GaussSeidel{}, budget, SteadyClock{}, deadline}};
  };
  REQUIRE_THROWS_WITH(loop_with(-1, 1), "delassus: WithDeadline: budget -1 s must be >= 0");
  REQUIRE_THROWS_WITH(loop_with(1, std::nan("")), Catch::Contains("WithDeadline: the deadline must be a number"));
  REQUIRE_THROWS_WITH(
      (AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}}, WithDeadline{GaussSeidel{.relaxation = 3}}}),
      Catch::Contains("relaxation 3"));
}

}  // namespace with_deadline_tests
