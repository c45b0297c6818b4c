// The direct path on joints alone: chains and stars.
#include <delassus/solvers/direct_gauss_seidel.hpp>

#include "direct_tests.hpp"

namespace direct_gauss_seidel_tests {

using namespace direct_tests;

// What is left is the rounding of W λ: λ ~ ratio · m g h, seen over the mass of a light link, is 1e-16 · 1e6
// of g h, times some ten for the terms of a sum and a change of λ that rounds.
TEST_CASE("joints hold to rounding at any ratio of masses and any length of the chain") {
  for (const int links : {1, 2, 10, 300})
    for (const double ratio : {1., 1e3, 1e6}) {
      auto loop = chain(links, ratio, DirectGaussSeidel{});
      for (int n = 0; n < 3; ++n) {
        const StepReport report = loop.step(1e-5);
        CAPTURE(links, ratio, n);
        REQUIRE(report.status == Status::converged);
        REQUIRE(report.sweeps == 0);
        REQUIRE(loop.island_reports()[0].factorizations == 1);
      }
    }
}

// Both meet the same linear equations, one to 1e-12 of |d| ~ 0.2 m/s.
TEST_CASE("the direct path finds the velocities that tight sweeps find") {
  auto loop = chain(8, 3, GaussSeidel{.max_iterations = 1});
  auto swept = problem_of(loop);
  auto direct = swept;
  REQUIRE(solve(swept, GaussSeidel{.tolerance = 1e-12, .max_iterations = 100000}).status ==
          Status::converged);
  REQUIRE(solve(direct, DirectGaussSeidel{.tolerance = 1e-12}).status == Status::converged);
  CHECK(apart(swept, direct) <= 1e-10);
}

// A hub with n joints: in W alone each joint would meet every other. The factors must have O(n) entries:
// their number is seen by the time of a thousand spokes, which would have 500 000 blocks and 10^9 products
// otherwise.
TEST_CASE("a hub with a thousand spokes is solved at once, and its joints hold") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, DirectGaussSeidel{.tolerance = 1e-9},
                     MatrixFreeCompliance{}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const auto hub = rigid.add({.mass = 5.0, .inertia = Mat3(Mat3::Identity())});
  loop.add(BallJoint::Item{anchor(rigid, hub), world_anchor({0, 0, 0})});
  for (int k = 0; k < 1000; ++k) {
    const Vec3 way(std::cos(k), std::sin(k), std::cos(2 * k));
    const auto spoke =
        rigid.add({.position = 1.5 * way, .mass = 1.0, .inertia = Mat3(0.1 * Mat3::Identity())});
    loop.add(BallJoint::Item{anchor_at(rigid, hub, way), anchor_at(rigid, spoke, way)});
  }
  const StepReport report = loop.step(1e-3);
  CHECK(report.status == Status::converged);
  CHECK(report.sweeps == 0);
}

// Held at two corners, in one plane: its 1852 rows there act on 1452 velocities. The status is by W itself,
// which no factorization has touched. 924 joints fill in enough for `SparseLu` to take fronts.
TEST_CASE("a net of joints that hangs is solved by one factorization a step") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, DirectGaussSeidel{},
                     MatrixFreeCompliance{}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const int n = 22;
  std::vector<RigidBodies::Handle> knots;
  for (int k = 0; k < n * n; ++k)
    knots.push_back(rigid.add({.position = {double(k % n), 0, -double(k / n)},
                               .mass = 1.0,
                               .inertia = Mat3(0.02 * Mat3::Identity())}));
  const auto join = [&](int a, int b, const Vec3& half) {
    loop.add(BallJoint::Item{anchor(rigid, knots[std::size_t(a)], half),
                             anchor(rigid, knots[std::size_t(b)], -half)});
  };
  for (int k = 0; k < n * n; ++k) {
    if (k % n < n - 1) join(k, k + 1, {0.5, 0, 0});
    if (k / n < n - 1) join(k, k + n, {0, 0, -0.5});
  }
  for (const int k : {0, n - 1})
    loop.add(BallJoint::Item{world_anchor({double(k), 0, 0}), anchor(rigid, knots[std::size_t(k)])});
  for (int step = 0; step < 5; ++step) {
    const StepReport report = loop.step(1e-3);
    CAPTURE(step, report.residual);
    REQUIRE(report.status == Status::converged);
    REQUIRE(report.sweeps == 0);
    REQUIRE(loop.island_reports()[0].factorizations == 1);
  }
}

TEST_CASE("the same start gives the same bits under the direct path") {
  auto a = chain(20, 100, DirectGaussSeidel{}), b = chain(20, 100, DirectGaussSeidel{});
  for (int n = 0; n < 20; ++n) a.step(1e-3), b.step(1e-3);
  REQUIRE((end_of(a) - end_of(b)).norm() == 0);
}

}  // namespace direct_gauss_seidel_tests
