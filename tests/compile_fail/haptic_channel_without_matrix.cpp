// expect: delassus: HapticChannel solves in another thread and needs W as a matrix, which this compliance never forms; take AssembledCompliance
#include <delassus/delassus.hpp>
#include <delassus/haptics/haptic_channel.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{VirtualCoupling{}}, MatrixFreeCompliance{}, HapticChannel{}};
  loop.step(1e-3);
}
