/// The loop: the policies of a scene, and a step over them.
#pragma once

#include <delassus/fwd.hpp>
#include <delassus/loop/defaults.hpp>
#include <delassus/loop/edit.hpp>
#include <delassus/loop/loop_policies.hpp>
#include <delassus/step/plain_step.hpp>
#include <delassus/step/step_data.hpp>

#include <concepts>
#include <span>
#include <type_traits>
#include <utility>

namespace delassus {

/// `AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}}, ...}`: policies in any order, at most one of
/// each role, defaults where none is named. What is not named is not compiled. What it may be asked is with `StepData`,
/// which listeners get too.
template <class... Args>
class AnimationLoop : private StepData<typename inner::loop_policies<Args...>::type> {
 public:
  using Data = StepData<typename inner::loop_policies<Args...>::type>;  ///< what stages and listeners get
  using typename Data::Laws, typename Data::Scalar, typename Data::WorldType;
  using Data::has, Data::has_constraints, Data::has_problem, Data::moves_freely;
  using Data::channel, Data::contacts, Data::copy_problem, Data::each_constraint, Data::each_impulse, Data::each_joint,
      Data::each_problem_part, Data::get, Data::island_reports, Data::policy, Data::problem, Data::report, Data::step_size,
      Data::time, Data::world;
  /// Whether bodies may be left out of steps.
  static constexpr bool may_rest = Data::template has_state<role::Activity>;
  /// By hand.
  static constexpr bool may_switch = requires { requires Data::Policies::Activity::switches_bodies; };

  /// Takes the policies over. Throws InvalidArgument where a number of one of them is invalid.
  explicit AnimationLoop(Args... policies);

  /// The loop goes on where the other one was; the other may only be destroyed or assigned to.
  AnimationLoop(AnimationLoop&&) = default;
  AnimationLoop& operator=(AnimationLoop&&) = default;
  /// A copy that is not meant: it would step, and the loop itself would not.
  template <std::same_as<AnimationLoop> Copied>
  AnimationLoop(Copied& loop) : AnimationLoop(std::as_const(loop)) {
    static_assert(!std::is_same_v<Copied, AnimationLoop>,
                  "delassus: an AnimationLoop is not copied silently; write `auto& loop` for the one that is there, std::move(loop) "
                  "to hand it over, or loop.clone() for a copy that is meant");
  }
  /// A copy with its world, its policies and what they remember. Handles are good for both, later ones for the loop that gives them.
  /// Its channels are new: empty, not connected. Refused while a step runs.
  AnimationLoop clone() const {
    DELASSUS_EXPECT(!this->is_under_way, "clone: a step runs and its state is half made; clone the loop after the step");
    return AnimationLoop(*this);
  }

  /// Moves the scene by so many seconds. Throws InvalidArgument when they are not finite and > 0, a number of a policy was made
  /// invalid, or a body's material was never added; never for what happens inside.
  StepReport step(double seconds);

  /// What a step reads and writes: for a host that calls the stages one by one, `stage::begin(loop.data(), h)` and so on.
  Data& data() { return *this; }
  const Data& data() const { return *this; }  ///< the same, to read

  /// Adds a constraint: `loop.add(BallJoint::Item{...})`. Its law must be in Constraints{...}.
  template <class Item>
  auto add(Item item);
  /// Takes a constraint out. `problem` and `each_constraint` are empty until the next step.
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
  /// Whether the constraint is there: neither removed nor broken, and this loop's.
  template <class Law>
  bool contains(ConstraintHandle<Law> constraint) const {
    return laws().template of<Law>().contains(constraint);
  }
  /// What a constraint was added with: its numbers may be changed at any time, its anchors may not.
  template <class Law>
  auto& item(ConstraintHandle<Law> constraint) {
    return laws().template of<Law>().item_of(constraint);
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
    requires(refines<Law>(refine::breaks))
  {
    return laws().template of<Law>().broken;
  }
  /// The force (N, N·m) of a constraint's rows that the next step starts from, and that `PredictiveScheme` applies.
  template <class Law>
  auto predicted_force(ConstraintHandle<Law> constraint) const {
    return (impulse(constraint) / step_size()).eval();
  }
  /// Friction and restitution by material.
  Materials& materials()
    requires(Laws::has_contacts)
  {
    return this->material_pairs;
  }

  /// Who takes no part in the steps, where the activity allows it.
  const auto& dormant() const
    requires(may_rest)
  {
    return activity_state().dormant();
  }
  /// Wakes a body with all that sleeps with it; nothing for one that is awake.
  template <class Set>
  void wake(Handle<Set> body)
    requires(may_rest)
  {
    inner::visit_body(world(), body, [&](auto&, Index s) { activity_state().wake(world(), laws(), s, body.index); });
  }
  /// Wakes whoever sleeps, or switches on whoever is off: after an edit that wakes nobody by itself.
  void wake_all()
    requires(may_rest)
  {
    activity_state().wake_all(world(), laws());
  }
  /// Takes a body out of the steps until it is switched on, where the activity is picked by hand.
  template <class Set>
  void switch_off(Handle<Set> body)
    requires(may_switch)
  {
    inner::visit_body(world(), body,
                      [&](auto& set, Index s) { activity_state().put_to_sleep(world(), laws(), set, s, body.index); });
  }
  /// Puts it back into the steps; nothing for one that is on.
  template <class Set>
  void switch_on(Handle<Set> body)
    requires(may_switch)
  {
    wake(body);
  }

  /// Everything that outlives a step: bodies, constraints, materials, warm starts, what collision and policies remember, time.
  /// The numbers of the policies (tolerances, gains) are not part of it.
  void memory(auto& archive);

 private:
  AnimationLoop(const AnimationLoop&) = default;
  AnimationLoop& operator=(const AnimationLoop&) = default;
  static constexpr bool is_sound = inner::loop_policies<Args...>::are_sound;
  using Data::laws;
  auto& activity_state() { return Data::template state<role::Activity>(); }
  const auto& activity_state() const { return Data::template state<role::Activity>(); }
  /// The rows of the last step speak of what has been taken out: there are none until the next one.
  void forget_rows() {
    if constexpr (has_constraints) {
      this->rows.reset();
      this->islands.clear();
      this->reports.clear();
    }
  }
  void check_policies() const;
};

}  // namespace delassus

#include <delassus/loop/inner/loop_members.hpp>  // what is more than a line
