/// The problem of a step of a loop, with its bodies and joints, by the solvers that need them.
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/problems/friction_problem.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>
#include <delassus/solvers/path_newton.hpp>
#include <delassus/solvers/proximal_newton.hpp>

#include "problem_run.hpp"
#include "scenes.hpp"

using namespace trace;

namespace {

/// A chain of two and a tower of two whose upper cube the chain's end holds, after some steps.
auto problem() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.4}}, BallJoint{}}};
  auto& set = rigid_of(loop);
  set.add_fixed(HalfSpace{});
  Anchor end;
  add_chain(loop, 2, 1.2, [&](const Anchor& a, const Anchor& b) { loop.add(BallJoint::Item{a, b}); });
  const auto lower = set.add({.position = {1.5, 0, 0.25}, .mass = 1.0, .shape = Box{0.5, 0.5, 0.5}});
  const auto upper = set.add(
      {.position = {1.5, 0, 0.75}, .velocity = {0.1, 0, 0}, .mass = 20.0, .shape = Box{0.5, 0.5, 0.5}});
  set.set_velocity(lower, {0.05, 0, 0});
  loop.add(BallJoint::Item{anchor(set, set.handle(2), {0.25, 0, 0}), anchor(set, upper, {-0.5, 0, 0.45})});
  for (int n = 0; n < 3; ++n) loop.step(0.01);
  return loop.problem();
}
FrictionProblem contacts() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.4}}}};
  add_heap(loop);
  for (int n = 0; n < 12; ++n) loop.step(0.01);  // few, since a problem made by other bits is another problem
  return friction_problem(loop.problem());
}

}  // namespace

int main(int argc, char** argv) {
  Trace all("problems_more");
  const Options faces{.is_redundant = true};
  add_problem(all, "loop_accelerated", faces, problem,
              [](auto& p) { return solve(p, AcceleratedGaussSeidel{.tolerance = 1e-9}); });
  add_problem(all, "loop_direct", faces, problem,
              [](auto& p) { return solve(p, DirectGaussSeidel{.tolerance = 1e-9}); });
  add_problem(all, "loop_proximal", faces, problem,
              [](auto& p) { return solve(p, ProximalNewton{.tolerance = 1e-9}); });
  add_problem(all, "loop_path", faces, problem,
              [](auto& p) { return solve(p, PathNewton{.tolerance = 1e-9}); });
  add_problem(all, "matrix_of_a_loop", faces, contacts,
              [](auto& p) { return solve(p, AcceleratedGaussSeidel{.tolerance = 1e-9}); });
  return all.main(argc, argv);
}
