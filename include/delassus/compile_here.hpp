/// Compiles what `delassus/compiled.hpp` leaves out: for one file of a program.
#pragma once

#include <delassus/compiled.hpp>

#include <span>
#include <utility>
#include <vector>

namespace delassus {

template <int alignment>
const int inner::CompiledWithAlignment<alignment>::bytes = alignment;
template struct inner::CompiledWithAlignment<EIGEN_MAX_STATIC_ALIGN_BYTES>;

template bool inner::RigidState<double>::drift(Index, Velocity&, const Velocity&, double, double);
template RigidBodies::Handle BasicRigidBodies<double>::add(const RigidBody&);
template Anchor anchor(const RigidBodies&, RigidBodies::Handle, const Vec3&, const Quat&);
template MidpointRate<double> midpoint_rate(const Mat3&, const Vec3&, const Vec3&, const Vec3&, double);

template CollisionReport NativeDetection<GjkEpa, BoxTree>::detect(
    std::span<const Collider>, double, std::vector<ContactPoint>&, const NoFilter&);
template void CollisionEngine<GjkEpa, BoxTree>::recall_pairs();
template void CollisionEngine<GjkEpa, BoxTree>::collide(std::span<const Collider>, const Job&, double,
                                                        const CollisionSettings&, RestingPair&,
                                                        std::vector<ContactPoint>&);
template Index route_contacts(Constraints<Contact<Coulomb>>&, const ContactCache&, const Materials&);

template SolveReport BasicAcceleratedGaussSeidel<Residual, ThenNewton>::solve(
    inner::ContactIsland&, Workspace<inner::ContactRowsOfBodies>&) const;
template void BlockLu<6, double>::analyse(Index, std::span<const std::pair<Index, Index>>);

}  // namespace delassus
