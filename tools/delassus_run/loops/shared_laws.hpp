/// What all types of loops share: declared here, and compiled once in shared_laws.cpp.
#pragma once

#include <delassus/compiled.hpp>

#include <delassus/constraints/joints/coupling.hpp>
#include <delassus/constraints/joints/euler_angles.hpp>
#include <delassus/constraints/joints/rotation_angle.hpp>
#include <delassus/constraints/joints/rotor_inertia.hpp>
#include <delassus/constraints/joints/serial_joint.hpp>
#include <delassus/constraints/joints/spring_damper.hpp>
#include <delassus/constraints/joints/tendon.hpp>

// Laws of machines that delassus/compiled.hpp does not have.
#define DELASSUS_RUN_LAWS(WHAT, KIND) \
  WHAT(KIND, SerialJoint<0, 2>)       \
  WHAT(KIND, SerialJoint<0, 3>)       \
  WHAT(KIND, SerialJoint<1, 1>)       \
  WHAT(KIND, SerialJoint<2, 0>)       \
  WHAT(KIND, SerialJoint<2, 1>)       \
  WHAT(KIND, SerialJoint<3, 0>)       \
  WHAT(KIND, Limit<Precession>)       \
  WHAT(KIND, Limit<Nutation>)         \
  WHAT(KIND, Limit<Spin>)             \
  WHAT(KIND, SpringDamper<Turn>)      \
  WHAT(KIND, SpringDamper<Slide>)     \
  WHAT(KIND, SpringDamper<Precession>) \
  WHAT(KIND, SpringDamper<Nutation>)  \
  WHAT(KIND, SpringDamper<Spin>)      \
  WHAT(KIND, SpringDamper<Length>)    \
  WHAT(KIND, RotorInertia<Turn>)      \
  WHAT(KIND, RotorInertia<Slide>)     \
  WHAT(KIND, RotorInertia<Precession>) \
  WHAT(KIND, RotorInertia<Nutation>)  \
  WHAT(KIND, RotorInertia<Spin>)      \
  WHAT(KIND, Motor<Precession>)       \
  WHAT(KIND, Motor<Nutation>)         \
  WHAT(KIND, Motor<Spin>)             \
  WHAT(KIND, Motor<Length>)           \
  WHAT(KIND, Drive<Precession>)       \
  WHAT(KIND, Drive<Nutation>)         \
  WHAT(KIND, Drive<Spin>)             \
  WHAT(KIND, Drive<Length>)           \
  WHAT(KIND, Limit<RotationAngle>)    \
  WHAT(KIND, Tendon<3>)               \
  WHAT(KIND, TendonLimit<3>)          \
  WHAT(KIND, TendonMotor<3>)          \
  WHAT(KIND, Coupling<Slide, Slide>)

namespace delassus {
DELASSUS_RUN_LAWS(DELASSUS_COMPILED_LAW, extern template)
DELASSUS_RUN_LAWS(DELASSUS_COMPILED_POOL, extern template)
DELASSUS_RUN_LAWS(DELASSUS_COMPILED_CHECK, template <> inline constexpr)
}  // namespace delassus
