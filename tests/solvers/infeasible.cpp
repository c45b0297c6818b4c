// Rows that contradict each other are told from rows that are hard to solve.
#include <delassus/problems/friction_problem.hpp>
#include <delassus/solvers/accelerated_gauss_seidel.hpp>

#include "scenes.hpp"

#include "catch.hpp"

namespace infeasible_tests {

using namespace scenes;

namespace {

constexpr double h = 0.01;

/// Two contacts on one body of 1 kg that push it to and fro, with d_n = `first` and `second`; `leak` is what
/// the second one's normal is off.
FrictionProblem vice(double first, double second, double leak = 0) {
  const Vec3 a(1, 0, 0), b(-1, leak, 0);
  const auto block = [](const Vec3& n, const Vec3& m, bool own) {
    Mat3 W = own ? Mat3(Mat3::Identity()) : Mat3(Mat3::Zero());
    W(0, 0) = n.dot(m);
    return W;
  };
  return make_friction_problem({0.5, 0.5}, {{first, 0, 0}, {second, 0, 0}},
                               {{0, 0, block(a, a, true)},
                                {0, 1, block(a, b, false)},
                                {1, 0, block(b, a, false)},
                                {1, 1, block(b, b, true)}});
}

double largest(const FrictionProblem& p) {
  double most = 0;
  for (const Vec3& x : p.rows.pool<0>().lambda) most = std::max(most, x.norm());
  return most;
}

auto rod_loop() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{DistanceJoint{}}, AcceleratedGaussSeidel{}};
}

}  // namespace

// u = (λ₁ − λ₂ − 1, λ₂ − λ₁ − 1) has the sum −2 whatever λ is.
TEST_CASE("two contacts that cannot both hold are infeasible, with a bounded compromise half way") {
  FrictionProblem p = vice(-1, -1);
  const SolveReport r = solve(p, AcceleratedGaussSeidel{});
  REQUIRE(r.status == Status::infeasible);
  REQUIRE(r.sweeps < 1000);
  // λ = 1/ε w, ε = 0.105, w = (W_nn + 2)/3 = 1.
  REQUIRE(largest(p) == Approx(1 / 0.105).epsilon(0.01));
  REQUIRE(p.W.residual<0>(p.rows, 0)[0] == Approx(-1).margin(1e-4));  // both are missed by as much
}

TEST_CASE("the compromise does not depend on the impulses before") {
  FrictionProblem p = vice(-1, -0.4), q = p;
  q.rows.pool<0>().lambda = {Vec3(7, 0, 0), Vec3(300, 0, 0)};
  REQUIRE(solve(p, AcceleratedGaussSeidel{}).status == Status::infeasible);
  REQUIRE(solve(q, AcceleratedGaussSeidel{}).status == Status::infeasible);
  for (int i = 0; i < 2; ++i)
    REQUIRE((p.rows.pool<0>().lambda[i] - q.rows.pool<0>().lambda[i]).norm() <= 1e-4 * largest(p));
}

TEST_CASE("a vice with room is solved") {
  for (const double room : {0.0, 1e-9, 1e-3, 1.0}) {
    FrictionProblem p = vice(-1, 1 + room);
    REQUIRE(solve(p, AcceleratedGaussSeidel{}).status == Status::converged);
  }
}

// Off by 1e-3 the second contact can push the body sideways: λ = 2e6 N·s would do it. No proof then, and no
// claim.
TEST_CASE("rows that only enormous impulses would meet are not called infeasible") {
  for (const double leak : {1e-1, 1e-2, 1e-3}) {
    FrictionProblem p = vice(-1, -1, leak);
    REQUIRE(solve(p, AcceleratedGaussSeidel{}).status != Status::infeasible);
  }
}

// The rods pull and push by 0.2 × 0.5 m/0.01 s = 10 m/s each: the body stays where both are missed by as
// much.
TEST_CASE("two rods of different lengths between the same points are infeasible and leave the body at rest") {
  AnimationLoop loop = rod_loop();
  auto& set = rigid_bodies(loop);
  set.gravity.setZero();
  const auto ball = set.add({.position = {1.5, 0, 0}, .mass = 1.0, .shape = Sphere{0.1}});
  loop.add(DistanceJoint::Item{anchor(set, ball), world_anchor({0, 0, 0}), 1});
  const auto longer = loop.add(DistanceJoint::Item{anchor(set, ball), world_anchor({0, 0, 0}), 2});
  double impulse = 0;
  for (int n = 0; n < 100; ++n) {
    REQUIRE(loop.step(h).status == Status::infeasible);
    REQUIRE(set.velocity(ball).norm() < 1e-3);
    impulse = std::max(impulse, std::abs(loop.impulse(longer)[0]));
  }
  REQUIRE(impulse < 2 * 10 / 0.105);  // |d|/ε w, w = 1/kg
  REQUIRE((set.position(ball) - Vec3(1.5, 0, 0)).norm() < 1e-3);
  loop.remove(longer);
  for (int n = 0; n < 10; ++n) loop.step(h);
  REQUIRE(loop.report().status == Status::converged);
  REQUIRE(set.velocity(ball).norm() < 10);  // 0.2 of what is left of 0.5 m a step
}

}  // namespace infeasible_tests
