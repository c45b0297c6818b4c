// The midpoint rule by Newton's method on mechanisms: a closed loop with a dependent row, and what all joints
// keep.
#include <delassus/stabilisation/position_projection.hpp>
#include <delassus/steppers/newton_midpoint.hpp>

#include "convergence_order.hpp"
#include "loop/chains.hpp"

#include "catch.hpp"

#include <array>
#include <vector>

namespace newton_midpoint_mechanisms_tests {

using namespace chains;

namespace {

/// AC-13: Bricard's loop of six hinges along edges of a cube, five rods of 1 kg between them; gravity along
/// −y.
struct Bricard {
  AnimationLoop<World<RigidBodies>, Constraints<Hinge>, NewtonMidpoint> loop{
      World{RigidBodies{}}, Constraints{Hinge{}}, NewtonMidpoint{}};
  RigidBodies::Handle third;
  Vec3 arm;

  /// `axial`: the moment of a rod about itself, kg m², of rods without thickness; 0 for boxes 0.1 m thick.
  explicit Bricard(double axial = 0) {
    auto& rigid = bodies<RigidBodies>(loop.world());
    rigid.gravity = {0, -9.81, 0};
    const std::array<Vec3, 6> p{Vec3(0, 0, 0),  Vec3(1, 0, 0),  Vec3(1, -1, 0),
                                Vec3(1, -1, 1), Vec3(0, -1, 1), Vec3(0, 0, 1)};
    std::array<RigidBodies::Handle, 5> rods;
    for (int k = 0; k < 5; ++k) {
      const Vec3 way = p[k + 1] - p[k];
      Vec3 size = Vec3::Constant(0.1);
      for (int c = 0; c < 3; ++c)
        if (std::abs(way[c]) > 0.5) size[c] = 1;
      RigidBody rod{
          .position = 0.5 * (p[k] + p[k + 1]), .mass = 1.0, .shape = Box{size[0], size[1], size[2]}};
      if (axial > 0) rod.inertia = Mat3(Mat3::Identity() / 12 + (axial - 1. / 12) * way * way.transpose());
      rods[k] = rigid.add(rod);
    }
    for (int k = 0; k < 6; ++k) {
      const Vec3 before = p[k] - p[(k + 5) % 6], after = p[(k + 1) % 6] - p[k];
      const Quat axis = frame_along(before.cross(after));
      const Anchor world = world_anchor(p[k], axis);
      loop.add(Hinge::Item{k == 0 ? world : anchor_at(rigid, rods[k - 1], p[k], axis),
                           k == 5 ? world : anchor_at(rigid, rods[k], p[k], axis)});
    }
    third = rods[2];
    arm = p[3] - rigid.position(third);
  }
  Vec3 corner() {
    const auto& rigid = bodies<RigidBodies>(loop.world());
    return rigid.position(third) + rigid.orientation(third) * arm;
  }
};

}  // namespace

// 30 rows of rank 29, in every pose. The reference has 1e-8; the error of second order at 2 s is found as
// such.
TEST_CASE("Bricard's loop follows its reference with second order, its dependent row and all") {
  const auto orders = convergence_orders(
      [](double h) {
        Bricard scene;
        for (int n = 0; n < std::lround(2 / h); ++n) REQUIRE(scene.loop.step(h).status <= Status::stalled);
        return (scene.corner() - Vec3(-0.969340345, -1.221246895, 0.754278011)).norm();
      },
      1.0 / 50);
  CAPTURE(orders[0], orders[1]);
  CHECK(are_of_order(orders, 2));
}

// The extrapolated corner, h² taken out by two runs, against every point of AC-13: its reference has 1e-8 in
// each coordinate. Half a period on, the loop is its mirror image.
TEST_CASE("Bricard's loop is where its reference says, up to its mirror image") {
  struct Point {
    double t;
    Vec3 at;
  };
  const auto corner = [](double t, int steps) {
    Bricard scene;
    for (int n = 0; n < steps; ++n) scene.loop.step(t / steps);
    return scene.corner();
  };
  for (const auto& [t, at] : {Point{0.5, {0.968283679, -1.224625159, 0.750146609}},
                              {1.0, {0.510501461, -1.649167599, 0.140123114}},
                              {2.0, {-0.969340345, -1.221246895, 0.754278011}},
                              {2.49585576, {-1, -1, 1}}}) {
    const Vec3 found = (4 * corner(t, 1000) - corner(t, 500)) / 3;
    CAPTURE(t, (found - at).norm());
    CHECK((found - at).norm() <= 2e-8);
  }
}

// HC-10 and HC-12 at once: a moment of 1e-9 about the rod itself must not have a true row taken for a
// dependent one, upon which the loop would fly apart. Where 1e-6 and 1e-9 are as good as none they move
// alike, to the share of 1e-6 in 1/12, 1.2e-5.
TEST_CASE("Bricard's loop of thin rods holds together and moves as that of less thin ones") {
  Bricard thin(1e-9), less(1e-6);
  const double start = energy(thin.loop);
  double gap = 0, change = 0;
  for (int n = 0; n < 1000; ++n) {
    const StepReport report = thin.loop.step(0.01);
    REQUIRE(report.status <= Status::stalled);
    gap = std::max(gap, report.max_joint_violation);
    change = std::max(change, std::abs(energy(thin.loop) - start));
    if (n >= 200) continue;
    less.loop.step(0.01);
    REQUIRE((thin.corner() - less.corner()).norm() <= 1.2e-5);
  }
  CAPTURE(gap, change);
  CHECK((thin.corner() - Vec3(1, -1, 1)).norm() > 1e-3);
  CHECK(gap <= 1e-9);
  CHECK(change <= 1e-5 * 50);
}

// Gold of AC-13: 1e-5 and 1e-9 m in 10 s. The loop's energy, 2 m of 9.81 N each on five rods, is 50 J.
TEST_CASE("Bricard's loop keeps its energy and its hinges for ten seconds") {
  Bricard scene;
  const double start = energy(scene.loop);
  double gap = 0, change = 0;
  for (int n = 0; n < 1000; ++n) {
    gap = std::max(gap, scene.loop.step(0.01).max_joint_violation);
    change = std::max(change, std::abs(energy(scene.loop) - start));
  }
  CHECK(gap <= 1e-9);
  CHECK(change <= 1e-5 * 50);
}

// HC-10. 196.2 N of weight lie on the hinges in equal shares; what else there is turns with the door by 0.02
// rad a step, and a swing of 1.5 times that is allowed. Shares that no body feels wander if nobody takes them
// out.
TEST_CASE("the hinges of a door share its weight alike, and their loads do not jump") {
  for (const int hinges : {1, 2, 3, 10}) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}}, NewtonMidpoint{}};
    auto& rigid = bodies<RigidBodies>(loop.world());
    const auto door = rigid.add({.position = {0.5, 0, 0}, .mass = 20.0, .shape = Box{1, 0.05, 2}});
    rigid.set_velocity(door, {0, 1, 0}, {0, 0, 2});
    std::vector<ConstraintHandle<Hinge>> all;
    for (int k = 0; k < hinges; ++k) {
      const Vec3 at(0, 0, hinges > 1 ? -0.9 + 1.8 * k / (hinges - 1) : 0);
      all.push_back(loop.add(Hinge::Item{world_anchor(at), anchor_at(rigid, door, at)}));
    }
    std::vector<Vec<5>> before(all.size());
    double jump = 0, largest = 0, lowest = 1e300, highest = 0;
    for (int n = 0; n < 300; ++n) {
      loop.step(0.01);
      for (std::size_t k = 0; k < all.size(); ++k) {
        const Vec<5> now = loop.impulse(all[k]) / 0.01;
        if (n > 0) jump = std::max(jump, (now - before[k]).norm());
        largest = std::max(largest, now.norm());
        lowest = std::min(lowest, std::abs(now[2]));
        highest = std::max(highest, std::abs(now[2]));
        before[k] = now;
      }
    }
    CAPTURE(hinges, jump, largest, lowest, highest);
    CHECK(jump <= 1.5 * 0.02 * largest);
    CHECK(lowest >= 0.999 * 196.2 / hinges);
    CHECK(highest <= 1.001 * 196.2 / hinges);
  }
}

namespace {

/// A body that spins on a joint of a kind to the world, without gravity: its energy after 5 s, less that at
/// the start.
template <class Joint>
void keeps_energy(const char* name) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Joint{}}, NewtonMidpoint{}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const auto body = rigid.add({.position = {0.3, 0.1, 0}, .mass = 2.0, .shape = Box{0.5, 0.3, 0.2}});
  const auto other = rigid.add({.position = {1, 0.1, 0}, .mass = 0.5, .shape = Box{0.2, 0.4, 0.3}});
  const Vec3 at(0.6, 0.1, 0);
  loop.add(typename Joint::Item{anchor_at(rigid, body, at), anchor_at(rigid, other, at)});
  rigid.gravity.setZero();
  rigid.set_velocity(body, {0.1, 0.2, 0}, {1, 2, 3});
  // The velocity of the same rigid motion at the other's centre.
  rigid.set_velocity(other, Vec3(0.1, 0.2, 0) + Vec3(1, 2, 3).cross(Vec3(0.7, 0, 0)), {1, 2, 3});
  const double start = kinetic_energy(rigid);
  const Vec3 p = momentum(rigid), l = angular_momentum(rigid);
  double gap = 0;
  for (int n = 0; n < 500; ++n) gap = std::max(gap, loop.step(0.01).max_joint_violation);
  CAPTURE(name, gap, start);
  // 500 solves to 1e-10 of 4 m/s each, in steps of 0.01 s.
  CHECK(gap <= 1e-9);
  CHECK(std::abs(kinetic_energy(rigid) / start - 1) <= 1e-8);
  CHECK((momentum(rigid) - p).norm() <= 1e-8 * p.norm());
  CHECK((angular_momentum(rigid) - l).norm() <= 1e-8 * l.norm());
}

}  // namespace

TEST_CASE("two free bodies on a joint keep energy, momentum and their joint") {
  keeps_energy<Weld>("weld");
  keeps_energy<Hinge>("hinge");
  keeps_energy<Slider>("slider");
  keeps_energy<Universal>("universal");
}

// Spun about the hinge in its centre nothing is to be solved, in no step: 59 rad/s for 0.1 s.
TEST_CASE("where the midpoint rule solves nothing projection has nothing to close") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}}, NewtonMidpoint{}, PositionProjection{}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.gravity.setZero();
  const auto body =
      set.add({.position = {0.1, 0, 0}, .angular_velocity = {0, 0, 59}, .mass = 1.0, .shape = Box{0.2, 0.2, 0.2}});
  loop.add(Hinge::Item{world_anchor({0.1, 0, 0}), anchor(set, body, {0, 0, 0})});
  for (int n = 0; n < 100; ++n) loop.step(1e-3);
  CHECK(set.position(body) == Vec3(0.1, 0, 0));
  const Quat turned = exponential<double>(Vec3(0, 0, 5.9));
  CHECK(set.orientation(body).angularDistance(turned) < 2e-3);  // (h ω)³/12 a step
}

}  // namespace newton_midpoint_mechanisms_tests
