// Machines whose motion is known in closed form, and what a joint space makes of a model.
#include <delassus/model/joint_space.hpp>

#include "catch.hpp"

#include <numbers>
#include <vector>

namespace model_joint_space_tests {

using namespace delassus;

namespace {

constexpr double g = 9.81;

/// A rod without mass along −z with a point mass at its end, on a hinge along y at its other end.
model::Body rod(const char* name, Index parent, const Vec3& place, double length, double mass, Index joint) {
  return {.name = name,
          .parent = parent,
          .pose = {place},
          .mass = mass,
          .centre = {0, 0, -length},
          .joints = {joint}};
}

Model pendulum(double length, double mass) {
  Model m{.name = "pendulum"};
  m.bodies.push_back(rod("rod", -1, {0, 0, 2}, length, mass, 0));
  m.joints.push_back({.name = "swing", .axis = {0, 1, 0}});
  return m;
}

Model double_pendulum(double l1, double m1, double l2, double m2) {
  Model m = pendulum(l1, m1);
  m.bodies.push_back(rod("lower", 0, {0, 0, -l1}, l2, m2, 1));
  m.joints.push_back({.name = "elbow", .axis = {0, 1, 0}});
  return m;
}

/// A body of three different moments, its centre of mass apart from its origin.
Model single_body(model::JointKind kind) {
  Model m{.name = "single"};
  model::Body body{.name = "body", .mass = 2, .centre = {0.1, -0.2, 0.3}, .joints = {0}};
  body.inertia = columns<double>({0.1, 0, 0}, {0, 0.2, 0}, {0, 0, 0.25});
  m.bodies.push_back(body);
  m.joints.push_back({.name = "joint", .kind = kind});
  return m;
}

std::vector<double> acceleration(JointSpace& space, const std::vector<double>& q,
                                 const std::vector<double>& v, TreeForces acting = {}) {
  std::vector<double> a(v.size()), tau(v.size());
  space.forward_dynamics(q, v, tau, a, acting);
  return a;
}

const Quat turned = unit(Quat(0.8, 0.1, -0.3, 0.5));

}  // namespace

TEST_CASE("a pendulum falls with g sin(angle) / length, with a rotor by less") {
  Model m = pendulum(0.7, 3);
  JointSpace space(m);
  CHECK(acceleration(space, {0.4}, {2})[0] == Approx(-g * std::sin(0.4) / 0.7).epsilon(1e-14));
  m.joints[0].armature = 0.5;
  m.joints[0].damping = 0.2;
  m.joints[0].stiffness = 4;
  m.joints[0].spring_reference = 0.1;
  JointSpace with_all(m);
  const double torque = -3 * g * 0.7 * std::sin(0.4) - 0.2 * 2 - 4 * 0.3;
  CHECK(acceleration(with_all, {0.4}, {2})[0] == Approx(torque / (3 * 0.49 + 0.5)).epsilon(1e-14));
}

TEST_CASE("a double pendulum moves by its equations") {
  const double l1 = 0.7, m1 = 3, l2 = 0.4, m2 = 1.5;
  JointSpace space(double_pendulum(l1, m1, l2, m2));
  const double q1 = 0.4, q2 = -1.1, v1 = 2, v2 = -3;
  // Both angles against the vertical, θ₂ = q₁ + q₂:
  //   (m₁ + m₂) l₁ θ₁″ + m₂ l₂ (θ₂″ cos δ + θ₂′² sin δ) = −(m₁ + m₂) g sin θ₁,   δ = θ₁ − θ₂
  //   l₂ θ₂″ + l₁ (θ₁″ cos δ − θ₁′² sin δ) = −g sin θ₂
  const double t1 = q1, t2 = q1 + q2, w1 = v1, w2 = v1 + v2, c = std::cos(t1 - t2), s = std::sin(t1 - t2);
  const double a11 = (m1 + m2) * l1, a12 = m2 * l2 * c, a21 = l1 * c, a22 = l2;
  const double b1 = -(m1 + m2) * g * std::sin(t1) - m2 * l2 * w2 * w2 * s,
               b2 = -g * std::sin(t2) + l1 * w1 * w1 * s;
  const double over = 1 / (a11 * a22 - a12 * a21);
  const double x1 = over * (a22 * b1 - a12 * b2), x2 = over * (a11 * b2 - a21 * b1);
  const std::vector<double> a = acceleration(space, {q1, q2}, {v1, v2});
  CHECK(a[0] == Approx(x1).epsilon(1e-13));
  CHECK(a[1] == Approx(x2 - x1).epsilon(1e-13));
}

TEST_CASE("a free body falls with g and turns by Euler's equations about its centre") {
  const Model m = single_body(model::JointKind::free);
  JointSpace space(m);
  const Vec3 w{1, -2, 3}, c = m.bodies[0].centre;
  const Mat3& I = m.bodies[0].inertia;
  const std::vector<double> a = acceleration(space, {1, 2, 3, turned.w(), turned.x(), turned.y(), turned.z()},
                                             {0.3, 0.4, 0.5, 1, -2, 3});
  const Vec3 spin = inverse(I) * (-cross(w, Vec3(I * w)));
  // The centre x + R c falls, so the origin has −g e_z − R (ω′ × c + ω × (ω × c)).
  const Vec3 origin = Vec3(0, 0, -g) - rotated(turned, cross(spin, c) + cross(w, cross(w, c)));
  for (int k = 0; k < 3; ++k) {
    CHECK(a[std::size_t(k)] == Approx(origin[k]).epsilon(1e-13));
    CHECK(a[std::size_t(3 + k)] == Approx(spin[k]).epsilon(1e-13));
  }
}

TEST_CASE("a body on a ball joint turns by Euler's equations about the joint") {
  Model m = single_body(model::JointKind::ball);
  m.joints[0].point = {-0.2, 0.1, 0.4};
  JointSpace space(m);
  const Vec3 w{1, -2, 3}, arm = m.bodies[0].centre - m.joints[0].point;
  const Mat3 I = m.bodies[0].inertia - 2 * (skew(arm) * skew(arm));
  const Vec3 weight = rotated(conjugate(turned), Vec3(0, 0, -2 * g));
  const Vec3 spin = inverse(I) * (cross(arm, weight) - cross(w, Vec3(I * w)));
  const std::vector<double> a =
      acceleration(space, {turned.w(), turned.x(), turned.y(), turned.z()}, {1, -2, 3});
  for (int k = 0; k < 3; ++k) CHECK(a[std::size_t(k)] == Approx(spin[k]).epsilon(1e-13));
}

TEST_CASE("a slide across gravity, a hinge past its reference: poses") {
  Model m{.name = "cart"};
  m.bodies.push_back({.name = "cart", .pose = {{1, 0, 0}}, .mass = 1, .joints = {0, 1}});
  m.bodies.push_back({.name = "lamp", .parent = 0, .pose = {{0, 0, 0.5}}, .mass = 1});
  m.joints.push_back(
      {.name = "track", .kind = model::JointKind::slide, .axis = {1, 0, 0}, .reference = 0.25});
  m.joints.push_back({.name = "swivel", .point = {0, 2, 0}, .axis = {0, 0, 1}, .reference = 1});
  JointSpace space(m);
  std::vector<Pose> poses(2);
  std::vector<double> q(2);
  space.reference(q);
  CHECK(q == std::vector<double>{0.25, 1});
  space.poses(q, poses);
  CHECK(norm(Vec3(poses[1].position - Vec3(1, 0, 0.5))) <= 1e-15);
  // A quarter turn about the point 2 m ahead along y, which the slide took along by 0.75 m.
  space.poses(std::vector<double>{1, 1 + std::numbers::pi / 2}, poses);
  CHECK(norm(Vec3(poses[1].position - Vec3(1.75 + 2, 2, 0.5))) <= 1e-15);
  CHECK(norm(Vec3(poses[0].rotation * Vec3(1, 0, 0) - Vec3(0, 1, 0))) <= 1e-15);
}

TEST_CASE("a base is free, fixed or as the file has it") {
  Model m = single_body(model::JointKind::free);
  m.bodies.push_back(rod("arm", 0, {0, 0, 0}, 1, 1, 1));
  m.joints.push_back({.name = "swing", .axis = {0, 1, 0}});
  CHECK(JointSpace(m).q_size() == 8);
  CHECK(JointSpace(m).q_of(1) == 7);
  CHECK(JointSpace(m).v_of(1) == 6);
  const JointSpace held(m, Base::fixed);
  CHECK(held.q_size() == 1);
  CHECK(held.q_of(0) == -1);
  CHECK(held.q_of(1) == 0);
  m.bodies[0].joints.clear();
  m.joints.erase(m.joints.begin());
  m.bodies[1].joints = {0};
  CHECK(JointSpace(m).v_size() == 1);
  const JointSpace freed(m, Base::free, {{1, 2, 3}});
  CHECK(freed.v_size() == 7);
  CHECK(freed.v_of(0) == 6);
  std::vector<double> q(8);
  freed.reference(q);
  CHECK(q == std::vector<double>{1, 2, 3, 1, 0, 0, 0, 0});
}

TEST_CASE("a machine whose weight is taken off needs no force to stay") {
  Model m = double_pendulum(0.7, 3, 0.4, 1.5);
  for (model::Body& body : m.bodies) body.gravity_compensation = 1;
  JointSpace space(m);
  std::vector<double> tau(2);
  space.gravity_compensation(std::vector<double>{0.4, -1.1}, tau);
  CHECK(std::abs(tau[0]) + std::abs(tau[1]) <= 1e-14);
  space.gravity_compensation(std::vector<double>{0.4, -1.1}, tau, {.gravity_compensation = false});
  CHECK(tau[1] == Approx(1.5 * g * 0.4 * std::sin(0.4 - 1.1)).epsilon(1e-14));
}

}  // namespace model_joint_space_tests
