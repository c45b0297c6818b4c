// expect: delassus: HapticChannel displays the force of a VirtualCoupling, and this loop has no constraints; add Constraints{VirtualCoupling{}, ...}
#include <delassus/delassus.hpp>
#include <delassus/haptics/haptic_channel.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, HapticChannel{}};
  loop.step(1e-3);
}
