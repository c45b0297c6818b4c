#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/delassus.hpp>
#include <delassus/io/checkpoint.hpp>
#include <delassus/solvers/coloured.hpp>
#include <delassus/step/in_parallel.hpp>

#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace coloured_tests {

using namespace delassus;

namespace {

using Plain = AcceleratedGaussSeidel;

void add_box_of_half_spaces(RigidBodies& set, double half) {
  set.add_fixed(HalfSpace{});
  for (const Vec3& in : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)})
    set.add_fixed(HalfSpace{in, -half});
}
std::vector<RigidBodies::Handle> add_pile(RigidBodies& set, int side) {
  std::vector<RigidBodies::Handle> all;
  add_box_of_half_spaces(set, 0.1025 * side + 0.05);
  for (int k = 0; k < side; ++k)
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) {
        const double off = 0.02 * ((k * 7 + i * 3 + j * 5) % 5 - 2);
        all.push_back(set.add({.position = {0.205 * (i - 0.5 * (side - 1)) + off,
                                            0.205 * (j - 0.5 * (side - 1)) - off, 0.1 + 0.205 * k},
                               .mass = 1.,
                               .shape = Sphere{0.1}}));
      }
  return all;
}
/// Boxes in courses, each course half a box beside the one below.
void add_wall(RigidBodies& set, int courses) {
  set.add_fixed(HalfSpace{});
  for (int k = 0; k < courses; ++k)
    for (int i = 0; i < 6; ++i)
      set.add({.position = {0.41 * i + 0.205 * (k % 2), 0, 0.1 + 0.2 * k},
               .mass = 1.,
               .shape = Box{0.4, 0.2, 0.2}});
}

/// Workers who take their tasks in turns.
struct InTurns : InParallel {
  Index workers() const { return 3; }
  template <class F>
  void run(Index tasks, F&& f) const {
    for (Index task = 0; task < tasks; ++task) f(task, task % 3);
  }
};
/// A law of a host's own, which has errors.
struct Failing : Coulomb {
  const bool* fails = nullptr;

  template <class T>
  Vec<3, T> solve_local(const Parameters& p, const Mat<3, 3, T>& W, const Vec<3, T>& b,
                        Memory<T>& memory) const {
    if (*fails) throw std::runtime_error("a law failed");
    return Coulomb::solve_local(p, W, b, memory);
  }
};

/// What is left of a solution by the solver that knows no colours, which changes nothing.
template <class Problem>
double residual_of(Problem solved) {
  return solve(solved, GaussSeidel{.max_iterations = 0, .min_iterations = 0}).measure.residual;
}

/// u = d + W λ and λ of the contacts, and the least w.
struct Answer {
  std::vector<double> u, lambda;
  double least_weight = 1e300, residual = 0, largest_d = 0;

  double size(const std::vector<double>& x) const {
    double sum = 0;
    for (const double one : x) sum += one * one;
    return std::sqrt(sum);
  }
};
template <class Problem, class Solver>
Answer answer_of(Problem problem, const Solver& solver) {
  SolverWorkspace<Problem, Solver> work;
  REQUIRE(solve(problem, solver, work).status == Status::converged);
  Answer out;
  out.residual = residual_of(problem);
  const auto& view = work.book.view(0);
  for (Index i = 0; i < view.items; ++i) {
    double u[3];
    view.table->velocity(view, i, u);
    for (int k = 0; k < 3; ++k) {
      out.u.push_back(u[k]), out.lambda.push_back(view.lambda[3 * i + k]);
      out.largest_d += view.d[3 * i + k] * view.d[3 * i + k];
    }
    out.least_weight = std::min(out.least_weight, view.weight(i));
  }
  out.largest_d = std::sqrt(out.largest_d);
  return out;
}

/// The problem of a scene after some steps, its contacts without impulses. `add` puts things into the loop.
template <class Laws, class Add>
auto problem_of(Laws laws, int steps, const Add& add) {
  AnimationLoop loop{World{RigidBodies{}}, laws, Plain{.tolerance = 1e-3}};
  add(loop);
  for (int k = 0; k < steps; ++k) loop.step(1. / 60);
  auto problem = loop.problem();
  for (auto& lambda : problem.rows.template pool<0>().lambda) lambda = zero<Vec3>();
  return problem;
}
auto pile(double friction) {
  return problem_of(Constraints{Contact{Coulomb{.friction = friction}}}, 30,
                    [](auto& loop) { add_pile(bodies<RigidBodies>(loop.world()), 6); });
}

}  // namespace

TEST_CASE("a pile swept by colour meets the tolerance as the plain measure has it") {
  const auto problem = pile(0.5);
  REQUIRE(problem.rows.row_count() > 600);
  for (const double tolerance : {1e-2, 1e-3}) {
    auto p = problem;
    const SolveReport report = solve(p, Coloured{Plain{.tolerance = tolerance}});
    REQUIRE(report.status == Status::converged);
    CHECK(report.sweeps > 10);
    // the two sums of a residual differ by rounding
    CHECK(residual_of(p) <= tolerance * (1 + 1e-6));
  }
}

// Without friction velocities are unique. Of two answers whose maps are r at the most, in the norm of
// `Measure`, both with λ ≥ 0,
//   Δλ·Δu = λ·u + λ'·u' − λ·u' − λ'·u ≤ 2 r (|λ| + |λ'|) + r (|u| + |u'|)/w,
// as u ≥ −r, and λ u ≤ r max(λ, u/w). Δλ·Δu = Δλ·W Δλ is twice the energy of the difference.
TEST_CASE("a pile without friction moves as swept in order whatever the colours") {
  const auto problem = pile(0);
  const Answer plain = answer_of(problem, Plain{.tolerance = 1e-8}),
               coloured = answer_of(problem, Coloured{Plain{.tolerance = 1e-8}});
  double energy = 0;
  for (std::size_t k = 0; k < plain.u.size(); ++k)
    energy += (plain.u[k] - coloured.u[k]) * (plain.lambda[k] - coloured.lambda[k]);
  const double speed = std::max({plain.largest_d, plain.size(plain.u), coloured.size(coloured.u)});
  const double r = std::max(plain.residual, coloured.residual) * speed;
  const double loads = plain.size(plain.lambda) + coloured.size(coloured.lambda),
               motion = plain.size(plain.u) + coloured.size(coloured.u);
  CHECK(plain.lambda != coloured.lambda);
  CHECK(std::abs(energy) <= 2 * r * loads + r * motion / plain.least_weight);
}

TEST_CASE("a wall and a chain on a pile are solved by colour") {
  auto wall = problem_of(Constraints{Contact{Coulomb{.friction = 0.6}}}, 5,
                         [](auto& loop) { add_wall(bodies<RigidBodies>(loop.world()), 6); });
  REQUIRE(wall.rows.row_count() > 192);
  REQUIRE(solve(wall, Coloured{Plain{.tolerance = 1e-4}}).status == Status::converged);
  CHECK(residual_of(wall) <= 1e-4 * (1 + 1e-6));

  auto chained = problem_of(Constraints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}}, 20, [](auto& loop) {
    auto& set = bodies<RigidBodies>(loop.world());
    const auto all = add_pile(set, 5);
    for (std::size_t k = 0; k < 4; ++k) {
      const auto a = all[k], b = all[k + 1];
      const Vec3 middle = 0.5 * (set.position(a) + set.position(b));
      loop.add(BallJoint::Item{anchor(set, a, Vec3(middle - set.position(a))),
                               anchor(set, b, Vec3(middle - set.position(b)))});
    }
  });
  REQUIRE(chained.rows.row_count() > 192);
  REQUIRE(solve(chained, Coloured{Plain{.tolerance = 1e-4}}).status == Status::converged);
  CHECK(residual_of(chained) <= 1e-4 * (1 + 1e-6));
}

TEST_CASE("small islands are swept in their own order to the last bit") {
  const auto problem = problem_of(Constraints{Contact{Coulomb{.friction = 0.5}}}, 10,
                                  [](auto& loop) { add_pile(bodies<RigidBodies>(loop.world()), 2); });
  auto p = problem, q = problem;
  solve(p, Plain{.tolerance = 1e-6}),
      solve(q, Coloured<Plain>{.solver = Plain{.tolerance = 1e-6}, .least_rows = 10000});
  for (std::size_t i = 0; i < p.rows.template pool<0>().lambda.size(); ++i)
    CHECK(p.rows.template pool<0>().lambda[i] == q.rows.template pool<0>().lambda[i]);
  auto r = problem;
  CHECK(solve(r, Coloured<Plain>{.solver = Plain{.tolerance = 1e-6}, .least_rows = 0}).status ==
        Status::converged);
  CHECK(residual_of(r) <= 1e-6 * (1 + 1e-6));
}

TEST_CASE("what a law throws in a coloured sweep ends the step") {
  bool fails = false;
  const auto check = [&fails](auto... more) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Failing{{.friction = 0.5}, &fails}}},
                       Coloured{Plain{.tolerance = 1e-2}}, more...};
    add_pile(bodies<RigidBodies>(loop.world()), 6);
    for (int k = 0; k < 20; ++k) loop.step(1. / 60);
    REQUIRE(loop.report().rows > inner::large_island);
    fails = true;
    CHECK_THROWS_AS(loop.step(1. / 60), std::runtime_error);
    fails = false;
    loop.step(1. / 60);
    CHECK(loop.report().status == Status::converged);
  };
  check();
  check(InTurns{});
}

// Islands on one kinematic floor have nothing to do with each other, nor with what the solver met in other steps.
TEST_CASE("a loop of islands on a kinematic floor that is restored goes on with the same bits by colour") {
  const auto make = [] {
    return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, Coloured<Plain>{.least_rows = 30}};
  };
  auto loop = make();
  auto& set = bodies<RigidBodies>(loop.world());
  set.add({.shape = Box{20, 20, 2}, .motion = Motion::kinematic});
  for (int heap = 0; heap < 3; ++heap)
    for (int k = 0; k < 27; ++k)
      set.add({.position = {5. * heap - 5 + 0.205 * (k % 3) + 0.03 * (k % 4), 0.205 * (k / 3 % 3) - 0.02 * (k % 5), 1.12 + 0.21 * (k / 9)},
               .mass = 1. + k % 3,
               .shape = Sphere{0.1}});
  int most = 0;
  for (int i = 0; i < 40; ++i) {
    const auto bytes = checkpoint(loop);
    auto other = make();
    restore(other, bytes);
    most = std::max(most, int(loop.step(0.01).rows));
    other.step(0.01);
    REQUIRE(state_hash(other) == state_hash(loop));
  }
  CHECK(most > 3 * 30);
}

}  // namespace coloured_tests
