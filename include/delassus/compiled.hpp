/// For a program of many files: delassus.hpp, and what most loops share declared as compiled elsewhere.
///
/// A file that includes this one in the place of delassus.hpp leaves what follows to another, in which
/// `delassus/compile_here.hpp` compiles it; in CMake that one is `delassus::compiled`. What is left out is called once a
/// step, a pair or a body at the most: nothing that an inner loop inlines.
#pragma once

#include <delassus/delassus.hpp>

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

/// The islands of contacts with Coulomb's friction between rigid bodies.
using ContactRowsOfBodies = RowSystem<double, Widths<6>, 3>;
using ContactIsland = IslandProblem<LawSet<Constraints<Contact<Coulomb>>, double>, ContactRowsOfBodies,
                                    AssembledCompliance::Operator<ContactRowsOfBodies>>;

extern template bool RigidState<double>::drift(Index, Velocity&, const Velocity&, double, double);

}  // namespace inner

extern template RigidBodies::Handle BasicRigidBodies<double>::add(const RigidBody&);
extern template Anchor anchor(const RigidBodies&, RigidBodies::Handle, const Vec3&, const Quat&);
extern template MidpointRate<double> midpoint_rate(const Mat3&, const Vec3&, const Vec3&, const Vec3&, double);

extern template CollisionReport NativeDetection<GjkEpa, BoxTree>::detect(
    std::span<const Collider>, double, std::vector<ContactPoint>&, const NoFilter&);
extern template void CollisionEngine<GjkEpa, BoxTree>::recall_pairs();
extern template void CollisionEngine<GjkEpa, BoxTree>::collide(std::span<const Collider>, const Job&, double,
                                                               const CollisionSettings&, RestingPair&,
                                                               std::vector<ContactPoint>&);
extern template Index route_contacts(Constraints<Contact<Coulomb>>&, const ContactCache&, const Materials&);

extern template SolveReport BasicAcceleratedGaussSeidel<Residual, ThenNewton>::solve(
    inner::ContactIsland&, Workspace<inner::ContactRowsOfBodies>&) const;
extern template void BlockLu<6, double>::analyse(Index, std::span<const std::pair<Index, Index>>);

}  // namespace delassus
