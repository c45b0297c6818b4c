// A crane: a drive of at most 60 kN·m luffs the jib, from which a load of 1 t hangs below a hook of 1 kg.
// prints: load swings by 0\.1[0-9]* m, hinge carries 11\.[0-9] kN
#include <delassus/delassus.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

#include <algorithm>
#include <cstdio>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, Drive<Turn>{}, Limit<Turn>{}, DistanceJoint{}},
                     DirectGaussSeidel{.tolerance = 1e-8}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const auto jib = rigid.add({.position = {2, 0, 5}, .mass = 200.0, .shape = Box{4, 0.3, 0.3}});
  const auto hook = rigid.add({.position = {4, 0, 3}, .mass = 1.0, .shape = Sphere{0.1}});
  const auto load = rigid.add({.position = {4, 0, 2}, .mass = 1000.0, .shape = Box{0.8, 0.8, 0.8}});

  const Quat axis = frame_along({0, -1, 0});  // a positive turn lifts the jib
  const Anchor mast = world_anchor({0, 0, 5}, axis), foot = anchor_at(rigid, jib, {0, 0, 5}, axis);
  const auto hinge = loop.add(Hinge::Item{mast, foot});
  const auto luff = loop.add(
      Drive<Turn>::Item{.a = mast, .b = foot, .stiffness = 4e6, .damping = 4e5, .max_force = 60e3});
  loop.add(Limit<Turn>::Item{.a = mast, .b = foot, .lower = -0.2, .upper = 1.2});
  loop.add(DistanceJoint::Item{.a = anchor(rigid, jib, {2, 0, 0}), .b = anchor(rigid, hook), .length = 2});
  loop.add(DistanceJoint::Item{.a = anchor(rigid, hook), .b = anchor(rigid, load), .length = 1});

  double swing = 0;
  for (int n = 0; n < 5000; ++n) {  // ten seconds up to 0.8 rad, ten at rest
    loop.item(luff).target = 0.8 * std::min(n, 2500) / 2500;
    loop.item(luff).speed = n < 2500 ? 0.08 : 0;
    loop.step(4e-3);
    const Vec3 tip = rigid.position(jib) + rigid.orientation(jib) * Vec3(2, 0, 0);
    swing = std::max(swing, std::abs(rigid.position(load).x() - tip.x()));
  }
  std::printf("load swings by %.3f m, hinge carries %.1f kN\n", swing, reaction(loop, hinge).force.norm() / 1e3);
}
