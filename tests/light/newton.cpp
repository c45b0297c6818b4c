// Newton's method through the second table.
#include "newton.hpp"

#include "newton_table.hpp"
#include "scenes_of_step.hpp"

#include "catch.hpp"

#include <Eigen/Cholesky>

namespace light_newton_tests {

using namespace light;

namespace {

template <class Step>
void differentiate_all(Step& step) {
  std::apply([](auto&... pool) { (differentiate(pool), ...); }, step.pools.typed);
}

}  // namespace

TEST_CASE("a law that is only swept has no second table, and Newton's method leaves its island alone") {
  const auto loop = stack(2);
  FlatStep step(loop);
  const Array<double> before = step.rows.lambda;
  const SolveReport report = step.solve(Newton{});
  CHECK(report.status == Status::stalled);
  CHECK(report.factorizations == 0);
  CHECK(difference(step.rows.lambda, before) == 0);
}

TEST_CASE("joints alone take one step, and what the lift of the matrix leaves another") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}, Hinge{}}, delassus::GaussSeidel{}};
  auto& set = loop.world().set<0>();
  std::array<RigidBodies::Handle, 5> link;
  for (int k = 0; k < 5; ++k)
    link[k] = set.add({.position = {1.0 * k, 0, 0},
                       .velocity = {0, 0.1 * k, 0},
                       .mass = k < 4 ? 1.0 : 1000.0,
                       .shape = Box{1, 0.2, 0.2}});
  loop.add(BallJoint::Item{world_anchor({-0.5, 0, 0}), anchor(set, link[0], {-0.5, 0, 0})});
  for (int k = 0; k < 4; ++k)
    loop.add(Hinge::Item{anchor(set, link[k], {0.5, 0, 0}), anchor(set, link[k + 1], {-0.5, 0, 0})});
  stop_before_solve(loop, 0.01);
  FlatStep step(loop);
  differentiate_all(step);
  const SolveReport report = step.solve(Newton{.tolerance = 1e-10});
  CHECK(report.status == Status::converged);
  CHECK(report.factorizations <= 3);  // the others for what ε leaves
}

TEST_CASE("contacts and joints on bodies of three kinds are met in a few factorizations") {
  const auto loop = mixed();
  for (const bool is_convex : {false, true})
    for (const Index most_partners : {Delassus<double>::all_blocks, Index(0)}) {
      FlatStep step(loop, most_partners);
      differentiate_all(step);
      step.solve(light::GaussSeidel{.tolerance = 0, .max_iterations = 5});
      const SolveReport report =
          step.solve(Newton{.tolerance = 1e-10, .max_iterations = 400, .is_convex = is_convex});
      CAPTURE(is_convex, most_partners);
      CHECK(report.status == Status::converged);
      CHECK(report.factorizations <= (is_convex ? 100 : 5));  // a given slip is found by repetition
      // Boxes with four contacts each have many impulses that meet all laws: the library's measure judges, on
      // the library's W.
      Index row = 0;
      for_each_index<4>([&](auto p) {
        for (auto& x : step.problem.rows.template pool<p>().lambda)
          for (double& y : x) y = step.rows.lambda[row++];
      });
      CHECK(delassus::solve(step.problem, delassus::GaussSeidel{.max_iterations = 0}).measure.residual <=
            1.1e-10);
    }
}

}  // namespace light_newton_tests
