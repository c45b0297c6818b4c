/// Joints in turn: the cheapest step there is for scenes of joints.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/schemes/inner/joint_visits.hpp>
#include <delassus/schemes/plain_order.hpp>
#include <delassus/step/plain_step.hpp>

#include <type_traits>

namespace delassus {

/// Each joint is linearised, solved and answered by its bodies in one visit, as sequential impulses do it. There is no W, no
/// island and no list of rows. Where no two joints hold one moving body (pendulums, doors, a wheel on its axle) the visit is
/// exact, the motion that of `PlainOrder` to rounding. A ball joint then costs less than the loop one writes by hand.
///
/// Joints that share a body are visited `sweeps` times from the impulses of the last step, and what is left is measured. Above
/// the tolerance the status is `max_iterations`, as it is of chains and loops, whose solver is `DirectGaussSeidel`.
///
/// For rigid bodies and particles, SymplecticEuler or LiePoisson, and joints with two ends that hold exactly or by springs.
/// Listeners hear FreeMotion, Solve, Correct and Advance; `island_reports` has one report of all.
struct JointByJoint {
  using plays = role::Scheme;
  static constexpr bool makes_problem = false;  ///< read by the loop: there are no rows, no islands and no W
  template <class P>
    requires(P::Laws::pool_count > 0)
  using State = JointVisits<typename P::World, typename P::Laws>;
  int sweeps = 1;           ///< visits of each joint where joints share bodies
  double tolerance = 1e-6;  ///< of the residual

  void check() const {
    inner::expect_at_least_one("JointByJoint: sweeps", sweeps);
    inner::expect_at_least_zero("JointByJoint: tolerance", tolerance);
  }
  /// One function of all that a joint and a body of a step take: calls between them would weigh in so short a step.
  [[gnu::flatten]] void run(auto& step) const {
    if constexpr (std::remove_reference_t<decltype(step)>::has_constraints) {
      each_pool(step.laws(), [](auto, const auto& pool) {
        constexpr bool is_rotor = requires { requires std::remove_cvref_t<decltype(pool.law)>::resists; };
        static_assert(!is_rotor, "delassus: JointByJoint takes no RotorInertia; take PlainOrder");
      });
      visit_joints(step);
      stage::advance(step);
    } else {
      PlainOrder{}.run(step);
    }
  }
};

}  // namespace delassus
