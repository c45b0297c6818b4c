/// Names only: for headers of a host that mention a loop or a body set without needing it.
#pragma once

namespace delassus {

template <class T>
class BasicRigidBodies;
using RigidBodies = BasicRigidBodies<double>;
using RigidBodiesF = BasicRigidBodies<float>;

template <class T>
class BasicParticles;
using Particles = BasicParticles<double>;
using ParticlesF = BasicParticles<float>;

template <class... Sets>
class World;
template <class... Laws>
class Constraints;
template <class... Policies>
class AnimationLoop;

template <class Law>
struct Contact;
template <class Law>
struct Restitution;
struct Coulomb;
struct Pyramid;
struct RollingCoulomb;
struct Frictionless;
struct BallJoint;
struct Cylindrical;
struct DistanceJoint;
struct Hinge;
struct Planar;
struct PointOnLine;
struct Screw;
struct Slider;
struct Universal;
struct Weld;

struct SymplecticEuler;
struct ImplicitEuler;
struct ImplicitMidpoint;
struct LiePoisson;
struct MatrixFreeCompliance;
struct HandPicked;
struct Sleeping;
struct StepReport;

}  // namespace delassus
