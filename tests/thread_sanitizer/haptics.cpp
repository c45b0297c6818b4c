// A loop and a device's thread, built with -fsanitize=thread, which tells of a data race. A program of its own: it says what
// it counted and returns 1 when something went wrong.
#include <delassus/delassus.hpp>
#include <delassus/haptics/haptics.hpp>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <thread>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.3}}, VirtualCoupling{}},
                     NativeCollision{.margin = 0.02}, DoubleBuffer{}, HapticChannel{.budget = 1e-3}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  for (int k = 0; k < 4; ++k) rigid.add({.position = {0.1 * k, 0, 0.05}, .mass = 0.5, .shape = Box{0.1, 0.1, 0.1}});
  const Vec3 start(0.15, 0, 0.12);
  const auto tool = rigid.add({.position = start, .mass = 0.05, .shape = Sphere{0.01}});
  const auto proxy = rigid.add({.position = start, .motion = Motion::kinematic});
  const auto coupling = loop.add(VirtualCoupling::Item{.a = anchor(rigid, tool), .b = anchor(rigid, proxy)});
  auto& haptics = loop.channel<HapticChannel>();
  auto& buffer = loop.channel<DoubleBuffer>();
  haptics.connect(coupling);

  constexpr int steps = 600;
  std::atomic<bool> is_over{false};
  long ticks = 0, strange = 0, backward = 0, fresh = 0;
  std::uint64_t last = 0;
  std::thread device_thread([&] {
    SimulatedDevice device{.position = start, .hand = start};
    while (!is_over.load() || last < steps) {
      device.hand.z() = 0.1 + 0.02 * std::cos(0.01 * double(ticks));
      const HapticForce f = haptics.tick(device.state());
      device.advance(f.force, 1e-3);
      strange += !is_finite(f.force) || f.force.norm() > 1e3;
      backward += f.sequence < last;
      last = f.sequence;
      if (buffer.fetch()) {
        ++fresh;
        strange += buffer.front().problem.rows.row_count() < 6;
        for (auto& lambda : buffer.front().problem.rows.pool<1>().lambda) lambda.setZero();
      }
      ++ticks;
      std::this_thread::yield();
    }
  });
  for (int n = 0; n < steps; ++n) {
    rigid.move_to(proxy, n == 0 ? start : haptics.device().position);
    loop.step(5e-3);
    if (n % 4 == 0) std::this_thread::yield();
  }
  is_over = true;
  device_thread.join();
  std::printf("%d steps, %ld ticks, %ld snapshots read; strange %ld, backward %ld\n", steps, ticks, fresh, strange, backward);
  return strange + backward == 0 && fresh > 10 && last == steps ? 0 : 1;
}
