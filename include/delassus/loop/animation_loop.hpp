/// The loop: the policies of a scene, and the stages of a step over them.
#pragma once

#include <delassus/fwd.hpp>
#include <delassus/loop/channels.hpp>
#include <delassus/loop/checks.hpp>
#include <delassus/loop/defaults.hpp>
#include <delassus/loop/edit.hpp>
#include <delassus/loop/listening.hpp>
#include <delassus/loop/problem.hpp>
#include <delassus/loop/stages/detect.hpp>
#include <delassus/loop/stages/move_freely.hpp>
#include <delassus/loop/step_report.hpp>
#include <delassus/loop/workspace.hpp>

#include <array>
#include <cmath>
#include <span>
#include <tuple>
#include <utility>

namespace delassus {

/// `AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}}, ...}`: policies in any order, at most one of
/// each role, defaults where none is named. What is not named is not compiled.
template <class... Policies>
class AnimationLoop {
  using Parts = inner::Parts<Policies...>;

 public:
  using WorldType = typename Parts::World;
  using Laws = typename Parts::Laws;
  using Scalar = typename WorldType::Scalar;
  static constexpr bool has_constraints = Laws::pool_count > 0;
  static constexpr bool may_rest = has_constraints && has_dormant<typename Parts::Activity>;
  /// The integrator solves for joints and bodies together: there is no W, and no problem to hand out.
  static constexpr bool solves_whole_step = delassus::solves_whole_step<typename Parts::Integrator, has_constraints>;
  /// The scheme solves joint by joint, without W.
  static constexpr bool visits_joints = has_constraints && inner::visits_joints<typename Parts::Scheme>;
  /// Rows and W of the last step are there to be asked for.
  static constexpr bool has_problem = has_constraints && !solves_whole_step && !visits_joints;
  static constexpr bool divides_step = requires { requires Parts::Scheme::divides_step; };
  /// A policy of the list, by type.
  template <class P>
  static constexpr bool has = (std::is_same_v<P, Policies> || ...);

  explicit AnimationLoop(Policies... policies);

  /// Moves the scene by h seconds. Throws InvalidArgument when h is not finite and > 0, a number of a policy was made
  /// invalid, or a body's material was never added; never for what happens inside.
  StepReport step(double h);

  WorldType& world() { return part<role::World>(); }
  const WorldType& world() const { return part<role::World>(); }

  /// Adds a constraint: `loop.add(BallJoint::Item{...})`. Its law must be in Constraints{...}.
  template <class Item>
  auto add(Item item);
  template <class Law>
  void remove(ConstraintHandle<Law> constraint) {
    laws().template of<Law>().remove(constraint);
    forget_rows();
  }
  /// Takes a body out, with every constraint that holds it. `problem` and `each_constraint` are empty until the next step.
  template <class Set>
  void remove(Handle<Set> body) {
    inner::remove_body(world(), laws(), body);
    forget_rows();
  }

  /// The handle of the constraint in a place of its law: places count from 0 in the order of adding, a removed one's is given again.
  /// After `restore` the handles are this loop's own. Throws InvalidArgument for an empty place.
  template <class Law>
  ConstraintHandle<Law> constraint(Index place) const {
    return laws().template of<Law>().handle(place);
  }

  /// What a constraint was added with: its numbers may be changed at any time, its anchors may not.
  template <class Law>
  auto& item(ConstraintHandle<Law> constraint) {
    auto& pool = laws().template of<Law>();
    DELASSUS_EXPECT(pool.contains(constraint), "item: " + pool.stale(constraint, "this constraint was removed"));
    return pool.items[constraint.index];
  }
  /// The impulse (N·s, N·m·s) of a constraint's rows in the last step.
  template <class Law>
  const auto& impulse(ConstraintHandle<Law> constraint) const {
    const auto& pool = laws().template of<Law>();
    DELASSUS_EXPECT(pool.contains(constraint), "impulse: " + pool.stale(constraint, "this constraint was removed"));
    return pool.impulse[constraint.index];
  }
  /// The constraints of a `Breakable` law that broke in the last step; they are taken out when the next one begins.
  template <class Law>
  std::span<const ConstraintHandle<Law>> broken() const
    requires BreakableLaw<Law>
  {
    return laws().template of<Law>().broken;
  }
  /// The force (N, N·m) of a constraint's rows that the next step starts from, and that `PredictiveScheme` applies.
  template <class Law>
  auto predicted_force(ConstraintHandle<Law> constraint) const {
    return (impulse(constraint) / h_).eval();
  }
  /// The contacts of the last step with their impulses, sorted by pair and feature.
  std::span<const ContactResult> contacts() const
    requires(Laws::has_contacts)
  {
    return work_.contacts.results;
  }
  /// Friction and restitution by material.
  Materials& materials()
    requires(Laws::has_contacts)
  {
    return work_.materials;
  }

  /// Who takes no part in the steps, where the activity allows it.
  const auto& dormant() const
    requires(may_rest)
  {
    return work_.activity.dormant();
  }
  /// Wakes a body with all that sleeps with it; nothing for one that is awake.
  template <class Set>
  void wake(Handle<Set> body)
    requires(may_rest)
  {
    inner::visit_body(world(), body, [&](auto&, Index s) { work_.activity.wake(world(), laws(), s, body.index); });
  }
  void wake_all()
    requires(may_rest)
  {
    work_.activity.wake_all(world(), laws());
  }
  /// Takes a body out of the steps until it is switched on: for `HandPicked`.
  template <class Set>
  void switch_off(Handle<Set> body)
    requires(has<HandPicked>)
  {
    inner::visit_body(world(), body,
                      [&](auto& set, Index s) { work_.activity.lull(world(), laws(), set, s, body.index); });
  }
  template <class Set>
  void switch_on(Handle<Set> body)
    requires(has<HandPicked>)
  {
    wake(body);
  }

  /// The constraint problem of the last step, whole and apart from the loop: laws, rows, W, islands.
  template <class Self = AnimationLoop>
  auto problem() const {
    static_assert(Self::has_problem,
                  "delassus: this AnimationLoop makes no constraint problem: without constraints, under JointByJoint and by "
                  "NewtonMidpoint there is no W; use PlainOrder and ImplicitMidpoint, or take problem() out");
    if constexpr (Self::has_problem)
      return Problem<Laws, typename Work::Rows, typename Work::Operator>{laws(), work_.rows, work_.W, work_.islands, h_};
    else
      return inner::Absent{};
  }
  /// The same into one that is there: arrays that are large enough are written over, and nothing is allocated.
  template <class P>
  void copy_problem(P& to) const {
    to.laws = laws();
    to.rows = work_.rows;
    to.W.copy_matrix(work_.W);
    to.islands = work_.islands;
    to.h = h_;
  }

  /// f(part) for the parts of that problem that hold arrays, where they are.
  template <class F>
  void each_problem_part(F&& f) const {
    f(laws()), f(work_.rows), f(work_.W), f(work_.islands);
  }

  /// The policy of a role, its default included.
  template <class Role>
  auto& part() {
    return part_of<Role>(*this);
  }
  template <class Role>
  const auto& part() const {
    return part_of<Role>(*this);
  }
  /// The part of this type among the arguments; `has` asks whether there is one.
  template <class P>
  P& get() {
    if constexpr (names<P>()) return std::get<P>(policies_);
    else return inner::no_part<P>();
  }
  template <class P>
  const P& get() const {
    if constexpr (names<P>()) return std::get<P>(policies_);
    else return inner::no_part<P>();
  }
  /// Where a listener that publishes meets other threads. It stays where it is when the loop moves.
  template <class Listener>
  auto& channel() const
    requires(has<Listener> && Publisher<Listener>)
  {
    return channels_.template of<Listener>();
  }

  const StepReport& report() const { return report_; }
  /// Solve reports of the islands of the last step.
  std::span<const SolveReport> island_reports() const
    requires(has_constraints)
  {
    return work_.reports;
  }
  /// f(pool, item, λ, |F_i|, h) for every constraint of the last step, in the order of the sweep; see `Measure`.
  template <class F>
  void each_constraint(F&& f) const {
    if constexpr (has_problem) inner::each_constraint(work_, laws(), h_, f);
  }
  /// f(a, b) for every constraint with two anchors; `world().point(a)` says where one is now.
  template <class F>
  void each_joint(F&& f) const {
    inner::each_joint(laws(), f);
  }
  /// f(impulse) for every constraint that is no contact, N·s of the last step.
  template <class F>
  void each_impulse(F&& f) const {
    for_each_index<Laws::pool_count>([&](auto p) {
      const auto& pool = laws().template pool<p>();
      if constexpr (requires { pool.slots; })
        for (const Index place : pool.slots.active()) f(pool.impulse[place]);
    });
  }
  double time() const { return start_ + double(steps_) * h_; }
  /// h of the present step, or of the last one, s.
  double step_size() const { return h_; }

  /// Everything that outlives a step: bodies, constraints, materials, warm starts, what collision and activity remember, time.
  /// The numbers of the policies (tolerances, gains) are not part of it.
  void memory(auto& archive);

  // --- the stages, in the plain order; a host that interleaves its own work calls begin(h), then these ----------------

  void begin(double h);
  void detect();
  /// For a scheme that detects first: under an explicit integrator penalty contacts become forces of this step.
  void push_apart();
  void linearize();
  void free_motion();
  void find_islands();
  void make_bias();
  void build();
  /// For a scheme that predicts: last step's impulses act on v_free, and d is made to match.
  void predict();
  void solve();
  void correct();
  void advance();
  /// Linearize to Correct at once, for an integrator that solves for joints and bodies together.
  void solve_whole_step();
  /// All of them at once, for a loop without constraints: the same bits, fewer passes.
  void move_freely();
  /// FreeMotion to Correct at once, joint by joint: for `JointByJoint`.
  void visit_joints();
  /// For a scheme that does a step in parts: h is h/count from here on, until a part ends after which none is left.
  void begin_substeps(int count);
  void end_substep(int left);

  /// No constraint, nobody who listens between Begin and Step, and parts that treat each block by itself.
  static constexpr bool moves_freely =
      !has_constraints && EachBlockAlone<typename Parts::Integrator> && !(inner::hears_within<Policies> || ...) &&
      inner::steps_by_block<WorldType>;

 private:
  static constexpr bool sound = inner::loop_is_sound<Parts, Policies...>();
  using Work = std::conditional_t<
      sound, inner::Workspace<WorldType, Laws, typename Parts::Compliance, typename Parts::Solver,
                              typename Parts::Integrator, typename Parts::Stabilisation, typename Parts::Scheme,
                              typename Parts::Activity>,
      inner::Workspace<World<>, Constraints<>, void, void, void, void, void, void>>;
  using Defaults = typename inner::DefaultsFor<Policies...>::type;
  using Channels = typename inner::channels_of_loop<sound, Parts, Policies...>::type;

  template <class P>
  static consteval bool names() {
    static_assert(has<P>,
                  "delassus: this AnimationLoop has no part of this type; name it among the arguments, or ask for the part "
                  "of a role, loop.part<role::Solver>(), which finds the defaults too");
    return has<P>;
  }
  template <class Role, class Self>
  static auto& part_of(Self& self) {
    using Part = typename inner::part_type<Parts, Role>::type;
    constexpr bool is_default = inner::holds_type<Part, Defaults>;
    if constexpr (inner::count_of<Role, Policies...> > 0) {
      return std::get<Part>(self.policies_);
    } else {
      static_assert(is_default,
                    "delassus: this AnimationLoop has no part of this role: without constraints, and under JointByJoint, there is no "
                    "solver and no compliance; do not ask for it, or take another scheme");
      if constexpr (is_default) return std::get<Part>(self.defaults_);
      else return inner::no_part<Part>();
    }
  }
  Laws& laws() { return part<role::Constraints>(); }
  const Laws& laws() const { return part<role::Constraints>(); }
  void end_advance();
  /// The rows of the last step speak of what has been taken out: there are none until the next one.
  void forget_rows() {
    if constexpr (has_constraints) {
      work_.rows.reset();
      work_.islands.clear();
      work_.reports.clear();
    }
  }
  template <class Stage>
  void tell() {
    inner::tell<Stage>(policies_, std::as_const(*this));
  }
  void check_policies() const;

  std::tuple<Policies...> policies_;
  [[no_unique_address]] Defaults defaults_{};
  [[no_unique_address]] Work work_;
  [[no_unique_address]] Channels channels_;
  typename inner::widths_of<std::conditional_t<sound, WorldType, World<>>>::Scratch scratch_;
  StepReport report_;
  double h_ = 0, last_h_ = 0, start_ = 0;
  long steps_ = 0;
};

}  // namespace delassus

#include <delassus/loop/inner/loop_members.hpp>  // what a host calls
#include <delassus/loop/inner/loop_stages.hpp>   // the stages, stage by stage
