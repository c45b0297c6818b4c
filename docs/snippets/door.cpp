// A door on a damped hinge, with a stop and a latch that breaks.
// prints: the latch breaks at 15\.0 N m, the door stops at 1\.500 rad
#include <delassus/delassus.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

using namespace delassus;

int main() {
  using Latch = Breakable<Universal>;  // of its moments it has the one about b_z alone where a and b agree
  constexpr double infinity = std::numeric_limits<double>::infinity();

  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, Latch{}, Drive<Turn>{}, Limit<Turn>{}}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const auto door = rigid.add({.position = {0.5, 0, 1}, .mass = 20, .shape = Box{1, 0.04, 2}});
  const Anchor post = world_anchor({0, 0, 1}), leaf = anchor_at(rigid, door, {0, 0, 1});
  const auto hinge = loop.add(Hinge::Item{post, leaf});
  loop.add(Drive<Turn>::Item{.a = post, .b = leaf, .stiffness = 0, .damping = 2});  // damps the turn, N·m·s/rad
  loop.add(Limit<Turn>::Item{.a = post, .b = leaf, .lower = -0.01, .upper = 1.5});  // a stop at 0 would share the latch's moment
  const auto latch = loop.add(Latch::Item{{post, leaf}, infinity, 15});  // no bound of its force, 15 N·m

  const double h = 1e-3;
  double torque = 0, broke_at = 0;
  for (int i = 0; i < 5000; ++i) {
    torque = std::min(30., 10 * (i + 1) * h);
    rigid.apply_torque(door, {0, 0, torque});
    loop.step(h);
    if (broke_at == 0 && !loop.broken<Latch>().empty() && loop.broken<Latch>()[0] == latch) broke_at = torque;
  }
  const Quat turned = rigid.orientation(door);
  std::printf("the latch breaks at %.1f N m, the door stops at %.3f rad, the hinge holds: %s\n", broke_at,
              2 * std::atan2(turned.z(), turned.w()), loop.contains(hinge) ? "yes" : "no");
}
