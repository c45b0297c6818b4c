/// Names only: for a header of a host that names a loop, keeps it behind a pointer or hands it on, and reads nothing of Eigen.
#pragma once

namespace delassus {

// Bodies and the loop.
template <class T>
class BasicRigidBodies;
using RigidBodies = BasicRigidBodies<double>;
using RigidBodiesF = BasicRigidBodies<float>;
template <class T>
class BasicParticles;
using Particles = BasicParticles<double>;
using ParticlesF = BasicParticles<float>;
template <class Set, class Tag>
struct Tagged;

template <class... Sets>
class World;
template <class... Laws>
class Constraints;
template <class... Policies>
class AnimationLoop;
struct StepReport;

template <class Set>
struct Handle;
template <class Law>
struct ConstraintHandle;

// Laws.
template <class Law>
struct Contact;
template <class Law, class Pairs>
struct ContactFor;
template <class Law>
struct Restitution;
template <class Law>
struct SequentialRestitution;
struct Coulomb;
struct Pyramid;
struct RollingCoulomb;
struct Frictionless;

struct Turn;
struct Slide;
struct Length;
template <class Coordinate>
struct Limit;
template <class Coordinate>
struct Motor;
template <class Coordinate>
struct Drive;
struct BallJoint;
struct Cylindrical;
struct DistanceJoint;
struct Hinge;
struct Planar;
struct PointOnLine;
struct Screw;
struct Slider;
struct Universal;
struct VirtualCoupling;
struct Weld;

// Policies.
struct SymplecticEuler;
struct ImplicitEuler;
struct ImplicitMidpoint;
struct LiePoisson;

struct GaussSeidel;
struct SweepsAlone;
struct ThenNewton;
template <class Newton>
struct BasicAcceleratedGaussSeidel;
using AcceleratedSweeps = BasicAcceleratedGaussSeidel<SweepsAlone>;
using AcceleratedGaussSeidel = BasicAcceleratedGaussSeidel<ThenNewton>;
struct DirectGaussSeidel;

struct MatrixFreeCompliance;
struct CheaperCompliance;
struct UnassembledCompliance;
struct Baumgarte;
struct PositionProjection;
struct SoftContact;
struct PlainOrder;
struct AllActive;
struct HandPicked;
struct Sleeping;

}  // namespace delassus
