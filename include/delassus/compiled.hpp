/// For a program of many files: delassus.hpp, and what most loops share declared as compiled elsewhere.
///
/// A file that includes this one in the place of delassus.hpp leaves what follows to another, in which
/// `delassus/compile_here.hpp` compiles it; in CMake that one is `delassus::compiled`. What is left out is called once a
/// step, a pair or a body at the most: nothing that an inner loop inlines.
#pragma once

#define DELASSUS_COMPILED
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

}  // namespace inner

// One list, of which each entry is declared here and compiled by `compile_here.hpp`: what a loop calls once a step, a span of
// constraints, a pair or a body at the most.

#define DELASSUS_COMPILED_CONTACTS(WHAT, KIND)        \
  WHAT(KIND, Contact<Coulomb>)                        \
  WHAT(KIND, Contact<Frictionless>)                   \
  WHAT(KIND, Contact<Pyramid>)                        \
  WHAT(KIND, Contact<RollingCoulomb>)                 \
  WHAT(KIND, Contact<Restitution<Coulomb>>)           \
  WHAT(KIND, Contact<Penalty<Coulomb>>)               \
  WHAT(KIND, Contact<SequentialRestitution<Coulomb>>)

#define DELASSUS_COMPILED_JOINTS(WHAT, KIND) \
  WHAT(KIND, BallJoint)                      \
  WHAT(KIND, Cylindrical)                    \
  WHAT(KIND, DistanceJoint)                  \
  WHAT(KIND, Hinge)                          \
  WHAT(KIND, Planar)                         \
  WHAT(KIND, PointOnLine)                    \
  WHAT(KIND, Screw)                          \
  WHAT(KIND, Slider)                         \
  WHAT(KIND, Universal)                      \
  WHAT(KIND, Weld)                           \
  WHAT(KIND, VirtualCoupling)                \
  WHAT(KIND, Gear)                           \
  WHAT(KIND, Rack)                           \
  WHAT(KIND, Limit<Turn>)                    \
  WHAT(KIND, Limit<Slide>)                   \
  WHAT(KIND, Limit<Length>)                  \
  WHAT(KIND, Motor<Turn>)                    \
  WHAT(KIND, Motor<Slide>)                   \
  WHAT(KIND, Drive<Turn>)                    \
  WHAT(KIND, Drive<Slide>)

#define DELASSUS_COMPILED_LAW(KIND, ...)                                                                                              \
  KIND const LawSteps<double>* inner::law_steps<__VA_ARGS__, double>();                                                               \
  KIND const LawTable<double>* inner::law_table<__VA_ARGS__, double>();                                                               \
  KIND void inner::law_tangent<__VA_ARGS__, double>(const PoolView<double>&, Index, const double*, const double*, double*, double*);  \
  KIND void inner::convex_law_tangent<__VA_ARGS__, double>(const PoolView<double>&, Index, const double*, const double*, double, double*, double*);

#define DELASSUS_COMPILED_POOL(KIND, ...) KIND ConstraintHandle<__VA_ARGS__> inner::add_item(Pool<__VA_ARGS__>&, const __VA_ARGS__::Item&);

// What `compile_here.hpp` has checked is not checked in each file again.
#define DELASSUS_COMPILED_CHECK(KIND, ...) KIND bool inner::was_checked<__VA_ARGS__, double> = true;

#define DELASSUS_COMPILED_LAWS(KIND)                      \
  DELASSUS_COMPILED_CONTACTS(DELASSUS_COMPILED_LAW, KIND) \
  DELASSUS_COMPILED_JOINTS(DELASSUS_COMPILED_LAW, KIND)   \
  DELASSUS_COMPILED_JOINTS(DELASSUS_COMPILED_POOL, KIND)

// Of laws with R rows, and body sets of one width.
#define DELASSUS_COMPILED_HEIGHT(KIND, R)                                                                       \
  KIND void inner::AssembledRows<double>::build_pool<R, false>(inner::AssembledRows<double>&, int, const CrowdedRow*); \
  KIND void inner::AssembledRows<double>::build_pool<R, true>(inner::AssembledRows<double>&, int, const CrowdedRow*); \
  KIND struct inner::BlockLoops<R, 3, double>;                                                                  \
  KIND struct inner::BlockLoops<R, 6, double>;                                                                  \
  KIND void inner::apply_inverse<false>(const RigidBodies&, SetBlocks<R, 6, double>&, inner::Range);                         \
  KIND void inner::apply_inverse<false>(const Particles&, SetBlocks<R, 3, double>&, inner::Range);                            \
  KIND void inner::set_own_blocks<R>(const RowView<double>&, inner::Range, double*, double*);                            \
  KIND struct inner::SetOwnBlocks<R, double>;                                                                          \
  KIND void inner::add_impulses_to_bodies<R>(const RowView<double>&);

#define DELASSUS_COMPILED_ROWS(KIND)                                                                                              \
  DELASSUS_COMPILED_HEIGHT(KIND, 1)                                                                                               \
  DELASSUS_COMPILED_HEIGHT(KIND, 2)                                                                                               \
  DELASSUS_COMPILED_HEIGHT(KIND, 3)                                                                                               \
  DELASSUS_COMPILED_HEIGHT(KIND, 4)                                                                                               \
  DELASSUS_COMPILED_HEIGHT(KIND, 5)                                                                                               \
  DELASSUS_COMPILED_HEIGHT(KIND, 6)                                                                                               \
  KIND class Islands<double>;                                                                                                     \
  KIND class WorldView<double>;                                                                                                   \
  KIND class RowEnd<double>;                                                                                                      \
  KIND struct RowArrays<double>;                                                                                                  \
  KIND class inner::AssembledRows<double>;                                                                                        \
  KIND class inner::BlockMatrix<double>;                                                                                          \
  KIND class inner::Incidence<double>;                                                                                            \
  KIND void follow(const WorldView<double>&, AllLaws<double>);                                                                    \
  KIND void linearize(const WorldView<double>&, AllLaws<double>, AllRows<double>);                                                \
  KIND double worst_equality(AllLaws<double>, AllRows<double>);                                                                   \
  KIND Index row_count(AllRows<double>);                                                                                          \
  KIND void add_restitution(const WorldView<double>&, AllLaws<double>, AllRows<double>, const Islands<double>&, const double* const*, const double* const*, const std::size_t*, int, double, double, Bounces<double>&); \
  KIND struct Bounces<double>;                                                                                                    \
  KIND void remember_impulses(AllRows<double>, Bounces<double>&);                                                                 \
  KIND class EnergyGuard<double>;                                                                                                 \
  KIND class inner::CoupledColumns<double>;                                                                                       \
  KIND class inner::NodalRows<double>;                                                                                            \
  KIND class Array<double>;                                                                                                       \
  KIND class Array<Index>;                                                                                                        \
  KIND class Array<char>;                                                                                                         \
  KIND class OwningArray<Array<double>>;                                                                                          \
  KIND class OwningArray<Array<Index>>;                                                                                           \
  KIND void inner::AssembledRows<double>::prepare(const RigidBodies&, int);                                                       \
  KIND void inner::AssembledRows<double>::prepare(const Particles&, int);                                                         \
  KIND void inner::make_bias(const LawPool<double>&, const RowArrays<double>&, inner::Range, const double* const*, const double* const*, const MovingSurfaces<double>&, const Baumgarte&, double, double, bool); \
  KIND void warm_start(AllLaws<double>, AllRows<double>, ContactCache&, double, double);                                          \
  KIND void keep_impulses(AllLaws<double>, AllRows<double>, ContactCache&);                                                       \
  KIND void forget_lost_islands(AllLaws<double>, inner::Slice<const PoolView<double>>, ContactCache&, const Islands<double>&, inner::Slice<const SolveReport>);

#define DELASSUS_COMPILED_SOLVERS(KIND)                                                                                           \
  KIND SolveReport AcceleratedGaussSeidel::solve(Island<double>&, inner::SweepSpace<double, inner::NewtonSpace<double, 6>>&) const; \
  KIND SolveReport AcceleratedGaussSeidel::solve(Island<double>&, inner::SweepSpace<double, inner::NewtonSpace<double, 3>>&) const; \
  KIND SolveReport AcceleratedSweeps::solve(Island<double>&, inner::SweepSpace<double, SweepsAlone::Space<double, 6>>&) const; \
  KIND double inner::length_of_island(const Span<double>*, const Span<double>*);                                                  \
  KIND Index inner::undecided_loads(const Island<double>&, const SolveReport&);                                                   \
  KIND class inner::NewtonSystem<double, 6>;                                                                                      \
  KIND class BlockLu<6, double>;                                                                                                  \
  KIND class OwningArray<inner::IslandGraph<BlockLu<6, double>>>;                                                                 \
  KIND class Island<double>;                                                                                                      \
  KIND struct inner::SweepSpace<double, inner::NewtonSpace<double, 6>>;                                                           \
  KIND struct inner::NewtonSpace<double, 6>;                                                                                     \
  KIND struct inner::DefinedOnce<inner::SweepSpace<double, inner::NewtonSpace<double, 6>>>;                                      \
  KIND struct inner::DefinedOnce<inner::SweepSpace<double, inner::NewtonSpace<double, 3>>>;                                      \
  KIND struct inner::DefinedOnce<inner::SweepSpace<double, SweepsAlone::Space<double, 6>>>;

// Declared at the end of solvers/direct_gauss_seidel.hpp, whose reading costs something, for who includes it behind this header.
#define DELASSUS_COMPILED_DIRECT(KIND, R)                                                                                       \
  KIND SolveReport DirectGaussSeidel::solve(Island<double>&, inner::DirectSpace<double, R, 6>&) const; \
  KIND class inner::SchurComplement<double, inner::DirectSystem<R, 6>>;                                                         \
  KIND struct inner::DirectSpace<double, R, 6>;                                                                      \
  KIND struct inner::DefinedOnce<inner::DirectSpace<double, R, 6>>;                                                    \
  KIND class OwningArray<inner::IslandGraph<SparseLu<R, double>>>;

#define DELASSUS_COMPILED_BODIES(KIND, ...)                                                                                       \
  KIND struct inner::SetFunctions<__VA_ARGS__, double>;                                                                           \
  KIND void inner::correct_set(__VA_ARGS__&, const __VA_ARGS__&, int, Index, AllRows<double>, Array<__VA_ARGS__::Velocity>&, const Islands<double>&, Array<char>&); \
  KIND void inner::void_set(__VA_ARGS__&, Index, const Islands<double>&, const Array<char>&);                                     \
  KIND void free_motion(__VA_ARGS__&, __VA_ARGS__&, const SymplecticEuler&, Array<__VA_ARGS__::Velocity>&, double);               \
  KIND void ContactCache::add(const __VA_ARGS__&, Index, Index, bool);

#define DELASSUS_COMPILED_WORLD(KIND)                                                                  \
  KIND void inner::refuse_number(std::string_view, double, const char*, const char*);                  \
  KIND std::string inner::shown_type(std::string_view);                                                \
  KIND std::string inner::stale_constraint(std::uint32_t, const std::string&);                         \
  KIND void inner::refuse_during_step(const std::string&);                                             \
  KIND void inner::refuse_still_ends(const std::string&, const std::string&);                          \
  KIND void inner::refuse_one_body(const std::string&, const std::string&);                            \
  KIND void inner::refuse_no_body(const std::string&);                                                 \
  KIND class BasicRigidBodies<double>;                                                                 \
  KIND class BasicParticles<double>;                                                                   \
  KIND struct inner::RigidState<double>;                                                               \
  KIND class inner::BodyStorage<RigidBodies, double, 6>;                                               \
  KIND class inner::BodyStorage<Particles, double, 3>;                                                 \
  KIND class inner::BasicShapes<ConvexHull>;                                                           \
  KIND class BasicConvexHull<double>;                                                                  \
  DELASSUS_COMPILED_BODIES(KIND, RigidBodies)                                                          \
  DELASSUS_COMPILED_BODIES(KIND, Particles)                                                            \
  KIND class inner::Overlaps<inner::Solid>;                                                            \
  KIND Anchor anchor(const RigidBodies&, RigidBodies::Handle, const Vec3&, const Quat&);               \
  KIND Anchor anchor(const Particles&, Particles::Handle, const Vec3&, const Quat&);                   \
  KIND MidpointRate<double> midpoint_rate(const Mat3&, const Vec3&, const Vec3&, const Vec3&, double);

#define DELASSUS_COMPILED_COLLISION(KIND)                                                                                         \
  KIND class BasicContactCache<double>;                                                                                           \
  KIND struct inner::DefinedOnce<ContactCache>;                                                                                   \
  KIND struct inner::DefinedOnce<Materials>;                                                                                      \
  KIND class BasicContactMemory<double>;                                                                                          \
  KIND class BasicFrictionPlaces<double>;                                                                                         \
  KIND struct NativeDetection<GjkEpa, BoxTree>;                                                                                   \
  KIND class inner::OnDemand<CollisionEngine<GjkEpa, BoxTree>>;                                                                     \
  KIND CollisionReport NativeDetection<GjkEpa, BoxTree>::detect(std::span<const Collider>, double, std::vector<ContactPoint>&, const NoFilter&); \
  KIND CollisionReport NativeDetection<GjkEpa, BoxTree>::detect(std::span<const Collider>, double, std::vector<ContactPoint>&, const ContactCache::Pushed&); \
  KIND void NativeDetection<GjkEpa, BoxTree>::detect_missed(std::span<const Collider>, double, std::vector<ContactPoint>&, const ContactCache::Pushed&); \
  KIND Index route_contacts(Constraints<Contact<Coulomb>>&, const ContactCache&, const Materials&);

// What a file that makes scenes does with vectors: each would cost it some twenty functions of Eigen's.
#define DELASSUS_COMPILED_VECTORS(KIND)                                                                     \
  KIND delassus::Vec3& Eigen::Matrix<double, 3, 1>::operator=(const delassus::Vec3&);                       \
  KIND delassus::Vec<6>& Eigen::Matrix<double, 6, 1>::operator=(const delassus::Vec<6>&);                   \
  KIND delassus::Vec<4>& Eigen::Matrix<double, 4, 1>::operator=(const delassus::Vec<4>&);                   \
  KIND delassus::Mat3& Eigen::Matrix<double, 3, 3>::operator=(const delassus::Mat3&);                       \
  KIND Eigen::Matrix<double, 3, 1>::Matrix(const double&, const double&, const double&);                    \
  KIND delassus::Vec3 Eigen::QuaternionBase<delassus::Quat>::_transformVector(const delassus::Vec3&) const; \
  KIND delassus::Quat Eigen::QuaternionBase<delassus::Quat>::normalized() const;                            \
  KIND delassus::Mat3 Eigen::QuaternionBase<delassus::Quat>::toRotationMatrix() const;                      \
  KIND double Eigen::MatrixBase<delassus::Vec3>::norm() const;                                              \
  KIND double Eigen::MatrixBase<delassus::Vec3>::squaredNorm() const;                                       \
  KIND const delassus::Vec3 Eigen::MatrixBase<delassus::Vec3>::normalized() const;                          \
  KIND class std::vector<delassus::ContactPoint>;

#define DELASSUS_COMPILED_PARTS(KIND) \
  DELASSUS_COMPILED_LAWS(KIND)        \
  DELASSUS_COMPILED_ROWS(KIND)        \
  DELASSUS_COMPILED_SOLVERS(KIND)     \
  DELASSUS_COMPILED_WORLD(KIND)       \
  DELASSUS_COMPILED_COLLISION(KIND)

DELASSUS_COMPILED_PARTS(extern template)
DELASSUS_COMPILED_CONTACTS(DELASSUS_COMPILED_CHECK, template <> inline constexpr)
DELASSUS_COMPILED_JOINTS(DELASSUS_COMPILED_CHECK, template <> inline constexpr)

}  // namespace delassus

DELASSUS_COMPILED_VECTORS(extern template)
