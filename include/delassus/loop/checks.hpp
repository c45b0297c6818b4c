/// One mistake in a loop's argument list, one sentence.
#pragma once

#include <delassus/activity/all_active.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/collision/collider.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/constraints/law_checks.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/integrators/integrator.hpp>
#include <delassus/loop/held_policies.hpp>
#include <delassus/loop/inner/step_checks.hpp>
#include <delassus/loop/order_of_overrides.hpp>
#include <delassus/loop/pick.hpp>
#include <delassus/rows/body_set.hpp>
#include <delassus/rows/writer.hpp>
#include <delassus/schemes/plain_order.hpp>
#include <delassus/solvers/island_problem.hpp>
#include <delassus/solvers/law_set.hpp>
#include <delassus/solvers/solve_report.hpp>
#include <delassus/stabilisation/stabilisation.hpp>
#include <delassus/step/channels.hpp>
#include <delassus/step/notify.hpp>
#include <delassus/step/row_types.hpp>
#include <delassus/step/stage.hpp>

#include <concepts>
#include <span>
#include <type_traits>
#include <vector>

namespace delassus {

namespace inner {

/// What belongs into one of the policies of a loop, and is no policy itself.
template <class P>
concept LawOfConstraints = ConstraintLaw<P> || LawOfContact<P> || HollowLaw<P> || requires { typename P::no_contact_law; };

template <class P>
consteval bool has_role() {
  constexpr bool has = requires { typename P::plays; };
  constexpr bool is_law = LawOfConstraints<P>, is_set = !is_law && BodySet<P>, is_number = std::is_arithmetic_v<P>;
  static_assert(has || !is_law,
                "delassus: a constraint law is no argument of AnimationLoop by itself; put it into Constraints{...}, as in "
                "Constraints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}}");
  static_assert(has || !is_set,
                "delassus: a set of bodies is no argument of AnimationLoop by itself; put it into World{...}, as in "
                "World{RigidBodies{}}");
  static_assert(has || !is_number,
                "delassus: a plain number is no argument of AnimationLoop; write it into the policy it is meant for, as in "
                "GaussSeidel{.tolerance = 1e-6}, or give it to step(h) if it is the step");
  static_assert(has || is_law || is_set || is_number,
                "delassus: every argument of AnimationLoop is a policy that says its role; add `using plays = "
                "role::...;` to this type, or take it out of the list");
  return has;
}

/// A policy of its role, and filled if it is a wrapper.
template <class P>
consteval bool plays_its_role() {
  constexpr bool is_filled = !IsHollow<P>, is_collision = Plays<P, role::Collision>, is_solver = Plays<P, role::Solver>;
  static_assert(is_filled || !is_collision,
                "delassus: the layers of a collision go around a backend and each other in this order, each at most once: "
                "WithFilter{WithSurfaces{WithCompounds{WithMeshes{Seamless{NativeCollision{}}}}}}; take out what "
                "is not wanted, and write numbers second, as in Seamless{NativeCollision{}, 1e-3}");
  static_assert(is_filled || !is_solver,
                "delassus: WithDeadline and MinimumNorm go around a solver, each at most once, and numbers come second: "
                "WithDeadline{MinimumNorm{AcceleratedGaussSeidel{}}, 1e-3}");
  static_assert(is_filled || is_collision || is_solver,
                "delassus: WithCompliance goes around a stabilisation, once, and its number comes second: "
                "WithCompliance{Baumgarte{}, 1e-7}");
  constexpr bool integrates = !is_filled || !Plays<P, role::Integrator> || Integrator<P>;
  static_assert(integrates,
                "delassus: this type plays role::Integrator but lacks scale(h), impulse(set, p, h) or "
                "advance(set, h); see integrators/integrator.hpp for their types");
  constexpr bool stabilises = !is_filled || !Plays<P, role::Stabilisation> || Stabilisation<P>;
  static_assert(stabilises,
                "delassus: this type plays role::Stabilisation but lacks equality(phi, h) or penetration(phi, h), "
                "which return double");
  constexpr bool listens = !Plays<P, role::Listener> || requires { typename P::listens; };
  static_assert(listens,
                "delassus: this type plays role::Listener but does not say what it hears; add `using listens = "
                "Listens<stage::Solve>;`");
  constexpr bool executes = !Plays<P, role::Execution> || Execution<P>;
  static_assert(executes,
                "delassus: this type plays role::Execution but lacks workers() or run(tasks, f), both const; see "
                "core/execution.hpp");
  return is_filled && integrates && stabilises && listens && executes;
}

template <class Role, class... Args>
consteval bool at_most_one() {
  constexpr int count = count_of<Role, Args...>;
  static_assert(count <= 1,
                "delassus: an AnimationLoop takes at most one policy of each role (listeners aside); take one out");
  return count <= 1;
}

template <class... Args>
consteval bool one_observes_sweeps() {
  constexpr bool is_one = (0 + ... + int(observes_sweeps<Args>)) <= 1;
  static_assert(is_one, "delassus: of the listeners with `every_sweep` a solver tells one, as ConvergenceRecord is; take the others out");
  return is_one;
}

template <class... Args>
consteval bool one_of_each() {
  return one_observes_sweeps<Args...>() && at_most_one<role::Integrator, Args...>() && at_most_one<role::Constraints, Args...>() &&
         at_most_one<role::Collision, Args...>() && at_most_one<role::Compliance, Args...>() &&
         at_most_one<role::Solver, Args...>() && at_most_one<role::Stabilisation, Args...>() &&
         at_most_one<role::Scheme, Args...>() && at_most_one<role::Activity, Args...>() && at_most_one<role::Execution, Args...>();
}

template <class... Args>
consteval bool has_one_world() {
  constexpr bool has = count_of<role::World, Args...> == 1;
  static_assert(has, "delassus: an AnimationLoop needs exactly one World{...}; name the body sets of the scene in it");
  return has;
}

template <class World>
consteval bool has_bodies() {
  constexpr bool has = World::set_count > 0;
  static_assert(has, "delassus: a World needs at least one set of bodies; write World{RigidBodies{}}");
  constexpr bool has_no_other =
      all_parts(std::type_identity<World>{}, []<class S>() { return requires { typename S::Scalar; S::width; }; });
  static_assert(has_no_other,
                "delassus: World{...} takes sets of bodies, as in World{RigidBodies{}, Particles{}}; take the rest out");
  return has && has_no_other;
}

template <class World>
consteval bool has_one_scalar() {
  constexpr bool is_one = all_parts(std::type_identity<World>{}, []<class S>() {
    return std::is_same_v<typename S::Scalar, typename World::Scalar>;
  });
  static_assert(is_one,
                "delassus: all body sets of a World have one scalar; use RigidBodies with Particles, or RigidBodiesF "
                "with ParticlesF");
  return is_one;
}

template <class Laws, class Collision>
consteval bool collision_fits() {
  constexpr bool is_backend = CollisionBackend<Collision>;
  static_assert(is_backend || !Laws::has_contacts,
                "delassus: this type plays role::Collision but lacks detect(std::span<const Collider>, double, "
                "std::vector<ContactPoint>&), which returns a CollisionReport");
  static_assert(!is_backend || Laws::has_contacts,
                "delassus: a collision backend without a contact law does nothing; add Contact{...} to "
                "Constraints{...}, or take the backend out");
  return is_backend == Laws::has_contacts;
}

/// A law of the library that `compiled.hpp` has: it was checked where it was compiled.
template <class Law, class T>
inline constexpr bool was_checked = false;

/// linearize is asked with the very types it will be called with; its return type is written out, so no body is compiled.
template <class Law, class T>
consteval bool law_linearizes() {
  constexpr bool does = requires(const Law& law, const typename Law::Item& item, const WorldView<T>& world, RowWriter<T> row) {
    { law.linearize(item, world, row) } -> std::same_as<void>;
  };
  static_assert(does,
                "delassus: a constraint law needs linearize(const Item&, const auto& world, auto row) const; add it, and "
                "write its return type, void");
  return does;
}

template <class Law, class T>
concept LawFits = was_checked<Law, T> || (law_is_sound<Law, WorldView<T>>() && law_linearizes<Law, T>());

template <class T, class... Laws>
consteval bool laws_fit(std::type_identity<Constraints<Laws...>>) {
  return (LawFits<Laws, T> && ...);
}

template <class Compliance, class World, class Rows>
concept BuildsW = requires(typename Compliance::template Operator<Rows>& W, const World& world, Rows& rows) {
  { W.build(world, rows) } -> std::same_as<void>;
  { W.reset(rows) } -> std::same_as<void>;
};

template <class Compliance, class World, class Rows>
consteval bool compliance_is_sound() {
  constexpr bool has_operator = requires { typename Compliance::template Operator<Rows>; };
  static_assert(has_operator,
                "delassus: this type plays role::Compliance but lacks `template <class Rows> class Operator`; see "
                "compliance/compliance.hpp for what it must do");
  constexpr bool builds = BuildsW<Compliance, World, Rows>;
  static_assert(builds || !has_operator,
                "delassus: the Operator of a compliance needs void build(const World&, Rows&) and void reset(const "
                "Rows&); see compliance/compliance.hpp");
  return builds;
}

template <class Solver, class Laws, class Rows, class Operator>
consteval bool solver_is_sound() {
  using Problem = IslandProblem<LawSet<Laws, typename Rows::Scalar>, Rows, Operator, NoObserver>;
  constexpr bool solves = requires(const Solver& solver, Problem& problem,
                                   typename Solver::template Workspace<Rows>& workspace) {
    { solver.solve(problem, workspace) } -> std::same_as<SolveReport>;
  };
  static_assert(solves,
                "delassus: this type plays role::Solver but lacks `template <class Rows> struct Workspace` or "
                "solve(problem, workspace), which returns a SolveReport; add it");
  return solves;
}

/// The parts that meet in the rows: only a loop with constraints has them.
template <class P>
concept MeetsInRows = laws_fit<typename P::World::Scalar>(std::type_identity<typename P::Laws>{}) &&
    compliance_is_sound<typename P::Compliance, typename P::World, typename rows_of<typename P::World, typename P::Laws>::type>() &&
    solver_is_sound<typename P::Solver, typename P::Laws, typename rows_of<typename P::World, typename P::Laws>::type,
                    typename P::Compliance::template Operator<typename rows_of<typename P::World, typename P::Laws>::type>>();

template <class Scheme, class Loop>
consteval bool scheme_runs() {
  constexpr bool runs = requires(const Scheme& scheme, Loop& loop) {
    { scheme.run(loop) } -> std::same_as<void>;
  };
  static_assert(runs,
                "delassus: this type plays role::Scheme but lacks run(step), which calls the stages of a step in its "
                "order and returns void; add it");
  return runs;
}

/// A publisher is asked whether it can, and says what it lacks.
template <class Policies, class P>
concept CanPublish = !Publisher<P> || P::template can_publish<typename problem_of<Policies>::type>();

template <class... Laws>
consteval bool restitutions_act(std::type_identity<Constraints<Laws...>>) {
  return (restitution_acts<Laws>() && ...);
}

/// The first check that fails says its sentence, and the later ones are not asked.
template <class P, class... Args>
concept SoundLoop = (has_role<Args>() && ...) && has_one_world<Args...>() && one_of_each<Args...>() && (plays_its_role<Args>() && ...) &&
    has_bodies<typename P::World>() && has_one_scalar<typename P::World>() && (P::Laws::pool_count == 0 || MeetsInRows<P>) &&
    whole_step_fits<P, Args...>() && visits_fit<P, Args...>() && mean_springs_fit<P>() && refinement_fits<P>() &&
    restitutions_act(std::type_identity<typename P::Laws>{}) && substeps_fit<typename P::Scheme, typename P::Activity>() &&
    (CanPublish<P, Args> && ...) && collision_fits<typename P::Laws, typename P::Collision>();

}  // namespace inner
}  // namespace delassus
