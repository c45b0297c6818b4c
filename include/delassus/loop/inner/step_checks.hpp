/// Whether the parts of a loop agree on how a step is made: at once, in parts, or stage by stage.
#pragma once

#include <delassus/activity/all_active.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/constraints/joints/bilateral.hpp>
#include <delassus/constraints/law.hpp>
#include <delassus/loop/defaults.hpp>
#include <delassus/loop/held_policies.hpp>
#include <delassus/loop/order_of_overrides.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/schemes/plain_order.hpp>
#include <delassus/step/bias.hpp>
#include <delassus/step/channels.hpp>
#include <delassus/step/move_freely.hpp>
#include <delassus/step/plain_step.hpp>
#include <delassus/rows/theta.hpp>

#include <concepts>
#include <type_traits>

namespace delassus::inner {

/// A law whose rows are all equalities.
template <class Law>
consteval bool holds_exactly() {
  for (const RowKind kind : row_kinds<Law>())
    if (kind != RowKind::equality) return false;
  return true;
}

/// The order of the stages knows what a whole step is.
template <class Scheme>
inline constexpr bool takes_whole_steps = requires { requires Scheme::takes_whole_steps; };

/// What an integrator that makes its step at once says of a set of bodies.
template <class I, class Set>
concept SaysWhatItMoves = requires { { I::template can_move<Set> } -> std::convertible_to<bool>; };
template <class I, class Set>
concept MovesSet = SaysWhatItMoves<I, Set> && I::template can_move<Set>;

/// An integrator that solves for joints and bodies together leaves no room for parts between FreeMotion and Correct.
template <class Policies, class... Args>
consteval bool whole_step_fits() {
  using I = typename Policies::Integrator;
  if constexpr (!MovesAtOnce<I>) {
    constexpr bool says_move =
        !all_parts(std::type_identity<typename Policies::World>{}, []<class S>() { return !SaysWhatItMoves<I, S>; });
    static_assert(!says_move, "delassus: an integrator that says can_move makes its step at once, by `void move(auto& step) const`, "
                              "and this one has no such function; add it, or take can_move out");
    return !says_move;
  } else {
    constexpr bool are_equal =
        all_parts(std::type_identity<typename Policies::Laws>{}, []<class L>() { return holds_exactly<L>(); });
    constexpr bool says =
        all_parts(std::type_identity<typename Policies::World>{}, []<class S>() { return SaysWhatItMoves<I, S>; });
    static_assert(says, "delassus: an integrator with move(step) says which sets of bodies it moves; add `template <class Set> "
                        "static constexpr bool can_move = ...;`");
    constexpr bool can_move =
        all_parts(std::type_identity<typename Policies::World>{}, []<class S>() { return MovesSet<I, S>; });
    constexpr bool is_plain = takes_whole_steps<typename Policies::Scheme> &&
                              std::is_same_v<typename Policies::Activity, AllActive> && !(Publisher<Args> || ...);
    static_assert(are_equal,
                  "delassus: an integrator with move(step), such as NewtonMidpoint, takes no contacts, limits, "
                  "motors and drives; take their laws out, or use SymplecticEuler, ImplicitEuler, ImplicitMidpoint or LiePoisson");
    if constexpr (are_equal && says)
      static_assert(can_move,
                    "delassus: NewtonMidpoint moves rigid bodies only, Rattle and RungeKutta4 those and particles, GeneralizedAlpha, "
                    "Newmark and Bdf2 particles and soft bodies, FullNewton soft bodies and rods; take the other sets out of World{...}, or use ImplicitMidpoint");
    if constexpr (are_equal && can_move)
      static_assert(is_plain,
                    "delassus: an integrator with move(step), such as NewtonMidpoint, makes its step at once, "
                    "without W; take out the scheme, the activity and the listeners that publish the problem");
    return are_equal && can_move && is_plain;
  }
}

/// A step in parts has one detection: who sleeps or wakes between them would be missing in it.
template <class Scheme, class Activity>
consteval bool substeps_fit() {
  constexpr bool fit = !(requires { requires Scheme::divides_step; } && OverridesStages<Activity>);
  static_assert(fit, "delassus: Substeps and ErrorControlled make a step in parts; take the activity, Sleeping or HandPicked, out");
  return fit;
}

/// Joint by joint there is neither W nor a problem, and every body answers alone.
template <class Policies, class... Args>
consteval bool visits_fit() {
  if constexpr (makes_problem<typename Policies::Scheme> || Policies::Laws::pool_count == 0) {
    return true;
  } else {
    using I = typename Policies::Integrator;
    constexpr bool are_joints =
        all_parts(std::type_identity<typename Policies::Laws>{}, []<class L>() { return JointOfTwoEnds<L>; });
    static_assert(are_joints,
                  "delassus: JointByJoint takes joints with two ends that hold exactly or by springs (no contacts, "
                  "limits, motors, drives and couplings); take the other laws out of Constraints{...}, or use PlainOrder");
    constexpr bool answer_alone =
        EachBlockAlone<I> && requires { requires I::takes_masses_alone; } &&
        all_parts(std::type_identity<typename Policies::World>{}, []<class S>() { return StepsByBlock<S> && HasInverseInertia<S>; });
    if constexpr (are_joints)
      static_assert(answer_alone,
                    "delassus: JointByJoint moves rigid bodies and particles, by SymplecticEuler or LiePoisson; take "
                    "the other sets and the integrator out, or use PlainOrder");
    constexpr bool is_plain =
        count_of<role::Solver, Args...> == 0 && count_of<role::Compliance, Args...> == 0 &&
        std::is_same_v<typename Policies::Activity, AllActive> && !(Publisher<Args> || ...) &&
        !OverridesStages<typename Policies::Stabilisation>;
    if constexpr (are_joints && answer_alone)
      static_assert(is_plain,
                    "delassus: JointByJoint solves without W and without a solver; take out the solver, the compliance, "
                    "PositionProjection, the activity and the listeners that publish the problem, or use PlainOrder");
    return are_joints && answer_alone && is_plain;
  }
}

/// Springs that see the mean velocity need an integrator that goes with it, and gaps of each step.
template <class Policies>
consteval bool mean_springs_fit() {
  constexpr bool has_none =
      all_parts(std::type_identity<typename Policies::Laws>{}, []<class L>() { return !has_mean_springs<L>; });
  constexpr bool fit = has_none || (theta<typename Policies::Integrator>() != 1 &&
                                    !(requires { requires Policies::Scheme::divides_step; }));
  static_assert(fit, "delassus: Penalty with AtMean{} takes the mean velocity of a step, by which ImplicitMidpoint alone goes, "
                     "and gaps of each step, which Substeps has not; use ImplicitMidpoint and no Substeps, or leave AtMean{} out");
  return fit;
}

/// Solves that are repeated until W is near enough know nothing of what the impulses did before, or of bounces.
template <class Policies>
consteval bool refinement_fits() {
  constexpr bool is_refined = requires { requires Policies::Compliance::refines; };
  constexpr bool fit = !is_refined || Policies::Laws::pool_count == 0 ||
                       !(OverridesStages<typename Policies::Scheme> || names_override<NewtonImpact>(typename order_of_overrides<Policies>::type{}));
  static_assert(fit,
                "delassus: LazyCompliance and PrecomputedCompliance take no scheme that overrides stages, such as PredictiveScheme, and no law with "
                "restitution, such as Restitution, SequentialRestitution and Limit; use AssembledCompliance");
  return fit;
}

/// A law whose items bounce names what makes them bounce.
template <class Law>
consteval bool restitution_acts() {
  constexpr bool acts = !refines<Law>(refine::restitution) || names_override<NewtonImpact>(typename overrides_of<Law>::type{});
  static_assert(acts,
                "delassus: a law with restitution(item) names what makes it bounce; add `using overrides = "
                "Overrides<NewtonImpact>;` and include delassus/constraints/newton_impact.hpp");
  return acts;
}

}  // namespace delassus::inner
