// What a joint space refuses, each in one sentence.
#include "catch.hpp"
#include "model/random_tree.hpp"

#include <functional>
#include <limits>

namespace model_joint_space_bad_input_tests {

using namespace delassus;
using Catch::Matchers::Contains;

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// A body on a ball joint with one on a hinge.
Model arm() {
  Model m{.name = "arm"};
  for (const Index b : {0, 1})
    m.bodies.push_back({.name = b == 0 ? "upper" : "lower",
                        .parent = b - 1,
                        .mass = 1,
                        .inertia = identity<Mat3>(),
                        .joints = {b}});
  m.joints.push_back({.name = "shoulder", .kind = model::JointKind::ball});
  m.joints.push_back({.name = "elbow"});
  return m;
}

void expect(const std::function<void()>& call, const std::string& sentence) {
  CHECK_THROWS_WITH(call(), Contains("delassus: ") && Contains(sentence));
}

}  // namespace

TEST_CASE("lists of wrong size, numbers that are not finite and quaternions that are none are refused") {
  JointSpace space(arm());
  std::vector<double> q{1, 0, 0, 0, 0.5}, v(4), tau(4), H(16), short_one(3);
  std::vector<Vec<6>> J(4);
  std::vector<Pose> poses(2);
  expect([&] { space.poses(v, poses); }, "q has 4 entries and must have 5");
  expect([&] { space.poses(q, {poses.data(), 1}); }, "the list of poses has 1 entries and must have 2");
  expect([&] { space.inverse_dynamics(q, q, v, tau); }, "v has 5 entries and must have 4");
  expect([&] { space.inverse_dynamics(q, v, short_one, tau); }, "a has 3 entries");
  expect([&] { space.inverse_dynamics(q, v, v, short_one); }, "tau has 3 entries");
  expect([&] { space.forward_dynamics(q, v, short_one, tau); }, "tau has 3 entries");
  expect([&] { space.forward_dynamics(q, v, tau, short_one); }, "a has 3 entries");
  expect([&] { space.mass_matrix(q, tau); }, "the mass matrix has 4 entries and must have 16");
  expect([&] { space.gravity_compensation(q, short_one); }, "tau has 3 entries");
  expect([&] { space.jacobian(q, 0, zero<Vec3>(), {J.data(), 3}); }, "the list of columns has 3");
  expect([&] { space.jacobian(q, 2, zero<Vec3>(), J); }, "there is no body 2, only 2");
  expect([&] { space.jacobian(q, -1, zero<Vec3>(), J); }, "there is no body -1");
  expect([&] { space.jacobian(q, 0, Vec3(none, 0, 0), J); }, "the point of a Jacobian is not finite");
  expect([&] { space.q_of(2); }, "there is no joint 2, only 2");
  v[2] = none;
  expect([&] { space.forward_dynamics(q, v, tau, tau); }, "v[2] is not finite");
  q[4] = std::numeric_limits<double>::infinity();
  expect([&] { space.poses(q, poses); }, "q[4] is not finite");
  q[4] = 0, q[0] = 0.9;
  expect([&] { space.poses(q, poses); },
         "the quaternion of joint 'shoulder' in q has the length 0.9 and must have 1");
  q[0] = 1;
  expect([&] { space.read_q(0, {}, {Vec3(none, 0, 0)}, q); }, "the pose of body 'upper' is not finite");
  expect([&] { space.read_q(1, {Vec3(none, 0, 0)}, {}, q); }, "the pose of body 'upper' is not finite");
}

TEST_CASE("bodies without mass that move, or with too many joints, are refused") {
  Model m = arm();
  m.bodies[1].mass = 0;
  expect([&] { JointSpace space(m); }, "has mass");
  m.bodies[1].is_kinematic = true;
  expect([&] { JointSpace space(m); }, "body 'lower' moves, and neither it nor what is fixed to it has mass");

  m = arm();
  m.bodies[0].joints.clear();
  m.bodies[0].mass = 0;
  m.bodies[1].joints = {0, 1};
  CHECK(JointSpace(m).v_size() == 4);
  expect([&] { JointSpace space(m, Base::free); }, "body 'upper' moves");

  m = arm();
  for (int k = 0; k < 6; ++k) {
    m.bodies[1].joints.push_back(Index(m.joints.size()));
    m.joints.push_back({.name = "more" + std::to_string(k), .kind = model::JointKind::slide});
  }
  expect([&] { JointSpace space(m); }, "body 'lower' has 7 freedoms");
}

TEST_CASE("a freedom that moves nothing is refused where accelerations are asked for") {
  Model m = arm();
  m.bodies[1].inertia = zero<Mat3>();
  JointSpace space(m);
  std::vector<double> q{1, 0, 0, 0, 0.5}, v(4), tau(4), a(4);
  space.inverse_dynamics(q, v, v, tau);
  expect([&] { space.forward_dynamics(q, v, tau, a); }, "joint 'elbow' moves nothing that has inertia");
  m.joints[1].armature = 0.1;
  JointSpace with_rotor(m);
  with_rotor.forward_dynamics(q, v, tau, a);
  CHECK(largest(a) < 1e-12);
}

TEST_CASE(
    "a chain of a hundred thousand links takes no stack, and a hundred thousand free bodies no square of "
    "that") {
  Model m = arm();
  m.bodies.resize(2);
  for (Index b = 2; b < 100'000; ++b) {
    m.bodies.push_back(m.bodies[1]);
    m.bodies.back().name = "link" + std::to_string(b);
    m.bodies.back().parent = b - 1;
    m.bodies.back().joints = {b};
    m.joints.push_back({.name = "joint" + std::to_string(b)});
  }
  JointSpace space(m);
  CHECK(space.v_size() == 100'002);
  std::vector<double> q(std::size_t(space.q_size())), v(std::size_t(space.v_size())), a(v.size());
  space.reference(q);
  space.forward_dynamics(q, v, v, a);
  CHECK(std::isfinite(largest(a)));
  for (model::Body& body : m.bodies) body.joints.clear(), body.parent = -1;
  m.joints.clear();
  CHECK(JointSpace(m, Base::free).v_size() == 600'000);
}

}  // namespace model_joint_space_bad_input_tests
