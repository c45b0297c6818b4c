// q and q̇ of joints from poses and velocities of bodies.
#include "catch.hpp"
#include "model/random_tree.hpp"

#include <numbers>

namespace model_joint_space_read_tests {

using namespace delassus;

namespace {

/// Reads the numbers of all joints; the largest gap of all.
double read_all(const Model& m, const JointSpace& space, const std::vector<Pose>& poses,
                const std::vector<Vec<6>>& velocities, std::vector<double>& q, std::vector<double>& v) {
  double gap = 0;
  for (std::size_t b = 0; b < poses.size(); ++b) {
    const Index parent = m.bodies[b].parent;
    const Pose above = parent < 0 ? Pose{} : poses[std::size_t(parent)];
    const Vec<6> above_moves = parent < 0 ? zero<Vec<6>>() : velocities[std::size_t(parent)];
    const JointGap off = space.read_q(Index(b), above, poses[b], q);
    gap = std::max({gap, off.distance, off.angle});
    space.read_v(Index(b), q, above, poses[b], above_moves, velocities[b], v);
  }
  return gap;
}

/// One body on the world with these joints, all at its origin.
Model with_joints(std::vector<model::Joint> joints) {
  Model m{.name = "one"};
  m.bodies.push_back({.name = "body", .mass = 1, .inertia = identity<Mat3>()});
  for (model::Joint& joint : joints) {
    m.bodies[0].joints.push_back(Index(m.joints.size()));
    joint.name = "joint" + std::to_string(m.joints.size());
    m.joints.push_back(joint);
  }
  return m;
}

}  // namespace

TEST_CASE("q and v of random trees are read back from poses and velocities, from the reference on") {
  for (unsigned seed = 0; seed < 40; ++seed) {
    const Model m = random_tree(seed);
    Dice dice{std::mt19937(800 + seed)};
    JointSpace space(m, Base::as_file, dice.pose(1));
    const std::vector<double> q = random_q(space, dice, 1), v = random_numbers(dice, space.v_size(), 2);
    std::vector<Pose> poses(m.bodies.size());
    std::vector<Vec<6>> velocities(m.bodies.size());
    space.poses(q, poses);
    space.velocities(q, v, velocities);
    std::vector<double> q_read(q.size()), v_read(v.size());
    space.reference(q_read);
    CHECK(read_all(m, space, poses, velocities, q_read, v_read) <= 1e-14);
    CHECK(difference(q_read, q) <= 1e-13);
    CHECK(difference(v_read, v) <= 1e-12);
  }
}

TEST_CASE("an angle is counted on over whole turns") {
  const Model m = with_joints({{.axis = {0, 0, 1}, .reference = 0.5}});
  const JointSpace space(m);
  std::vector<double> q{0.5};
  for (int k = 1; k <= 100; ++k) {
    const double angle = 0.3 * k;
    space.read_q(0, {}, {zero<Vec3>(), rotation_matrix(exponential<double>(Vec3(0, 0, angle)))}, q);
    CHECK(q[0] == Approx(0.5 + angle).epsilon(1e-13));
  }
}

TEST_CASE("three hinges go on through many turns, read step by step") {
  const Model m = with_joints({{.axis = {1, 0, 0}}, {.axis = {0, 1, 0}}, {.axis = {0, 0, 1}}});
  JointSpace space(m);
  std::vector<double> q(3);
  std::vector<Pose> pose(1);
  for (int k = 1; k <= 200; ++k) {
    const std::vector<double> goal{0.2 * k, std::sin(0.05 * k), -0.15 * k};
    space.poses(goal, pose);
    space.read_q(0, {}, pose[0], q);
    CHECK(difference(q, goal) <= 1e-12 * (1 + largest(goal)));
  }
}

TEST_CASE("where the first and third of three hinges are parallel the third one stays") {
  const double quarter = std::numbers::pi / 2;
  const Model m = with_joints({{.axis = {1, 0, 0}}, {.axis = {0, 1, 0}}, {.axis = {0, 0, 1}}});
  JointSpace space(m);
  std::vector<double> q{0.1, quarter, 0.2}, v(3);
  std::vector<Pose> pose(1);
  space.poses(std::vector<double>{0.4, quarter, 0.2}, pose);
  const JointGap gap = space.read_q(0, {}, pose[0], q);
  CHECK(gap.angle <= 1e-12);
  CHECK(difference(q, {0.4, quarter, 0.2}) <= 1e-7);
  // About the common axis, which is x of the world.
  space.read_v(0, q, {}, pose[0], zero<Vec<6>>(), twist<double>(zero<Vec3>(), {2, 0, 0}), v);
  CHECK(difference(v, {2, 0, 0}) <= 1e-6);
}

TEST_CASE("a body off its joints has the nearest q and a gap") {
  const Model m = with_joints({{.kind = model::JointKind::slide, .axis = {1, 0, 0}},
                               {.kind = model::JointKind::slide, .axis = {0, 1, 0}}});
  const JointSpace space(m);
  std::vector<double> q(2);
  const JointGap gap = space.read_q(0, {}, {{0.3, -0.7, 1e-3}}, q);
  CHECK(difference(q, {0.3, -0.7}) <= 1e-12);
  CHECK(gap.distance == Approx(1e-3).epsilon(1e-9));
  const Model swivel = with_joints({{.axis = {0, 0, 1}}});
  std::vector<double> angle(1);
  const Quat off = exponential<double>(Vec3(0, 0, 0.4)) * exponential<double>(Vec3(0.01, 0, 0));
  CHECK(JointSpace(swivel).read_q(0, {}, {zero<Vec3>(), rotation_matrix(off)}, angle).angle ==
        Approx(0.01).epsilon(1e-9));
  CHECK(angle[0] == Approx(0.4).epsilon(1e-9));
}

TEST_CASE("a quaternion keeps its sign") {
  const Model m = with_joints({{.kind = model::JointKind::ball}});
  const JointSpace space(m);
  const Quat turn = unit(Quat(0.1, 0.5, -0.7, 0.4));
  for (const double sign : {1.0, -1.0}) {
    std::vector<double> q{sign * turn.w(), sign * turn.x(), sign * turn.y(), sign * turn.z()};
    const std::vector<double> before = q;
    space.read_q(0, {}, {zero<Vec3>(), rotation_matrix(turn)}, q);
    CHECK(difference(q, before) <= 1e-15);
  }
}

// Near the pose in which the first and the third hinge are parallel they turn the body nearly alike, one against the other.
TEST_CASE("three hinges near their lock go on by less than a turn and reach the pose") {
  const Model m = with_joints({{.axis = {1, 0, 0}}, {.axis = {0, 1, 0}}, {.axis = {0, 0, 1}}});
  JointSpace space(m);
  Dice dice{std::mt19937(77)};
  for (int n = 0; n < 200; ++n) {
    const double off = std::pow(10., -2 - dice.below(7));
    std::vector<double> q{dice.number(1), std::numbers::pi / 2 - off, dice.number(1)};
    const std::vector<double> before = q;
    std::vector<Pose> pose(1);
    space.poses(q, pose);
    const Quat moved = exponential<double>(dice.vector(1e-3)) * Quat(pose[0].rotation);
    const JointGap gap = space.read_q(0, {}, {pose[0].position, rotation_matrix(moved)}, q);
    CHECK(gap.angle <= 1e-12);
    CHECK(difference(q, before) <= std::numbers::pi);
  }
}

}  // namespace model_joint_space_read_tests
