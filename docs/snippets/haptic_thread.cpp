// A device thread at 1 kHz beside a loop at 30 Hz: the tool of a simulated device is pressed into a wall.
// prints: force [0-9.]+ N from snapshot [1-9]
#include <delassus/delassus.hpp>
#include <delassus/adapters/posix.hpp>
#include <delassus/haptics/haptics.hpp>
#include <delassus/listeners/real_time_pace.hpp>
#include <delassus/listeners/spinning_clock.hpp>

#include <atomic>
#include <cstdio>
#include <thread>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.3}}, VirtualCoupling{}},
                     NativeCollision{.margin = 0.05}, HapticChannel{.output = {.max_force = 10}}, RealTimePace{}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.gravity.setZero();
  rigid.add_fixed(HalfSpace{});
  const Vec3 start(0, 0, 0.02);
  const auto tool = rigid.add({.position = start, .mass = 0.05, .shape = Sphere{0.01}});
  const auto proxy = rigid.add({.position = start, .motion = Motion::kinematic});
  auto& haptics = loop.channel<HapticChannel>();
  haptics.connect(loop.add(VirtualCoupling::Item{anchor(rigid, tool), anchor(rigid, proxy), 1000, 0.3}));

  lock_memory();  // false where the system refuses; the program runs all the same
  std::atomic<bool> is_over{false};
  HapticForce last;
  std::thread hand([&] {
    set_realtime_priority(80);
    const SpinningClock clock;
    SimulatedDevice device{.position = start, .hand = {0, 0, -0.005}};  // in place of your device
    for (double t = clock.now(); !is_over; clock.sleep_until(t += 1e-3)) {
      last = haptics.tick(device.state());
      device.advance(last.force, 1e-3);
    }
  });
  const double h = 1. / 30;
  for (int i = 0; i < 30; ++i) {
    const DeviceState& device = haptics.device();  // the newest that a tick was given
    rigid.move_to(proxy, device.position, device.orientation);
    loop.step(h);
  }
  is_over = true;
  hand.join();
  std::printf("force %.1f N from snapshot %d\n", last.force.z(), int(last.sequence));
}
