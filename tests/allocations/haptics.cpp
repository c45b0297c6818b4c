#include "allocations/count_allocations.hpp"

#include "allocations/allocation_scenes.hpp"

#include <delassus/haptics/haptic_channel.hpp>

namespace {

/// A tool that stirs a heap of balls in a box of walls, so that contacts come and go.
struct Stirring {
  AnimationLoop<World<RigidBodies>, Constraints<Contact<Coulomb>, VirtualCoupling>, NativeCollision, DoubleBuffer, HapticChannel>
      loop;
  RigidBodies::Handle proxy{};

  explicit Stirring(std::size_t reserve = 0)
      : loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.3}}, VirtualCoupling{}},
             NativeCollision{.margin = 0.02}, DoubleBuffer{.reserve = reserve},
             HapticChannel{.output{.cutoff = 200, .max_force = 10}, .reserve = reserve}} {
    auto& set = rigid_bodies(loop);
    set.add_fixed(HalfSpace{});
    for (int wall = 0; wall < 4; ++wall) {
      const double angle = 1.5707963267948966 * wall;
      const Vec3 inward{-std::cos(angle), -std::sin(angle), 0};
      set.add_fixed(HalfSpace{inward, -0.22});
    }
    for (int k = 0; k < 27; ++k)
      set.add({.position = {0.11 * (k % 3 - 1), 0.11 * (k / 3 % 3 - 1), 0.05 + 0.11 * (k / 9)}, .mass = 0.1, .shape = Sphere{0.05}});
    const auto tool = set.add({.position = place(0), .mass = 0.05, .shape = Sphere{0.03}});
    proxy = set.add({.position = place(0), .motion = Motion::kinematic});
    loop.template channel<HapticChannel>().connect(
        loop.add(VirtualCoupling::Item{.a = anchor(set, tool), .b = anchor(set, proxy), .damping = 1}));
  }
  static Vec3 place(double t) { return {0.12 * std::cos(3 * t), 0.12 * std::sin(3 * t), 0.45 - 0.35 * std::sin(0.5 * t)}; }
  void step(double t) {
    rigid_bodies(loop).move_to(proxy, place(t));
    loop.step(0.01);
  }
};

}  // namespace

TEST_CASE("a tick allocates nothing, from the first one on and whatever the snapshot holds") {
  Stirring scene;
  auto& haptics = scene.loop.channel<HapticChannel>();
  long in_ticks = 0;
  Index least = 1000, most = 0;
  for (int n = 0; n < 600; ++n) {
    scene.step(0.01 * n);
    least = std::min(least, scene.loop.report().contacts);
    most = std::max(most, scene.loop.report().contacts);
    const long before = allocations;
    Eigen::internal::set_is_malloc_allowed(false);
    for (int k = 0; k < 5; ++k)
      haptics.tick({.position = Stirring::place(0.01 * n + 0.001 * k), .velocity = {0.1, 0, 0}});
    Eigen::internal::set_is_malloc_allowed(true);
    in_ticks += allocations - before;
  }
  REQUIRE(in_ticks == 0);
  REQUIRE(most > least + 20);  // the problems do change their size
}

TEST_CASE("a warm step that publishes allocates nothing") {
  Stirring scene;
  auto& haptics = scene.loop.channel<HapticChannel>();
  auto& buffer = scene.loop.channel<DoubleBuffer>();
  long in_steps = 0;
  for (int n = 0; n < 900; ++n) {
    const long before = allocations;
    Eigen::internal::set_is_malloc_allowed(n < 600);
    scene.step(0);  // the tool stands still: after six seconds the heap has settled
    Eigen::internal::set_is_malloc_allowed(true);
    if (n >= 600) in_steps += allocations - before;
    if (n % 2 == 0) haptics.tick({.position = Stirring::place(0)});
    if (n % 3 == 0) buffer.fetch();
  }
  REQUIRE(in_steps == 0);
}

TEST_CASE("channels with room for the largest problem publish without an allocation from the first step on") {
  Stirring scene(4096);
  auto& haptics = scene.loop.channel<HapticChannel>();
  auto& buffer = scene.loop.channel<DoubleBuffer>();
  long in_publishing = 0;
  Index most = 0;
  for (int n = 0; n < 300; ++n) {
    scene.step(0.01 * n);
    most = std::max(most, scene.loop.report().contacts);
    const long before = allocations;
    Eigen::internal::set_is_malloc_allowed(false);
    buffer.publish(scene.loop);  // once more than the step did: the slots go round
    haptics.publish(scene.loop);
    haptics.tick({.position = Stirring::place(0.01 * n)});
    buffer.fetch();
    Eigen::internal::set_is_malloc_allowed(true);
    in_publishing += allocations - before;
  }
  REQUIRE(in_publishing == 0);
  REQUIRE(most > 50);
  REQUIRE(buffer.skipped() == 0);
  REQUIRE(haptics.skipped() == 0);
  REQUIRE(buffer.needed() > std::size_t(most));  // the blocks of W: a contact meets more than one other
  REQUIRE(buffer.needed() <= 4096);
}

TEST_CASE("problems without room are passed over and counted, and allocate nothing") {
  Stirring scene(100);
  auto& haptics = scene.loop.channel<HapticChannel>();
  auto& buffer = scene.loop.channel<DoubleBuffer>();
  long in_publishing = 0;
  for (int n = 1; n <= 100; ++n) {
    scene.step(0.01 * n);
    const long before = allocations;
    buffer.publish(scene.loop);
    haptics.publish(scene.loop);
    in_publishing += allocations - before;
    REQUIRE_FALSE(buffer.fetch());
    REQUIRE(haptics.tick({.position = Stirring::place(0.01 * n)}).force == Vec3::Zero());
  }
  REQUIRE(in_publishing == 0);
  REQUIRE(buffer.needed() > 100);
  REQUIRE(buffer.skipped() == 200);  // the step published too
  REQUIRE(haptics.skipped() == 200);
}
