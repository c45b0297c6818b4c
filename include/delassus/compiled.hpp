/// For a program of many files: delassus.hpp, and what most loops share declared as compiled elsewhere.
///
/// A file that includes this one in the place of delassus.hpp leaves what follows to another, in which
/// `delassus/compile_here.hpp` compiles it; in CMake that one is `delassus::compiled`. What is left out is called once a
/// step, a pair or a body at the most: nothing that an inner loop inlines.
#pragma once

#include <delassus/delassus.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

#include <span>
#include <utility>
#include <vector>

namespace delassus {
namespace inner {

/// Stands where the parts are compiled, by the alignment of Eigen's arrays there. `undefined reference` to it at
/// linking: a file that uses the parts has other flags than theirs, `-march` above all, and its arrays lie otherwise.
template <int alignment>
struct CompiledWithAlignment {
  static const int bytes;
};
extern template struct CompiledWithAlignment<EIGEN_MAX_STATIC_ALIGN_BYTES>;
[[gnu::used]] static const int* const asks_for_alignment = &CompiledWithAlignment<EIGEN_MAX_STATIC_ALIGN_BYTES>::bytes;

}  // namespace inner

// One list, of which each entry is declared here and compiled by `compile_here.hpp`: what a loop calls once a step, a span of
// constraints, a pair or a body at the most.

#define DELASSUS_COMPILED_LAW(KIND, ...)              \
  KIND struct inner::LawRows<__VA_ARGS__, double>;    \
  KIND struct inner::LawLoops<__VA_ARGS__, double>;   \
  KIND struct inner::LawTangents<__VA_ARGS__, double>;

#define DELASSUS_COMPILED_LAWS(KIND)                                     \
  DELASSUS_COMPILED_LAW(KIND, Contact<Coulomb>)                          \
  DELASSUS_COMPILED_LAW(KIND, Contact<Frictionless>)                     \
  DELASSUS_COMPILED_LAW(KIND, Contact<Pyramid>)                          \
  DELASSUS_COMPILED_LAW(KIND, Contact<RollingCoulomb>)                   \
  DELASSUS_COMPILED_LAW(KIND, Contact<Restitution<Coulomb>>)             \
  DELASSUS_COMPILED_LAW(KIND, Contact<Penalty<Coulomb>>)                 \
  DELASSUS_COMPILED_LAW(KIND, Contact<SequentialRestitution<Coulomb>>)   \
  DELASSUS_COMPILED_LAW(KIND, BallJoint)                                 \
  DELASSUS_COMPILED_LAW(KIND, Cylindrical)                               \
  DELASSUS_COMPILED_LAW(KIND, DistanceJoint)                             \
  DELASSUS_COMPILED_LAW(KIND, Hinge)                                     \
  DELASSUS_COMPILED_LAW(KIND, Planar)                                    \
  DELASSUS_COMPILED_LAW(KIND, PointOnLine)                               \
  DELASSUS_COMPILED_LAW(KIND, Screw)                                     \
  DELASSUS_COMPILED_LAW(KIND, Slider)                                    \
  DELASSUS_COMPILED_LAW(KIND, Universal)                                 \
  DELASSUS_COMPILED_LAW(KIND, Weld)                                      \
  DELASSUS_COMPILED_LAW(KIND, VirtualCoupling)                           \
  DELASSUS_COMPILED_LAW(KIND, Gear)                                      \
  DELASSUS_COMPILED_LAW(KIND, Rack)                                      \
  DELASSUS_COMPILED_LAW(KIND, Limit<Turn>)                               \
  DELASSUS_COMPILED_LAW(KIND, Limit<Slide>)                              \
  DELASSUS_COMPILED_LAW(KIND, Motor<Turn>)                               \
  DELASSUS_COMPILED_LAW(KIND, Motor<Slide>)                              \
  DELASSUS_COMPILED_LAW(KIND, Drive<Turn>)                               \
  DELASSUS_COMPILED_LAW(KIND, Drive<Slide>)

#define DELASSUS_COMPILED_SOLVERS(KIND)                                                                                           \
  KIND SolveReport BasicAcceleratedGaussSeidel<Residual, ThenNewton>::solve(                                                      \
      Island<double>&, inner::SweepSpace<double, inner::NewtonSpace<double, 6>>&) const;                                          \
  KIND SolveReport BasicAcceleratedGaussSeidel<Residual, ThenNewton>::solve(                                                      \
      Island<double>&, inner::SweepSpace<double, inner::NewtonSpace<double, 3>>&) const;                                          \
  KIND SolveReport BasicAcceleratedGaussSeidel<Residual, SweepsAlone>::solve(                                                     \
      Island<double>&, inner::SweepSpace<double, SweepsAlone::Space<double, 6>>&) const;                                          \
  KIND SolveReport BasicDirectGaussSeidel<Residual>::solve(Island<double>&, inner::DirectSpace<Residual, double, 3, 6>&) const;                    \
  KIND SolveReport BasicDirectGaussSeidel<Residual>::solve(Island<double>&, inner::DirectSpace<Residual, double, 5, 6>&) const;                    \
  KIND SolveReport BasicDirectGaussSeidel<Residual>::solve(Island<double>&, inner::DirectSpace<Residual, double, 6, 6>&) const;                    \
  KIND class BlockLu<6, double>;

#define DELASSUS_COMPILED_BODIES(KIND)                                                                     \
  KIND struct inner::SetFunctions<RigidBodies, double>;                                                    \
  KIND struct inner::SetFunctions<Particles, double>;                                                      \
  KIND class WorldView<double>;                                                                            \
  KIND class RowEnd<double>;                                                                               \
  KIND bool inner::RigidState<double>::drift(Index, Velocity&, const Velocity&, double, double);           \
  KIND RigidBodies::Handle BasicRigidBodies<double>::add(const RigidBody&);                                \
  KIND Anchor anchor(const RigidBodies&, RigidBodies::Handle, const Vec3&, const Quat&);                   \
  KIND MidpointRate<double> midpoint_rate(const Mat3&, const Vec3&, const Vec3&, const Vec3&, double);

#define DELASSUS_COMPILED_COLLISION(KIND)                                                                                        \
  KIND CollisionReport NativeDetection<GjkEpa, BoxTree>::detect(std::span<const Collider>, double, std::vector<ContactPoint>&,   \
                                                                const NoFilter&);                                                \
  KIND void CollisionEngine<GjkEpa, BoxTree>::recall_pairs();                                                                    \
  KIND void CollisionEngine<GjkEpa, BoxTree>::collide(inner::Slice<const Collider>, const Job&, double, const CollisionSettings&,   \
                                                      RestingPair&, std::vector<ContactPoint>&);                                 \
  KIND Index route_contacts(Constraints<Contact<Coulomb>>&, const ContactCache&, const Materials&);

#define DELASSUS_COMPILED_PARTS(KIND) \
  DELASSUS_COMPILED_LAWS(KIND)        \
  DELASSUS_COMPILED_SOLVERS(KIND)     \
  DELASSUS_COMPILED_BODIES(KIND)      \
  DELASSUS_COMPILED_COLLISION(KIND)

DELASSUS_COMPILED_PARTS(extern template)

}  // namespace delassus
