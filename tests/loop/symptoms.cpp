// The table of docs/how_to/debug.md: each symptom is made, the report shows what the table names, and what it
// advises takes it away.
#include "scenes.hpp"

#include <delassus/schemes/substeps.hpp>
#include <delassus/steppers/newton_midpoint.hpp>

#include "catch.hpp"

namespace symptoms_tests {

using namespace scenes;

namespace {

constexpr double h = 1.0 / 60;

struct Run {
  StepReport last;
  double penetration = 0;  ///< largest, m
  double joint_gap = 0;    ///< largest, m or rad
  double speed = 0;        ///< largest of the second half, m/s
  int unconverged = 0;
};

template <class Loop>
Run run(Loop& loop, const std::vector<RigidBodies::Handle>& watched, double seconds, double step = h) {
  Run seen;
  const int steps = int(std::lround(seconds / step));
  for (int n = 0; n < steps; ++n) {
    seen.last = loop.step(step);
    seen.penetration = std::max(seen.penetration, seen.last.max_penetration);
    seen.joint_gap = std::max(seen.joint_gap, seen.last.max_joint_violation);
    seen.unconverged += seen.last.status != Status::converged;
    if (2 * n < steps) continue;
    for (const auto body : watched)
      seen.speed = std::max(seen.speed, rigid_bodies(loop).velocity(body).norm());
  }
  return seen;
}

/// Ten boxes, set down on each other, for five seconds.
template <class Solver>
Run stand_ten(Solver solver, double step = h) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, solver};
  return run(loop, add_stack(rigid_bodies(loop), 10, Box{1, 1, 1}), 5, step);
}

/// Five boxes, each a fifth of its size in the next.
template <class... Policies>
Run overlap(Policies... policies) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, policies...};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  std::vector<RigidBodies::Handle> boxes;
  for (int i = 0; i < 5; ++i)
    boxes.push_back(set.add({.position = {0, 0, 0.5 + 0.8 * i}, .mass = 1.0, .shape = Box{1, 1, 1}}));
  return run(loop, boxes, 0.3);
}

/// Ten rods of 1 kg and 1 m with a weight at the end, held level and let go.
template <class... Policies>
Run heavy_chain(Policies... policies) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, policies...};
  auto& set = rigid_bodies(loop);
  Anchor end = world_anchor({0, 0, 0});
  for (int i = 0; i < 10; ++i) {
    const double mass = i < 9 ? 1 : 100;
    const auto link =
        set.add({.position = {0.5 + i, 0, 0}, .mass = mass, .inertia = Mat3(0.1 * mass * Mat3::Identity())});
    loop.add(BallJoint::Item{end, anchor(set, link, {-0.5, 0, 0})});
    end = anchor(set, link, {0.5, 0, 0});
  }
  return run(loop, {}, 2);
}

}  // namespace

// What a residual r leaves is velocity, and less of it by the same factor where r is less.
TEST_CASE("bodies at rest creep by a loose tolerance and not by the default") {
  const Run loose = stand_ten(AcceleratedGaussSeidel{.tolerance = 1e-2}),
            tight = stand_ten(AcceleratedGaussSeidel{});
  CHECK(loose.last.residual > 1e-4);
  CHECK(tight.last.residual <= 1e-6);
  CHECK(loose.speed > 1e-3);
  CHECK(tight.speed < 1e-3 * loose.speed);
}

TEST_CASE("bodies sink in where sweeps end too early and stand with more of them") {
  const GaussSeidel few{.tolerance = 1e-6, .max_iterations = 10};
  const Run sinking = stand_ten(few), standing = stand_ten(AcceleratedGaussSeidel{}),
            shorter = stand_ten(few, h / 4);
  CHECK(sinking.unconverged > 290);
  CHECK(sinking.penetration > 1e-3);
  CHECK(standing.unconverged == 0);
  CHECK(standing.penetration < 1e-3 * sinking.penetration);
  // What is left of weight falls for a step, g h² / 2.
  CHECK(shorter.penetration < sinking.penetration / 4);
}

// A fifth of a metre is pushed out at the rate of 0.2 a step, capped at 1 m/s a contact, which adds up over
// four of them.
TEST_CASE("bodies that overlap at the start fly apart unless positions are projected") {
  const Run pushed = overlap(), moved = overlap(PositionProjection{});
  CHECK(pushed.penetration == Approx(0.2).epsilon(1e-6));
  CHECK(pushed.speed > 1);
  CHECK(moved.penetration == Approx(0.2).epsilon(1e-6));
  CHECK(moved.speed < 1e-6);
}

TEST_CASE("bodies without a contact law pass through each other") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}};
  const auto boxes = add_stack(rigid_bodies(loop), 1, Box{1, 1, 1});
  CHECK(run(loop, boxes, 0.5).last.contacts == 0);
  CHECK(rigid_bodies(loop).position(boxes[0])[2] < 0);  // 0.5 m less g t² / 2 = 1.2 m
}

// The default corrects a fifth of a gap a step to first order. In four steps for one an error of second order
// is a sixteenth, and what is left of it is corrected whole. NewtonMidpoint solves for the gap itself, to
// rounding of lengths of 10 m.
TEST_CASE("joints of a heavy chain open by default and stay closed by advice") {
  const Run plain = heavy_chain(), whole = heavy_chain(WholeViolation{}, Substeps{4}),
            newton = heavy_chain(NewtonMidpoint{});
  CHECK(plain.joint_gap > 1e-2);
  CHECK(whole.joint_gap < 1e-2 * plain.joint_gap);
  CHECK(newton.joint_gap < 1e-12);
}

}  // namespace symptoms_tests
