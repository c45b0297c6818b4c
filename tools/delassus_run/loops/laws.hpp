/// The laws of machines, and which of them a type of loops has.
#pragma once

#include "shared_laws.hpp"  // before all else

#include "../motion.hpp"

namespace delassus_run {

/// Of contacts with what has no surface of its own.
inline double friction_of(const Asked& asked) { return asked.friction >= 0 ? asked.friction : usual_friction; }

/// Every law that a machine of a file may need.
inline auto every_law(const Asked& asked) {
  return Constraints{Contact{Coulomb{.friction = friction_of(asked)}}, Hinge{}, Slider{}, BallJoint{}, Weld{}, SerialJoint<0, 2>{}, SerialJoint<0, 3>{},
                     SerialJoint<1, 1>{}, SerialJoint<2, 0>{}, SerialJoint<2, 1>{}, SerialJoint<3, 0>{}, Limit<Turn>{}, Limit<Slide>{},
                     Limit<Precession>{}, Limit<Nutation>{}, Limit<Spin>{}, Limit<Length>{}, SpringDamper<Turn>{}, SpringDamper<Slide>{},
                     SpringDamper<Precession>{}, SpringDamper<Nutation>{}, SpringDamper<Spin>{}, SpringDamper<Length>{}, RotorInertia<Turn>{},
                     RotorInertia<Slide>{}, RotorInertia<Precession>{}, RotorInertia<Nutation>{}, RotorInertia<Spin>{}, Motor<Turn>{},
                     Motor<Slide>{}, Motor<Precession>{}, Motor<Nutation>{}, Motor<Spin>{}, Coupling<Turn, Turn>{}, Coupling<Slide, Turn>{},
                     Coupling<Turn, Slide>{}, Coupling<Slide, Slide>{}, Motor<Length>{}, Drive<Turn>{}, Drive<Slide>{},
                     Drive<Precession>{}, Drive<Nutation>{}, Drive<Spin>{}, Drive<Length>{}, Limit<RotationAngle>{}, Tendon<3>{}, TendonLimit<3>{},
                     TendonMotor<3>{}};
}
/// Those of links with one axis each, which most robots have.
inline auto laws_of_single_axes(const Asked& asked) {
  return Constraints{Contact{Coulomb{.friction = friction_of(asked)}}, Hinge{}, Slider{}, Limit<Turn>{}, Limit<Slide>{}, SpringDamper<Turn>{},
                     SpringDamper<Slide>{}, RotorInertia<Turn>{}, RotorInertia<Slide>{}, Motor<Turn>{}, Motor<Slide>{}, Drive<Turn>{}, Drive<Slide>{}};
}

}  // namespace delassus_run
