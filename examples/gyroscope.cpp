// A gyroscope: a wheel of 1 kg at 50 rad/s on a level arm of 0.2 m turns about the pivot and does not fall.
// prints: precesses at 0\.87[0-9] rad/s, sinks by 0\.00[0-9]+ m
#include <delassus/delassus.hpp>
#include <delassus/steppers/newton_midpoint.hpp>

#include <algorithm>
#include <cstdio>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, NewtonMidpoint{}};
  auto& rigid = bodies<RigidBodies>(loop.world());

  const double arm = 0.2, spin = 50, radius = 0.3;
  const double across = radius * radius / 4, along = radius * radius / 2;  // of 1 kg
  const double precession = 9.81 * arm / (along * spin);
  const auto wheel = rigid.add({.position = {arm, 0, 0},
                                .velocity = {0, precession * arm, 0},
                                .angular_velocity = {spin, 0, precession},
                                .mass = 1.0,
                                .inertia = Mat3(Vec3(along, across, across).asDiagonal())});
  loop.add(BallJoint::Item{anchor(rigid, wheel, {-arm, 0, 0}), world_anchor({0, 0, 0})});

  double turned = 0, sunk = 0;
  Vec3 last = rigid.position(wheel);
  for (int n = 0; n < 4000; ++n) {  // ten seconds
    loop.step(2.5e-3);
    const Vec3 now = rigid.position(wheel);
    turned += std::atan2(last.x() * now.y() - last.y() * now.x(), last.x() * now.x() + last.y() * now.y());
    sunk = std::max(sunk, -now.z());
    last = now;
  }
  std::printf("precesses at %.3f rad/s, sinks by %.5f m\n", turned / 10, sunk);
}
