// expect: delassus: JointByJoint takes no RotorInertia; take PlainOrder
#include <delassus/delassus.hpp>
#include <delassus/constraints/joints/rotor_inertia.hpp>
#include <delassus/schemes/joint_by_joint.hpp>

int main() {
  delassus::AnimationLoop loop{delassus::World{delassus::RigidBodies{}},
                               delassus::Constraints{delassus::Hinge{}, delassus::RotorInertia<delassus::Turn>{}}, delassus::JointByJoint{}};
  loop.step(1e-2);
}
