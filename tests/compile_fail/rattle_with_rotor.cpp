// expect: delassus: of the integrators that make a step at once NewtonMidpoint alone takes a RotorInertia; take it, or ImplicitMidpoint
#include <delassus/delassus.hpp>
#include <delassus/constraints/joints/rotor_inertia.hpp>
#include <delassus/steppers/rattle.hpp>

int main() {
  delassus::AnimationLoop loop{delassus::World{delassus::RigidBodies{}},
                               delassus::Constraints{delassus::Hinge{}, delassus::RotorInertia<delassus::Turn>{}}, delassus::Rattle{}};
  loop.step(1e-2);
}
