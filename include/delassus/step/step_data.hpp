/// What a step reads and writes: the policies, the arrays of the plain stages, and what a host or a listener may ask.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/constraints/contact/materials.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/defined_once.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/fixed_array.hpp>
#include <delassus/core/handle.hpp>
#include <delassus/rows/islands.hpp>
#include <delassus/rows/local.hpp>
#include <delassus/rows/row_arrays.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/rows/world_view.hpp>
#include <delassus/solvers/law_set.hpp>
#include <delassus/solvers/problem.hpp>
#include <delassus/solvers/solve_report.hpp>
#include <delassus/step/channels.hpp>
#include <delassus/step/contact_cache.hpp>
#include <delassus/step/law_rows.hpp>
#include <delassus/step/move_freely.hpp>
#include <delassus/step/step_report.hpp>

#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>

namespace delassus {

/// The arrays of a loop with constraints. `reset` keeps their capacity, so that a warm step allocates nothing.
template <class P>
struct RowData {
  using Rows = typename P::Rows;
  using Operator = typename P::Operator;

  Rows rows;
  ArraysOf<Rows> arrays;                                          ///< of `rows`
  PoolsOf<typename P::Laws, typename P::World::Scalar> pools;     ///< of the laws
  ViewOf<typename P::World> view;
  Islands<typename P::World::Scalar> islands;
  Operator W;
  LawSet<typename P::Laws, typename P::World::Scalar, inner::needs_of<typename P::Solver>> law_set;
  inner::DefinedOnce<typename P::Solver::template Workspace<Rows>> solver_workspace;
  Array<SolveReport> reports;  ///< of the islands, in their order
  Array<char> is_nonfinite;         ///< islands with a velocity that is not finite
  FixedArray<SetVersion, std::size_t(P::World::set_count)> versions;
  inner::DefinedOnce<ContactCache> contact_cache;
  inner::DefinedOnce<Materials> material_pairs;
};

/// A loop without constraints, or one whose parts do not fit together and which therefore never steps.
struct NoRowData {};

/// The plain stages write the members; what else a policy keeps is its `State`. P has the types of all policies of the loop,
/// see `Policies`. A scheme gets it as it is, a listener const.
template <class P>
struct StepData : std::conditional_t<P::has_rows, RowData<P>, NoRowData> {
  using Policies = P;
  using WorldType = typename P::World;
  using Laws = typename P::Laws;
  using Stages = typename P::Stages;
  using Scalar = typename WorldType::Scalar;
  static constexpr bool has_constraints = Laws::pool_count > 0;
  /// Rows and W of the last step are there to be asked for.
  static constexpr bool has_problem = P::has_problem;
  /// No constraint, nobody who listens between Begin and Step, and parts that treat each block by itself.
  static constexpr bool moves_freely = !has_constraints && EachBlockAlone<typename P::Integrator> && !P::listens_inside_step &&
                                       inner::steps_by_block<WorldType>;
  static constexpr bool observes_sweeps = P::observes_sweeps;
  /// A policy of the list, by type.
  template <class Policy>
  static constexpr bool has = P::Held::template has<Policy>;
  template <class Key>
  static constexpr bool has_state = P::States::template has<Key>;

  explicit StepData(typename P::Held given) : policies(static_cast<typename P::Held&&>(given)), channels(policies.given()) {}

  typename P::Held policies;
  [[no_unique_address]] typename P::States states;
  [[no_unique_address]] typename P::Channels channels;
  typename P::Scratch scratch;  ///< impulses, one array for each set of bodies
  StepReport summary;
  double h = 0, last_h = 0;  ///< this step and the one before, s
  double start = 0;          ///< the time when steps of h began, s
  long steps = 0;            ///< since then
  bool is_under_way = false;  ///< a step of the loop runs: nothing can be added

  [[gnu::always_inline]] WorldType& world() { return policy<role::World>(); }
  [[gnu::always_inline]] const WorldType& world() const { return policy<role::World>(); }
  [[gnu::always_inline]] Laws& laws() { return policy<role::Constraints>(); }
  [[gnu::always_inline]] const Laws& laws() const { return policy<role::Constraints>(); }
  /// The policy of a role, its default included.
  template <class Role>
  [[gnu::always_inline]] auto& policy() {
    return P::Held::template policy<Role, typename P::template of<Role>>(policies);
  }
  template <class Role>
  [[gnu::always_inline]] const auto& policy() const {
    return P::Held::template policy<Role, typename P::template of<Role>>(policies);
  }
  /// The policy of this type among the arguments; `has` asks whether there is one.
  template <class Policy>
  auto& get() {
    return P::Held::template get<Policy>(policies);
  }
  template <class Policy>
  const auto& get() const {
    return P::Held::template get<Policy>(policies);
  }
  [[gnu::always_inline]] auto& integrator() { return policy<role::Integrator>(); }
  [[gnu::always_inline]] auto& collision() { return policy<role::Collision>(); }
  [[gnu::always_inline]] auto& compliance() { return policy<role::Compliance>(); }
  [[gnu::always_inline]] auto& solver() { return policy<role::Solver>(); }
  [[gnu::always_inline]] auto& stabilisation() { return policy<role::Stabilisation>(); }
  [[gnu::always_inline]] auto& scheme() { return policy<role::Scheme>(); }
  [[gnu::always_inline]] auto& activity() { return policy<role::Activity>(); }
  /// Where one is named.
  [[gnu::always_inline]] auto& execution() { return policy<role::Execution>(); }
  /// The state of the policy of a role, or of a law's override: state<role::Activity>(), state<NewtonImpact>().
  template <class Key>
    requires has_state<Key>
  auto& state() {
    return states.template of<Key>();
  }
  template <class Key>
    requires has_state<Key>
  const auto& state() const {
    return states.template of<Key>();
  }
  /// Where a listener that publishes meets other threads. It stays where it is when the loop moves.
  template <class Listener>
  auto& channel() const
    requires(has<Listener> && Publisher<Listener>)
  {
    return channels.template of<Listener>();
  }

  const StepReport& report() const { return summary; }
  double time() const { return start + double(steps) * h; }
  /// h of the present step, or of the last one, s.
  double step_size() const { return h; }
  /// The contacts of the last step with their impulses, sorted by pair and feature.
  std::span<const ContactResult> contacts() const
    requires(Laws::has_contacts)
  {
    return this->contact_cache.results;
  }
  /// Solve reports of the islands of the last step.
  std::span<const SolveReport> island_reports() const
    requires(has_constraints)
  {
    return this->reports;
  }
  /// f(pool, item, λ, |F_i|, h) for every constraint of the last step, in the order of the sweep; see `Measure`.
  template <class F>
  void each_constraint(F&& f) const {
    if constexpr (has_problem) {
      auto book = this->law_set;
      book.attach(laws());  // the loop may be a copy
      auto& self = const_cast<StepData&>(*this);  // but for what W makes of λ nothing is written through it here
      self.W.reset(self.rows);
      book.show(self.W, self.rows);
      NoObserver nobody;
      Array<double> lengths;
      each_pool(this->rows, [&](auto p, const auto& pool) {
        lengths.assign(std::size_t(pool.items()), 1.0);
        for (Index k = 0; k < this->islands.count(); ++k) {
          const double length = IslandProblem(book, self.rows, self.W, this->islands, k, h, nobody).length();
          for (const Index i : this->islands.items(int(p), k)) lengths[std::size_t(i)] = length;
        }
        for (Index i = 0; i < pool.items(); ++i) f(int(p), i, pool.lambda[i], book.natural_error(p, i, lengths[std::size_t(i)]), h);
      });
    }
  }
  /// f(a, b) for every constraint with two anchors; `world().point(a)` says where one is now.
  template <class F>
  void each_joint(F&& f) const {
    using Visit = std::remove_reference_t<F>;
    const PairVisitor visitor{const_cast<std::remove_const_t<Visit>*>(&f), [](void* who, const Anchor& a, const Anchor& b) { (*static_cast<Visit*>(who))(a, b); }};
    const PoolsOf<Laws, Scalar> of_laws(laws());
    for (const LawPool<Scalar>& pool : of_laws.all())
      if (pool.law->each_pair) pool.law->each_pair(pool.pool, visitor);
  }
  /// f(impulse) for every constraint that is no contact, N·s of the last step.
  template <class F>
  void each_impulse(F&& f) const {
    each_kept_pool(laws(), [&](auto, const auto& pool) {
      for (const Index place : pool.slots.active()) f(pool.impulse[place]);
    });
  }

  /// The constraint problem of the last step, whole and apart from the loop: laws, rows, W, islands.
  template <class Self = StepData>
  auto problem() const {
    static_assert(Self::has_problem,
                  "delassus: this AnimationLoop makes no constraint problem: without constraints, under JointByJoint and by "
                  "NewtonMidpoint there is no W; use PlainOrder and ImplicitMidpoint, or take problem() out");
    if constexpr (Self::has_problem) {
      Problem<Laws, typename P::Rows, typename P::Operator> out{laws(), this->rows, this->W, this->islands, h};
      if constexpr (requires { out.W.complete(world(), out.rows); }) out.W.complete(world(), out.rows);
      return out;
    } else {
      return inner::Absent{};
    }
  }
  /// The same into one that is there: arrays that are large enough are written over, and nothing is allocated.
  template <class To>
  void copy_problem(To& to) const {
    to.laws = laws();
    to.rows = this->rows;
    to.W.copy_matrix(this->W);
    to.islands = this->islands;
    to.h = h;
  }
  /// f(part) for the parts of that problem that hold arrays, where they are.
  template <class F>
  void each_problem_part(F&& f) const {
    f(laws()), f(this->rows), f(this->W), f(this->islands);
  }

  /// The loop may have moved since its last step.
  void attach() {
    this->law_set.attach(laws());
    this->pools.attach(laws());
    this->view.attach(world());
    this->arrays.attach(this->rows);
  }

  // --- the clock ------------------------------------------------------------------------------------------------------

  /// A step of h seconds begins. Throws InvalidArgument where h is not finite and > 0.
  void begin_clock(double next_h) {
    DELASSUS_EXPECT(std::isfinite(next_h) && next_h > 0, "step: h = " + inner::text(next_h) + " s must be finite and > 0");
    if (next_h != h) {
      start = time();
      steps = 0;
    }
    last_h = h > 0 ? h : next_h;
    h = next_h;
    summary = {};
  }
  void end_clock() {
    if (summary.quarantined > 0) summary.status = worse(summary.status, Status::quarantined);
    ++steps;
    summary.time = time();
  }
};

}  // namespace delassus
