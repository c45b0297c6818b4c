// Newton's method on joints, springs and bouncing contacts.
#include "newton_tests.hpp"

namespace proximal_newton_joints_tests {

using namespace newton_tests;

namespace {

/// Five boxes on each other, each hooked to the next by a ball joint on one edge and by a soft distance joint
/// on the other.
template <class Solver>
auto hooked_stack(Solver solver) {
  AnimationLoop loop{
      World{RigidBodies{}},
      Constraints{Contact{Restitution{Coulomb{.friction = 0.5}, 0.0}}, BallJoint{}, DistanceJoint{}}, solver};
  auto& set = rigid_bodies(loop);
  const auto boxes = add_stack(set, 5, Box{1, 1, 1}, 0);
  for (int i = 0; i < 4; ++i) {
    loop.add(
        BallJoint::Item{anchor(set, boxes[i], {0.5, 0, 0.5}), anchor(set, boxes[i + 1], {0.5, 0, -0.5})});
    loop.add(DistanceJoint::Item{anchor(set, boxes[i], {-0.5, 0, 0}), anchor(set, boxes[i + 1], {-0.5, 0, 0}),
                                 0.9, 1000., 10.});
  }
  return loop;
}

/// A rod of boxes on ball joints that leans on a wall and on a box, and a soft distance joint: joints and
/// contacts together.
template <class Solver>
auto jointed_loop(Solver solver, double foot_mass = 3) {
  AnimationLoop loop{
      World{RigidBodies{}},
      Constraints{Contact{Restitution{Coulomb{.friction = 0.4}, 0.3}}, BallJoint{}, DistanceJoint{}}, solver};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  const auto foot = set.add({.position = {0, 0, 0.5}, .mass = foot_mass, .shape = Box{1, 1, 1}});
  RigidBodies::Handle last;
  for (int i = 0; i < 4; ++i) {
    const auto link =
        set.add({.position = {0.6 * i, 0, 1.05}, .mass = i == 3 ? 20.0 : 1.0, .shape = Box{0.55, 0.2, 0.1}});
    if (i > 0) loop.add(BallJoint::Item{anchor(set, last, {0.3, 0, 0}), anchor(set, link, {-0.3, 0, 0})});
    last = link;
  }
  loop.add(DistanceJoint::Item{anchor(set, last, {0, 0, 0.05}), world_anchor({1.8, 0, 3}), 1.5, 2000., 10.});
  loop.add(DistanceJoint::Item{anchor(set, last, {0.2, 0, 0}), anchor(set, foot, {0, 0.5, 0}), 2.0});
  return loop;
}

}  // namespace

TEST_CASE("Newton's method and tight sweeps find the same velocities on joints and contacts") {
  auto loop = jointed_loop(AcceleratedGaussSeidel{.max_iterations = 1});
  compare(problem_of(loop));
  auto hooked = hooked_stack(AcceleratedGaussSeidel{.max_iterations = 1});
  compare(problem_of(hooked));
}
TEST_CASE("a stack with joints and springs in it converges in every step") {
  auto loop = hooked_stack(ProximalNewton{.tolerance = 1e-8});
  const Warm seen = run(loop, 300);
  CHECK(seen.unconverged == 0);
  CHECK(seen.sweeps == 0);
}

// Sliding, bouncing, hanging in a closed loop of joints. One run is chance, since its bounces are; of the 3600
// steps of twelve accelerated sweeps give up in some 180, this method in some 90, and both in one chain, the
// default, in some 8. Such counts vary by their root when last bits change: what is asked is three roots away.
TEST_CASE("where sweeps give up Newton's method gives up less often, and so does the chain of both") {
  int alone = 0, swept = 0, chained = 0;
  for (double foot = 2.5; foot < 3.42; foot += 0.08) {
    auto newton = jointed_loop(ProximalNewton{.tolerance = 1e-9}, foot);
    auto sweeps = jointed_loop(AcceleratedSweeps{.tolerance = 1e-9}, foot);
    auto chain = jointed_loop(AcceleratedGaussSeidel{.tolerance = 1e-9}, foot);
    alone += run(newton, 300).unconverged;
    swept += run(sweeps, 300).unconverged;
    chained += run(chain, 300).unconverged;
  }
  CAPTURE(alone, swept, chained);
  CHECK(4 * alone < 3 * swept);
  CHECK(4 * chained < swept);
}

TEST_CASE("the same start gives the same bits") {
  auto a = jointed_loop(ProximalNewton{}), b = jointed_loop(ProximalNewton{});
  run(a, 50);
  run(b, 50);
  auto &x = rigid_bodies(a), &y = rigid_bodies(b);
  for (Index i = 1; i < x.blocks(); ++i) {
    REQUIRE((x.velocity()[i] - y.velocity()[i]).norm() == 0);
    REQUIRE((x.position(x.handle(i)) - y.position(y.handle(i))).norm() == 0);
  }
}

}  // namespace proximal_newton_joints_tests
