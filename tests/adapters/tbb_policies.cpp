// Threads beside each policy that has stages, a workspace or listeners of its own: the bits of the loop
// without them.
#include <delassus/adapters/tbb.hpp>

#include <delassus/compliance/cheaper.hpp>
#include <delassus/compliance/lazy.hpp>
#include <delassus/compliance/precomputed.hpp>
#include <delassus/delassus.hpp>
#include <delassus/io/checkpoint.hpp>
#include <delassus/listeners/convergence_record.hpp>
#include <delassus/schemes/error_controlled.hpp>
#include <delassus/schemes/joint_by_joint.hpp>
#include <delassus/solvers/coloured.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>
#include <delassus/solvers/minimum_norm.hpp>
#include <delassus/solvers/proximal_newton.hpp>
#include <delassus/solvers/with_deadline.hpp>
#include <delassus/stabilisation/position_projection.hpp>
#include <delassus/steppers/newton_midpoint.hpp>

#include "catch.hpp"
#include "scenes.hpp"

namespace tbb_policies_tests {

using namespace delassus;
using namespace scenes;

namespace {

/// 24 pairs of boxes that fall and turn; with joints in each pair where the loop has them. Then a clone goes
/// on as the loop does.
template <class... Policies>
std::uint64_t hash_after_45_steps(Policies... policies) {
  AnimationLoop loop{World{RigidBodies{}}, std::move(policies)...};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  for (int i = 0; i < 24; ++i) {
    const auto a = set.add({.position = {2. * i, 0, 1},
                            .angular_velocity = {0, 0.1 * i, 0},
                            .mass = 1.,
                            .shape = Box{0.5, 0.5, 0.5}});
    const auto b = set.add({.position = {2. * i + 0.6, 0, 1}, .mass = 1., .shape = Box{0.5, 0.5, 0.5}});
    if constexpr (decltype(loop)::has_constraints)
      loop.add(BallJoint::Item{anchor(set, a, {0.3, 0, 0}), anchor(set, b, {-0.3, 0, 0})});
  }
  for (int k = 0; k < 40; ++k) loop.step(0.01);
  auto copy = loop.clone();
  for (int k = 0; k < 5; ++k) loop.step(0.01), copy.step(0.01);
  CHECK(state_hash(copy) == state_hash(loop));
  return state_hash(loop);
}
template <class... Policies>
void check_same_bits(const char* what, Policies... policies) {
  CAPTURE(what);
  const std::uint64_t alone = hash_after_45_steps(policies...);
  for (const int threads : {1, 2}) CHECK(hash_after_45_steps(policies..., Threads{threads}) == alone);
}

const Constraints contacts_and_joints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}};

}  // namespace

TEST_CASE("beside threads each scheme and integrator keeps its bits") {
  check_same_bits("no constraints");
  check_same_bits("joint by joint", Constraints{BallJoint{}}, JointByJoint{});
  check_same_bits("whole steps", Constraints{BallJoint{}}, NewtonMidpoint{});
  check_same_bits("kept error", contacts_and_joints, ErrorControlled{.accuracy = 1e-2},
                  AcceleratedGaussSeidel{.tolerance = 1e-6});
  check_same_bits("projection", contacts_and_joints, PositionProjection{});
  check_same_bits("impacts one by one",
                  Constraints{Contact{SequentialRestitution{Coulomb{.friction = 0.5}, 0.5}}, BallJoint{}});
}

TEST_CASE("beside threads each compliance keeps its bits") {
  check_same_bits("lazy", contacts_and_joints, LazyCompliance{});
  check_same_bits("precomputed", contacts_and_joints, PrecomputedCompliance{});
  check_same_bits("cheaper", contacts_and_joints, CheaperCompliance{});
}

TEST_CASE("beside threads each solver keeps its bits") {
  check_same_bits("deadline", contacts_and_joints, WithDeadline{AcceleratedGaussSeidel{}, 1e3});
  check_same_bits("deadline and colours", contacts_and_joints,
                  Coloured{WithDeadline{AcceleratedGaussSeidel{}, 1e3}});
  check_same_bits("least impulses", contacts_and_joints, MinimumNorm{AcceleratedGaussSeidel{}});
  check_same_bits("direct", contacts_and_joints, DirectGaussSeidel{});
  check_same_bits("Newton", contacts_and_joints, ProximalNewton{});
  check_same_bits("heard sweeps", contacts_and_joints, ConvergenceRecord{});
}

}  // namespace tbb_policies_tests
