// Where two contacts push against each other and move nothing, and yet cannot both stick.
#include <delassus/problems/friction_problem.hpp>
#include <delassus/solvers/accelerated_gauss_seidel.hpp>
#include <delassus/solvers/inner/extrapolate_to_cone_boundary.hpp>
#include <delassus/solvers/law_set.hpp>

#include "catch.hpp"

#include <cmath>
#include <vector>

namespace leap_tests {

using namespace delassus;

namespace {

constexpr double h = 0.01, span = 0.4, radius = 0.1, friction = 0.5, stopping = 9.81 * h;  // of 1 kg, N·s

/// Gaps under the two ends of a capsule of 1 kg that lies along x on a plane, m; each point lies in the
/// middle of its gap.
struct Gaps {
  double first, second;
  /// At which the points part along the line between them while both gaps are closed in one step: the line
  /// leans by (g₁ − g₂)/2L, and its ends go up by −g/h.
  double parting() const { return (first - second) * (first - second) / (2 * span * h); }
};

/// Capsules beside each other, contacts 2k and 2k + 1 under the ends of capsule k, from sticking impulses:
/// both ends carry half of the weight, and nothing along the plane.
FrictionProblem lying(const std::vector<Gaps>& capsules) {
  std::vector<double> mu;
  std::vector<Vec3> d, lambda;
  std::vector<GivenBlock> blocks;
  for (const Gaps& gaps : capsules) {
    const Vec3 points[2] = {{0.5 * span, 0, -radius - 0.5 * gaps.first},
                            {-0.5 * span, 0, -radius - 0.5 * gaps.second}};
    const Vec3 over_inertia(1 / 0.005, 1 / 0.02, 1 / 0.02);
    const auto speed = [&](const Vec3& at, const Vec3& where, const Vec3& impulse) {
      return Vec3(impulse + over_inertia.cwiseProduct(where.cross(impulse)).cross(at));
    };
    const Vec3 axes[3] = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
    const int first = int(mu.size());
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) {
        Mat3 W;
        for (int r = 0; r < 3; ++r)
          for (int c = 0; c < 3; ++c) W(r, c) = axes[r].dot(speed(points[i], points[j], axes[c]));
        blocks.push_back({first + i, first + j, W});
      }
    for (const double gap : {gaps.first, gaps.second}) {
      mu.push_back(friction);
      d.push_back({-stopping + gap / h, 0, 0});
      lambda.push_back({0.5 * stopping, 0, 0});
    }
  }
  FrictionProblem p = make_friction_problem(mu, d, blocks);
  for (std::size_t i = 0; i < lambda.size(); ++i) p.rows.pool<0>().lambda[i] = lambda[i];
  return p;
}

double share_of_cone(const Vec3& lambda) { return std::hypot(lambda[1], lambda[2]) / (friction * lambda[0]); }

/// One end of capsule k sticks and the other slips, at the velocity `parting` and against its impulse, which
/// is at the edge of the cone. `rounding` of velocities.
void check_parts(const FrictionProblem& p, int k, double parting, double rounding) {
  const auto& lambda = p.rows.pool<0>().lambda;
  const int slips = share_of_cone(lambda[2 * k]) > share_of_cone(lambda[2 * k + 1]) ? 2 * k : 2 * k + 1;
  const Vec3 u = p.W.residual<0>(p.rows, slips);
  CHECK(share_of_cone(lambda[slips]) == Approx(1).epsilon(1e-12));
  CHECK(p.W.residual<0>(p.rows, slips ^ 1).norm() <= rounding);
  CHECK(std::abs(u[0]) <= rounding);
  CHECK(std::abs(u[1]) == Approx(parting).margin(rounding));
  CHECK(u[1] * lambda[slips][1] < 0);
}

}  // namespace

// Plain sweeps go along the line by parting/w a sweep, w some 7 kg⁻¹, and would need 1e4 … 1e8 to the edge at
// μ λ_n. Momentum stalls after 100; a leap takes 40 that are counted, at most eight in a row where one falls
// short, and what is left is momentum's.
TEST_CASE("a capsule whose ends cannot both stick slips at one of them, within some hundred sweeps") {
  for (const double gap : {1e-4, 1e-5, 3e-6, 1e-6}) {
    const Gaps gaps{gap, -gap};
    FrictionProblem p = lying({gaps});
    constexpr double tolerance = 1e-13;  // of |d|, which is 1.4 times `stopping`
    const SolveReport r = solve(p, AcceleratedGaussSeidel{.tolerance = tolerance});
    CAPTURE(gap, r.measure.residual, r.ended_by);
    REQUIRE(r.status == Status::converged);
    CHECK(r.sweeps <= 300);
    check_parts(p, 0, gaps.parting(), 10 * tolerance * stopping);
  }
}

TEST_CASE("capsules of one problem that slip at different velocities are leapt one after the other") {
  const std::vector<Gaps> gaps{{3e-6, -3e-6}, {0, 5e-6}, {-4e-6, 2e-5}};
  FrictionProblem p = lying(gaps);
  const SolveReport r = solve(p, AcceleratedGaussSeidel{.tolerance = 1e-13});
  CAPTURE(r.measure.residual, r.ended_by);
  REQUIRE(r.status == Status::converged);
  CHECK(r.sweeps <= 600);
  for (int k = 0; k < 3; ++k) check_parts(p, k, gaps[std::size_t(k)].parting(), 1e-12 * stopping);
}

TEST_CASE("a capsule with like gaps sticks at both ends, after a few sweeps") {
  FrictionProblem p = lying({{1e-6, 1e-6}});
  const SolveReport r = solve(p, AcceleratedGaussSeidel{.tolerance = 1e-13});
  REQUIRE(r.status == Status::converged);
  CHECK(r.sweeps <= 40);
  for (const int i : {0, 1}) {
    CHECK(share_of_cone(p.rows.pool<0>().lambda[i]) <= 0.5);
    CHECK(p.W.residual<0>(p.rows, i).norm() <= 1e-12 * stopping);
  }
}

// λ_t = t, μ λ_n = 0.5 at both ends; the way begins at 0 and has gone to ±0.001: what stops it first are the
// 0.5 of the end that began at −0.1 or 0.1 towards its edge.
TEST_CASE("the reach of a way is to where it leaves a cone first") {
  FrictionProblem p = lying({{0, 0}});
  auto& lambda = p.rows.pool<0>().lambda;
  Array<double> before{1, 0.1, 0, 1, 0, 0};
  lambda[0] = Vec3(1, 0.101, 0), lambda[1] = Vec3(1, -0.001, 0);
  LawSet<std::remove_cvref_t<decltype(FrictionProblem::laws)>, double> book(p.laws);
  book.prepare(p.W, p.rows, p.h);
  NoObserver nobody;
  const IslandProblem problem(book, p.rows, p.W, p.islands, 0, p.h, nobody);
  const double way[] = {0, 0.001, 0};
  double length = 0;
  for (int i = 0; i < 2; ++i) length += problem.energy(*problem.begin(), i, way);
  length = std::sqrt(length);
  // To 1e-4 of the way beyond the edge, across which the cone leans, and 1e-4 of the bisection.
  REQUIRE(inner::reach(problem, before, length, 1e15) == Approx(399).epsilon(4e-4));
  REQUIRE(inner::reach(problem, before, length, 100) == 0);  // no law ends it
  before[1] = 0.6, lambda[0] = Vec3(1, 0.601, 0);
  REQUIRE(inner::reach(problem, before, length, 1e15) == 0);  // outside already
}

TEST_CASE("sweeps that have ended do not drift") {
  FrictionProblem p = lying({{1e-6, 1e-6}});
  Array<double> before;
  LawSet<std::remove_cvref_t<decltype(FrictionProblem::laws)>, double> book(p.laws);
  book.prepare(p.W, p.rows, p.h);
  NoObserver nobody;
  IslandProblem problem(book, p.rows, p.W, p.islands, 0, p.h, nobody);
  for (int k = 0; k < 200; ++k) problem.sweep();
  REQUIRE(inner::find_slow_direction(problem, before).length == 0);
  FrictionProblem q = lying({{3e-6, -3e-6}});
  book = decltype(book)(q.laws);
  book.prepare(q.W, q.rows, q.h);
  IslandProblem drifting(book, q.rows, q.W, q.islands, 0, q.h, nobody);
  for (int k = 0; k < 200; ++k) drifting.sweep();
  REQUIRE(inner::find_slow_direction(drifting, before).length > 0);
}

}  // namespace leap_tests
