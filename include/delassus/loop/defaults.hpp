/// One default per role: what a loop uses where its argument list is silent.
#pragma once

#include <delassus/activity/all_active.hpp>
#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/collision/native.hpp>
#include <delassus/collision/no_collision.hpp>
#include <delassus/compliance/assembled.hpp>
#include <delassus/compliance/unassembled.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/core/execution.hpp>
#include <delassus/integrators/symplectic_euler.hpp>
#include <delassus/loop/held_policies.hpp>
#include <delassus/loop/pick.hpp>
#include <delassus/schemes/plain_order.hpp>
#include <delassus/solvers/accelerated_gauss_seidel.hpp>
#include <delassus/stabilisation/baumgarte.hpp>
#include <delassus/step/channels.hpp>
#include <delassus/step/notify.hpp>

#include <tuple>
#include <type_traits>
#include <utility>

namespace delassus {
namespace inner {

/// Whether a scheme solves by rows and W: one that does not says `makes_problem = false`.
template <class Scheme>
inline constexpr bool makes_problem = !requires { requires !Scheme::makes_problem; };

/// The compliance of a loop that names none: that of its solver, if it says one as `using compliance`. Who hands problems
/// to other threads copies a matrix.
template <class Solver, bool publishes>
struct usual_compliance {
  using type = AssembledCompliance;
};
template <class Solver>
  requires requires { typename Solver::compliance; }
struct usual_compliance<Solver, false> {
  using type = typename Solver::compliance;
};

}  // namespace inner

/// The types of a loop by role: what is named, or the default.
template <class... Args>
struct Policies {
  template <class Role, class Default>
  using the = typename inner::pick<Role, Default, Args...>::type;

  using World = the<role::World, delassus::World<RigidBodies>>;
  using Laws = the<role::Constraints, Constraints<>>;
  using Integrator = the<role::Integrator, SymplecticEuler>;
  using Collision = the<role::Collision, std::conditional_t<Laws::has_contacts, NativeCollision, NoCollision>>;
  using Solver = the<role::Solver, AcceleratedGaussSeidel>;
  using Compliance = the<role::Compliance, typename inner::usual_compliance<Solver, (Publisher<Args> || ...)>::type>;
  using Stabilisation = the<role::Stabilisation, Baumgarte>;
  using Scheme = the<role::Scheme, PlainOrder>;
  using Activity = the<role::Activity, AllActive>;
  using Execution = the<role::Execution, Serial>;

  template <class Stage>
  static constexpr bool hears_stage = (inner::hears_stage<Args, Stage> || ...);
  static constexpr bool listens_inside_step = (inner::listens_inside_step<Args> || ...);
  static constexpr bool wants_open_contacts = (inner::wants_open_contacts<Args> || ...);
  static constexpr bool observes_sweeps = (inner::observes_sweeps<Args> || ...);
  using SweepObserver = typename inner::sweep_observer<Args...>::type;
};

namespace inner {

/// The type that plays `Role` in a Policies.
template <class P, class Role>
using policy_type = typename pick<Role, void, typename P::World, typename P::Laws, typename P::Integrator, typename P::Collision,
                                  typename P::Compliance, typename P::Solver, typename P::Stabilisation, typename P::Scheme,
                                  typename P::Activity, typename P::Execution>::type;

/// The tuple of the defaults a loop really uses: nothing for a role that is named or not needed.
template <class... Args>
struct DefaultsFor {
  using P = Policies<Args...>;
  template <class Role, bool is_needed = true>
  using one = std::conditional_t<is_needed && count_of<Role, Args...> == 0, std::tuple<policy_type<P, Role>>, std::tuple<>>;
  static constexpr bool constrained = P::Laws::pool_count > 0;
  static constexpr bool has_W = constrained && makes_problem<typename P::Scheme>;

  using type = decltype(std::tuple_cat(
      std::declval<one<role::World>>(), std::declval<one<role::Constraints>>(),
      std::declval<one<role::Integrator>>(),
      std::declval<one<role::Collision, P::Laws::has_contacts>>(),
      std::declval<one<role::Compliance, has_W>>(),
      std::declval<one<role::Solver, has_W>>(),
      std::declval<one<role::Stabilisation, constrained>>(),
      std::declval<one<role::Scheme>>(), std::declval<one<role::Activity>>()));
};

}  // namespace inner
}  // namespace delassus
