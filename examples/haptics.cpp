// A hand presses a tool 1 cm into a stiff wall through a simulated device: the loop runs at 30 Hz, the force at 1 kHz.
// prints: force 2\.3[0-9]* N, at rest to 0\.000 mm, energy given out 0\.000 J
#include <delassus/delassus.hpp>
#include <delassus/haptics/haptics.hpp>

#include <algorithm>
#include <cstdio>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.3}}, VirtualCoupling{}},
                     NativeCollision{.margin = 0.05}, HapticChannel{}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.gravity.setZero();
  rigid.add_fixed(HalfSpace{});
  const Vec3 start(0, 0, 0.03);
  const auto tool = rigid.add({.position = start, .mass = 0.05, .shape = Sphere{0.01}});
  const auto proxy = rigid.add({.position = start, .motion = Motion::kinematic});  // stands for the device
  auto& haptics = loop.channel<HapticChannel>();
  haptics.connect(loop.add(VirtualCoupling::Item{anchor(rigid, tool), anchor(rigid, proxy), 1000, 0.3}));  // N/m, N·s/m

  SimulatedDevice device{.position = start, .hand = start};
  PassivityObserver observer;
  HapticForce out;
  double before = 0;
  for (int ms = 0; ms < 3000; ++ms) {
    if (ms % 33 == 0) {  // with a real device: a thread of its own, see docs/theory/haptics.md
      rigid.move_to(proxy, device.position);
      loop.step(0.033);
    }
    device.hand_velocity = Vec3(0, 0, device.hand.z() > 1e-9 ? -0.1 : 0);
    before = device.position.z();
    out = haptics.tick(device.state());
    device.advance(out.force, 1e-3);
    observer.add(out.force, Vec3(0, 0, device.position.z() - before));
  }
  std::printf("force %.4f N, at rest to %.3f mm, energy given out %.3f J\n", out.force.z(),
              1e3 * std::abs(device.position.z() - before), std::max(0.0, -observer.energy()));
}
