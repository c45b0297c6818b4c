// expect: delassus: HapticChannel displays the force of a VirtualCoupling, and this loop has no such law; add VirtualCoupling{} to Constraints{...}
#include <delassus/delassus.hpp>
#include <delassus/haptics/haptic_channel.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, HapticChannel{}};
  loop.step(1e-3);
}
