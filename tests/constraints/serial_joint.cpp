#include <delassus/constraints/joints/euler_angles.hpp>
#include <delassus/constraints/joints/serial_joint.hpp>
#include <delassus/delassus.hpp>
#include <delassus/steppers/newton_midpoint.hpp>

#include "catch.hpp"
#include "constraints/poses.hpp"

#include <cmath>
#include <random>

namespace serial_joint_tests {

using namespace delassus;
using namespace poses;

namespace {

Quat about(const Vec3& axis, double angle) { return Quat(Eigen::AngleAxisd(angle, axis.normalized())); }

/// A joint of two hinges as a user tells it: axes and points in the frame of the bodies at zero angles, m.
struct TwoHinges {
  Vec3 first, last, at_first, at_last;

  /// The ends, the angle between the axes and their distance; of the world and of a body that was at the origin.
  SerialJoint<0, 2>::Item item(const RigidBodies& set, RigidBodies::Handle body) const {
    const Vec3 p = first.normalized(), q = last.normalized(), n = p.cross(q), r = at_last - at_first;
    // The nearest points: r = s p + offset n/|n|² … − t q.
    const double c = p.dot(q), s = (r.dot(p) - c * r.dot(q)) / (1 - c * c), t = (c * r.dot(p) - r.dot(q)) / (1 - c * c);
    const Quat frame_a = frame_along(p), frame_b = frame_along(q);
    return {.a = world_anchor(at_first + s * p, frame_a),
            .b = anchor(set, body, at_last + t * q, frame_b),
            .cosine = c,
            .offset = r.dot(n) / n.squaredNorm()};
  }
  /// Where a body is that was at the origin.
  Pose pose(double q1, double q2) const {
    const Mat3 R1 = about(first, q1).toRotationMatrix(), R2 = about(last, q2).toRotationMatrix();
    const Vec3 inner = at_last - R2 * at_last;
    return {at_first + R1 * (inner - at_first), R1 * R2};
  }
};

}  // namespace

TEMPLATE_TEST_CASE_SIG("the rows of a serial joint are the derivatives of its violation, in every pose", "", ((int s, int h), s, h), (0, 2), (0, 3),
                       (1, 0), (1, 1), (1, 2), (2, 0), (2, 1), (2, 2), (2, 3), (3, 1), (3, 2), (3, 0)) {
  each_pair([](int a, int b, Scene& scene) {
    if (a == 2 || a == 3 || b == 2 || b == 3) return;
    using Law = SerialJoint<s, h>;
    const typename Law::Item item{.a = scene.end(a, scene.turn()),
                                  .b = scene.end(b, scene.turn()),
                                  .slide = scene.vector(),
                                  .cosine = 0.3,
                                  .offset = 0.7};
    const Written<Law> rows({}, item, scene.world);
    const auto phi = [&] { return Written<Law>({}, item, scene.world).phi; };
    CHECK(difference<Law::rows>(scene, rows.H, phi) <= 1e-8);
  });
}

TEMPLATE_TEST_CASE("the row of an Euler angle is the derivative of the angle, in every pose", "", Precession, Nutation, Spin) {
  each_pair([](int a, int b, Scene& scene) {
    if (a == 2 || a == 3 || b == 2 || b == 3) return;
    const typename Drive<TestType>::Item item{.a = scene.end(a, scene.turn()), .b = scene.end(b, scene.turn()), .stiffness = 1};
    const double c = (scene.world.frame(item.a) * unit_axis(2)).dot(scene.world.frame(item.b) * unit_axis(2));
    if (1 - c * c < 0.05) return;  // its second derivatives grow as 1/(1 − c²)²
    const Written<Drive<TestType>> rows({}, item, scene.world);
    const auto phi = [&] { return Written<Drive<TestType>>({}, item, scene.world).phi; };
    CHECK(difference<1>(scene, rows.H, phi) <= 1e-6);
  });
}

TEST_CASE("the Euler angles make the turn again, and are quiet where the axes are parallel") {
  Scene scene(3);
  for (int n = 0; n < 50; ++n) {
    const double psi = 3.1 * scene.draw(), theta = 1.57 + 1.4 * scene.draw(), phi = 3.1 * scene.draw();
    const Quat turn = about(Vec3::UnitZ(), psi) * about(Vec3::UnitX(), theta) * about(Vec3::UnitZ(), phi);
    const Quat base = scene.turn();
    const JointFrames frames(world_anchor(Vec3::Zero(), base), world_anchor(Vec3::Zero(), base * turn), scene.world);
    CHECK(Precession::value(frames) == Approx(psi).margin(1e-13));
    CHECK(Nutation::value(frames) == Approx(theta).margin(1e-13));
    CHECK(Spin::value(frames) == Approx(phi).margin(1e-13));
  }
  const JointFrames parallel(world_anchor(Vec3::Zero()), world_anchor(Vec3::Zero()), scene.world);
  CHECK(std::isfinite(Precession::value(parallel)));
  CHECK(Nutation::value(parallel) == 0);
  CHECK(std::isfinite(Spin::value(parallel)));
}

// The ankle of a humanoid: two axes that pass each other by 4 cm, not at right angles here.
TEST_CASE("two hinges that pass each other leave exactly their two angles") {
  const TwoHinges ankle{{0, 1, 0}, {1, 0.4, 0.5}, {0.02, 0, 0.08}, {0, 0.01, 0.04}};
  AnimationLoop loop{World{RigidBodies{}}, Constraints{SerialJoint<0, 2>{}}};
  auto& set = bodies<RigidBodies>(loop.world());
  const auto foot = set.add({.mass = 1.0, .shape = Box{0.2, 0.1, 0.05}});
  const auto item = ankle.item(set, foot);
  loop.add(item);
  const JointFrames start(item.a, item.b, loop.world());
  const double zero1 = Precession::value(start), zero2 = Spin::value(start);
  for (const double q1 : {-2.0, -0.3, 0.0, 0.4, 1.9})
    for (const double q2 : {-1.8, -0.2, 0.0, 0.7, 2.2}) {
      const Pose pose = ankle.pose(q1, q2);
      set.place(foot, pose.position, Quat(pose.rotation));
      const JointFrames frames(item.a, item.b, loop.world());
      const Vec3 miss = frames.xa - frames.xb + item.offset * frames.a(2).cross(frames.b(2));
      CHECK(miss.norm() < 1e-15);
      CHECK(std::abs(frames.a(2).dot(frames.b(2)) - item.cosine) < 1e-15);
      CHECK(std::abs(std::remainder(Precession::value(frames) - zero1 - q1, 2 * M_PI)) < 1e-13);
      CHECK(std::abs(std::remainder(Spin::value(frames) - zero2 - q2, 2 * M_PI)) < 1e-13);
    }
}

// With a light body between them two hinges are the same joint. Its mass of 1e-7 changes accelerations by that share.
TEST_CASE("a foot on two hinges moves as on two joints with a light body between") {
  const TwoHinges ankle{{0, 1, 0}, {1, 0.4, 0.5}, {0.02, 0, 0.08}, {0, 0.01, 0.04}};
  const auto start = [&](auto& set) {
    const auto foot = set.add({.position = {0, 0, 0}, .mass = 1.0, .shape = Box{0.2, 0.1, 0.05}});
    return foot;
  };
  AnimationLoop serial{World{RigidBodies{}}, Constraints{SerialJoint<0, 2>{}}, NewtonMidpoint{}};
  auto& one = bodies<RigidBodies>(serial.world());
  const auto foot = start(one);
  serial.add(ankle.item(one, foot));
  AnimationLoop chain{World{RigidBodies{}}, Constraints{Hinge{}}, NewtonMidpoint{}};
  auto& two = bodies<RigidBodies>(chain.world());
  const auto other = start(two);
  const auto between = two.add({.position = {0.01, 0.005, 0.06}, .mass = 1e-7, .inertia = Mat3(1e-10 * Mat3::Identity())});
  chain.add(Hinge::Item{world_anchor(ankle.at_first, frame_along(ankle.first)), anchor_at(two, between, ankle.at_first, frame_along(ankle.first))});
  chain.add(Hinge::Item{anchor_at(two, between, ankle.at_last, frame_along(ankle.last)), anchor_at(two, other, ankle.at_last, frame_along(ankle.last))});
  const double energy = kinetic_energy(one) + potential_energy(one);
  for (int n = 0; n < 500; ++n) serial.step(1e-3), chain.step(1e-3);
  CHECK((one.position(foot) - two.position(other)).norm() < 1e-6);
  CHECK(one.orientation(foot).angularDistance(two.orientation(other)) < 1e-5);
  CHECK(one.orientation(foot).angularDistance(Quat::Identity()) > 0.5);
  CHECK(std::abs(kinetic_energy(one) + potential_energy(one) - energy) < 1e-8 * kinetic_energy(one));
}

TEST_CASE("a serial joint of two slides and a hinge moves in its plane and nowhere else") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{SerialJoint<2, 1>{}}, NewtonMidpoint{}};
  auto& set = bodies<RigidBodies>(loop.world());
  const auto torso = set.add({.position = {0, 0, 1}, .velocity = {1, 0, 2}, .angular_velocity = {0, 4, 0}, .mass = 3.0, .shape = Box{0.2, 0.1, 0.5}});
  const Quat frame = frame_along({0, 1, 0});
  loop.add(SerialJoint<2, 1>::Item{.a = world_anchor({0, 0, 1}, frame), .b = anchor_at(set, torso, {0, 0, 1}, frame), .slide = {0, 0, 1}});
  for (int n = 0; n < 100; ++n) {
    set.apply_force(torso, {0, 30, 0});  // out of the plane
    set.apply_torque(torso, {5, 0, 5});
    loop.step(1e-2);
  }
  CHECK(std::abs(set.position(torso).y()) < 1e-10);
  CHECK(set.position(torso).x() == Approx(1).margin(1e-9));
  CHECK(set.position(torso).z() == Approx(1 + 2 - 0.5 * 9.81).margin(1e-9));
  const Vec3 across = set.orientation(torso) * Vec3::UnitY();
  CHECK((across - Vec3::UnitY()).norm() < 1e-10);
}

TEST_CASE("limits and drives act on each of three hinges") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{SerialJoint<0, 3>{}, Limit<Nutation>{}, Drive<Precession>{}, Drive<Spin>{}}};
  auto& set = bodies<RigidBodies>(loop.world());
  const auto thigh = set.add({.position = {0, 0.3, 0}, .mass = 2.0, .shape = Box{0.1, 0.5, 0.1}});
  // b_z along y, a_z along z: a right angle at the start; gravity tips b_z down, away from a_z.
  const Anchor a = world_anchor({0, 0, 0}), b = anchor_at(set, thigh, {0, 0, 0}, frame_along({0, 1, 0}));
  loop.add(SerialJoint<0, 3>::Item{.a = a, .b = b});
  loop.add(Limit<Nutation>::Item{.a = a, .b = b, .lower = 1, .upper = 2, .position = M_PI / 2});
  const double psi = Precession::value({a, b, loop.world()}), phi = Spin::value({a, b, loop.world()});
  loop.add(Drive<Precession>::Item{.a = a, .b = b, .target = psi + 0.4, .stiffness = 200, .damping = 20, .position = psi});
  loop.add(Drive<Spin>::Item{.a = a, .b = b, .target = phi - 0.3, .stiffness = 50, .damping = 1, .position = phi});
  for (int n = 0; n < 1000; ++n) loop.step(5e-3);
  const JointFrames f(a, b, loop.world());
  CHECK(Nutation::value(f) == Approx(2).margin(1e-3));
  CHECK(std::abs(std::remainder(Precession::value(f) - psi - 0.4, 2 * M_PI)) < 1e-3);
  CHECK(std::abs(std::remainder(Spin::value(f) - phi + 0.3, 2 * M_PI)) < 1e-3);
}

TEST_CASE("a serial joint refuses axes that are none") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{SerialJoint<0, 2>{}, SerialJoint<1, 1>{}}};
  auto& set = bodies<RigidBodies>(loop.world());
  const auto body = set.add({.mass = 1.0, .shape = Box{1, 1, 1}});
  const Anchor a = world_anchor({0, 0, 0}), b = anchor(set, body);
  CHECK_THROWS_WITH(loop.add(SerialJoint<0, 2>::Item{.a = a, .b = b, .cosine = 1}), Catch::Contains("cosine") && Catch::Contains("parallel"));
  CHECK_THROWS_WITH(loop.add(SerialJoint<0, 2>::Item{.a = a, .b = b, .offset = NAN}), Catch::Contains("offset"));
  CHECK_THROWS_WITH(loop.add(SerialJoint<1, 1>::Item{.a = a, .b = b, .slide = {0, 0, 0}}), Catch::Contains("slide"));
}

}  // namespace serial_joint_tests
