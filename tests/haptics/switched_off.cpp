#include <delassus/delassus.hpp>
#include <delassus/haptics/haptic_channel.hpp>

#include "catch.hpp"

using namespace delassus;

TEST_CASE("a tool that is switched off keeps its last snapshot, and the force with it") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{VirtualCoupling{}}, HandPicked{}, HapticChannel{}};
  auto& set = bodies<RigidBodies>(loop.world());
  const auto tool = set.add({.mass = 0.05, .shape = Sphere{0.01}});
  const auto device = set.add({.motion = Motion::kinematic});
  auto& haptics = loop.channel<HapticChannel>();
  haptics.connect(loop.add(VirtualCoupling::Item{anchor(set, tool), anchor(set, device)}));
  loop.step(0.02);
  const Vec3 force = haptics.tick({.position = {0.01, 0, 0}}).force;
  REQUIRE(force.x() < -0.1);
  loop.switch_off(tool);
  for (int n = 0; n < 3; ++n) loop.step(0.02);
  REQUIRE(haptics.tick({.position = {0.01, 0, 0}}).force == force);
  loop.switch_on(tool);
  loop.step(0.02);
  REQUIRE(haptics.tick({.position = {0.01, 0, 0}}).sequence > 1);
}
