// A hundred links of 1 kg hold a load of a ton at 60 steps a second: joints do not open, and energy is kept.
// prints: joints apart by at most [0-9.]+e-1[0-9] m, energy off by [0-9.]+e-1[0-9] of the load's
#include <delassus/delassus.hpp>
#include <delassus/steppers/newton_midpoint.hpp>

#include <algorithm>
#include <cstdio>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, NewtonMidpoint{}};
  auto& rigid = bodies<RigidBodies>(loop.world());

  const double length = 0.2, angle = 0.35;
  const Vec3 way(std::sin(angle), 0, -std::cos(angle));
  const Quat turned = frame_along(-way);
  Anchor end = world_anchor({0, 0, 0});
  for (int k = 0; k < 100; ++k) {
    const double mass = k == 99 ? 1000 : 1;
    const auto link = rigid.add({.position = (k + 0.5) * length * way,
                                 .orientation = turned,
                                 .mass = mass,
                                 .shape = Box{0.02, 0.02, length}});
    loop.add(BallJoint::Item{end, anchor(rigid, link, {0, 0, length / 2})});
    end = anchor(rigid, link, {0, 0, -length / 2});
  }

  const double start = potential_energy(rigid);
  double gap = 0, off = 0;
  for (int n = 0; n < 600; ++n) {
    gap = std::max(gap, loop.step(1.0 / 60).max_joint_violation);
    off = std::max(off, std::abs(kinetic_energy(rigid) + potential_energy(rigid) - start));
  }
  std::printf("joints apart by at most %.0e m, energy off by %.0e of the load's\n", gap,
              off / (1000 * 9.81 * 20));
}
