/// Rigid bodies as a structure of arrays: six velocities each, inertia turned with the body.
#pragma once

#include <delassus/bodies/body_input.hpp>
#include <delassus/bodies/inner/body_storage.hpp>
#include <delassus/bodies/inner/rigid_midpoint.hpp>
#include <delassus/bodies/inner/rigid_path.hpp>
#include <delassus/bodies/inner/rigid_state.hpp>
#include <delassus/bodies/inner/shapes.hpp>
#include <delassus/bodies/inner/surface_velocities.hpp>
#include <delassus/bodies/inner/targets.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/slice.hpp>
#include <delassus/math/fits.hpp>
#include <delassus/math/pose.hpp>
#include <delassus/math/rotation.hpp>
#include <delassus/math/twist.hpp>
#include <delassus/rows/body_set.hpp>
#include <delassus/rows/surface_motion.hpp>

#include <concepts>
#include <string>
#include <utility>

namespace delassus {

/// State q = (x, R) of the centre of mass and the axes, v = (ẋ, ω) in the world's frame.
///
///   A = mass · diag(m 1, R I Rᵀ),   f = (m g + forces, torques about the centre of mass).
///
/// The gyroscopic term is not in f. A step kicks at fixed R, so that impulses enter P and L exactly. Then bodies turn
/// freely by the midpoint rule (`midpoint_rate`), which keeps L and the energy of each body.
template <class T>
class BasicRigidBodies : public inner::BodyStorage<BasicRigidBodies<T>, T, 6> {
  using BodyStorage = inner::BodyStorage<BasicRigidBodies, T, 6>;

 public:
  using Body = RigidBody;  ///< what `add` takes
  using typename BodyStorage::Handle, typename BodyStorage::Velocity;
  using BodyStorage::gravity, BodyStorage::v_free, BodyStorage::v_next, BodyStorage::who;
  static constexpr const char* kind = "rigid body";  ///< its word in messages, as in "rigid body #3"

  BasicRigidBodies() = default;
  /// `auto set = bodies<...>(loop.world());` is a copy of which its loop knows nothing.
  template <std::same_as<BasicRigidBodies> Set>
  [[deprecated("delassus: a copy of a set of bodies, which its loop does not see; write `auto&` for the set of a "
               "loop, or std::as_const(set) for a copy that is meant")]] BasicRigidBodies(Set& set)
      : BasicRigidBodies(std::as_const(set)) {}

  // --- editing -------------------------------------------------------------------------------------------------

  /// Adds a body; throws InvalidArgument when it cannot be one.
  Handle add(const Body& body);

  /// Adds a body that never moves, or moves as the user says.
  Handle add_fixed(const Shape& shape, const Vec3& position = zero<Vec3>(),
                   const Quat& orientation = Quat::Identity()) {
    return add({.position = position, .orientation = orientation, .shape = shape, .motion = Motion::fixed});
  }

  /// Takes a body out. Its handle is stale from then on; nothing else moves.
  void remove(Handle body) {
    slots_.release(checked(body));
    shapes_.drop(body.index);
    surfaces_.drop(body.index);
    motion_[body.index] = Motion::fixed;
    set_mass(body.index);
  }

  /// Adds a force (N, at the world point, m) that acts during the next step only.
  void apply_force(Handle body, const Vec3& force, const Vec3& point) {
    const Index b = checked(body);
    const Vec3 arm = point - position_of(b);
    load_[b] += twist<T>(converted<T>(force), converted<T>(cross(arm, force)));
  }
  /// The same at the centre of mass: no torque.
  void apply_force(Handle body, const Vec3& force) {
    load_[checked(body)] += twist<T>(converted<T>(force), zero<Vec<3, T>>());
  }
  /// Adds a torque (N·m) that acts during the next step only.
  void apply_torque(Handle body, const Vec3& torque) {
    load_[checked(body)] += twist<T>(zero<Vec<3, T>>(), converted<T>(torque));
  }

  /// Of the centre of mass (m/s) and of the turn (rad/s), world. Refuses a fixed body.
  void set_velocity(Handle body, const Vec3& velocity, const Vec3& angular_velocity = zero<Vec3>()) {
    const Index b = checked(body);
    check_velocity(velocity, angular_velocity, b);
    DELASSUS_EXPECT(motion_[b] != Motion::fixed, who(b) + ": a fixed body has no velocity; add it as a kinematic one");
    v_[b] = twist<T>(converted<T>(velocity), converted<T>(angular_velocity));
  }

  /// Its surface runs beside it from now on, as that of a belt, track or roller does: at r from the centre of mass by
  /// `linear` + `angular` × r, in the axes of the body, m/s and rad/s. Friction alone sees it, along the surfaces in contact.
  /// Zero ends it.
  void set_surface_velocity(Handle body, const Vec3& linear, const Vec3& angular = zero<Vec3>()) {
    const Index b = checked(body);
    DELASSUS_EXPECT(is_finite(linear) && is_finite(angular), who(b) + ": surface velocity is not finite; give m/s and rad/s");
    DELASSUS_EXPECT(inner::fits<T>(linear), who(b) + ": surface velocity " + inner::beyond<T>(linear, "m/s"));
    DELASSUS_EXPECT(inner::fits<T>(angular), who(b) + ": angular surface velocity " + inner::beyond<T>(angular, "rad/s"));
    surfaces_.set(b, linear, angular);
  }

  /// Where a kinematic body shall be at the end of the next step; its velocity is (q(t+h) ⊖ q(t)) / h. The orientation may
  /// have any length but zero.
  void move_to(Handle body, const Vec3& position, const Quat& orientation) {
    const Index b = checked(body);
    DELASSUS_EXPECT(motion_[b] == Motion::kinematic, who(b) + ": only a kinematic body can be moved along a path");
    check_pose(position, orientation, b);
    targets_.set(b, position, orientation);
  }
  /// The same, turned as it is now.
  void move_to(Handle body, const Vec3& position) { move_to(body, position, orientation(body)); }

  /// Puts a body somewhere else at once, its velocity unchanged. The orientation may have any length but zero.
  void place(Handle body, const Vec3& position, const Quat& orientation) {
    const Index b = checked(body);
    check_pose(position, orientation, b);
    state_.place(b, position, unit(orientation));
  }
  /// The same, turned as it is.
  void place(Handle body, const Vec3& position) {
    const Index b = checked(body);
    check_pose(position, Quat::Identity(), b);
    state_.x[b] = position;
  }

  // --- reading -------------------------------------------------------------------------------------------------
  /// Of the centre of mass, world, m.
  Vec3 position(Handle body) const { return position_of(checked(body)); }
  /// Body to world, unit.
  Quat orientation(Handle body) const { return converted<double>(state_.q[checked(body)]); }
  using BodyStorage::velocity;
  /// Of the centre of mass, world, m/s.
  Vec3 velocity(Handle body) const { return converted<double>(linear_part(v_[checked(body)])); }
  /// World, rad/s.
  Vec3 angular_velocity(Handle body) const { return converted<double>(angular_part(v_[checked(body)])); }
  /// Of the surface beside the body, at a point of the world (m), in its axes, m/s; see `set_surface_velocity`.
  Vec3 surface_velocity(Handle body, const Vec3& point) const { return surface_velocity(checked(body), point); }
  double mass(Handle body) const { return state_.mass[checked(body)]; }  ///< kg; 0 of one that is not dynamic
  /// About the centre of mass, in the axes of the body, kg·m²; zero of one that is not dynamic.
  const Mat<3, 3, T>& inertia(Index b) const { return state_.inertia[b]; }
  T mass(Index b) const { return state_.mass[b]; }  ///< kg, of a block

  // --- what the loop asks: the BodySet concept -----------------------------------------------------------------

  bool moves(Index b) const { return state_.inverse_mass[b] > T(0); }
  /// Takes a body's answer to impulses away (A⁻¹ = 0), or gives it back.
  void set_fixed(Index b, bool is_held) {
    if (is_held) state_.inverse_mass[b] = T(0), set_all(state_.inverse_inertia_world[b], T(0));
    else set_mass(b);
  }
  /// Nothing moves it at any time.
  bool never_moves(Index b) const { return motion_[b] == Motion::fixed; }
  Motion motion(Index b) const { return motion_[b]; }  ///< as it was added; fixed once it is removed

  void factor(SystemScale scale) { inverse_scale_ = T(1 / scale.mass); }

  void add_forces(inner::Slice<Velocity> p) const {
    for (const Index b : slots_.active()) add_force(b, p[b]);
  }
  /// The same of block b: p += loads + m g, N and N·m, without the gyroscopic term.
  void add_force(Index b, Velocity& p) const {
    p += load_[b];
    const Vec<3, T> weight = state_.mass[b] * Vec<3, T>(converted<T>(gravity));
    for (int k = 0; k < 3; ++k) p[k] += weight[k];
  }

  /// p += s M v.
  void add_mass_times_velocity(inner::Slice<Velocity> p, double s) const {
    for (const Index b : slots_.active()) add_mass_times_velocity(b, p[b], s);
  }
  /// The same of block b; nothing where it does not move.
  void add_mass_times_velocity(Index b, Velocity& p, double s) const {
    if (moves(b)) p += state_.momentum(b, v_[b], T(s));
  }

  /// A_b⁻¹ x for each column of x: diag(1/m, R I⁻¹ Rᵀ) / mass scale.
  template <int C>
  Mat<6, C, T> solve_block(Index b, const Mat<6, C, T>& x) const {
    return state_.solve(b, x, inverse_scale_);
  }

  /// 1/kg, mass scale aside; 0 of what does not move.
  T inverse_mass(Index b) const { return state_.inverse_mass[b]; }
  /// R I⁻¹ Rᵀ about `centre`, in the axes of the world, 1/(kg·m²); zero of what does not move.
  const Mat<3, 3, T>& inverse_inertia(Index b) const { return state_.inverse_inertia_world[b]; }
  const Vec3& centre(Index b) const { return state_.x[b]; }  ///< of mass, world, m

  /// A fixed body answers to nothing and does not move: it has no block in any row.
  int anchor_blocks(const Anchor& a) const { return motion_[a.block] == Motion::fixed ? 0 : 1; }
  Index anchor_block(const Anchor& a, int) const { return a.block; }
  /// Row of H: direction · (v + ω × r) = (direction, r × direction) · (v, ω), r from the centre of mass to `point`.
  Velocity along(const Anchor& a, int, const Vec3& point, const Vec3& direction) const {
    const Vec3 arm = point - position_of(a.block);
    return twist<T>(converted<T>(direction), converted<T>(cross(arm, direction)));
  }
  Velocity about(const Anchor&, int, const Vec3& axis) const {
    return twist<T>(zero<Vec<3, T>>(), converted<T>(axis));
  }
  /// World, m.
  Vec3 point(const Anchor& a) const {
    return state_.x[a.block] +
           converted<double>(Vec<3, T>(state_.R[a.block] * converted<T>(a.local)));
  }
  /// Of a joint on it, to the world.
  Quat frame(const Anchor& a) const { return converted<double>(state_.q[a.block]) * a.frame; }
  /// The same as a matrix whose columns are the axes.
  Mat3 axes(const Anchor& a) const { return converted<double>(state_.R[a.block]) * a.frame.toRotationMatrix(); }

  /// How it moves under a contact.
  SurfaceMotion surface(const Anchor& a, const Vec3& point) const {
    const Index b = a.block;
    return {.centre = position_of(b),
            .velocity = converted<double>(linear_part(v_[b])),
            .turn = converted<double>(angular_part(v_[b])),
            .running = surfaces_.are_any() ? surface_velocity(b, point) : Vec3(zero<Vec3>()),
            .running_turn = surfaces_.are_any() ? Vec3(converted<double>(state_.R[b]) * surfaces_.turn(b)) : Vec3(zero<Vec3>()),
            .is_led = motion_[b] != Motion::dynamic,
            .is_rigid = true};
  }
  const auto& surface_velocities() const { return surfaces_; }  ///< of all bodies
  /// Whether a kinematic body turns by more than 1e-6 rad in a step of h (s): where it does not, its circles are straight.
  bool has_turning_carriers(double h) const {
    if (!has_kinematic_) return false;
    const double least = 1e-6 / h;
    for (const Index b : slots_.active())
      if (motion_[b] == Motion::kinematic && double(squared_norm(angular_part(v_[b]))) > least * least) return true;
    return false;
  }

  /// Kick and drift: x₊ = x + h v_next, and free rotation from ω_next. A body whose state after it is not finite stays
  /// as it is.
  void advance(double h) { advance_with(h, T(0)); }
  /// The midpoint rule: x₊ = x + h (v + v_next)/2, and rotation with the angular impulse I (ω_next − ω).
  void advance_midpoint(double h) { advance_with(h, T(0.5)); }
  /// Kick and drift, where the free rotation is a splitting into turns.
  void advance_by_rotation_splitting(double h) { advance_with(h, RotationSplitting{}); }

  /// One body at a time.
  struct Blocks {
    BasicRigidBodies& set;            ///< whose bodies these are
    inner::QuarantineRecord* record;  ///< notes who was left where it was

    bool moves(Index b) const { return set.moves(b); }
    /// m/s and rad/s, at the start of the step.
    const Velocity& velocity(Index b) const { return set.v_[b]; }
    /// p += loads + m g, N and N·m.
    void add_force(Index b, Velocity& p) const { set.add_force(b, p); }
    /// p += s M v; nothing where the body does not move.
    void add_mass_times_velocity(Index b, Velocity& p, double s) const { set.add_mass_times_velocity(b, p, s); }
    Velocity solve(Index b, const Velocity& p) const { return set.template solve_block<1>(b, p); }
    void advance(Index b, const Velocity& next, double h, auto share) const { set.advance_block(b, next, h, share, *record); }
  };
  /// Opens the set for one pass over its blocks, and forgets who was left before.
  Blocks by_block(SystemScale scale) {
    factor(scale);
    quarantine_ = {};
    return {*this, &quarantine_};
  }
  /// No force acts between bodies: every one moves by itself.
  static constexpr bool is_separable() { return true; }

  /// Moves block b by a small displacement (m, rad) without touching its velocity.
  void displace(Index b, const Velocity& by) { state_.displace(b, linear_part(by), angular_part(by)); }

  /// The velocities of kinematic bodies for this step.
  void begin_step(double h) {
    targets_.each_velocity(slots_.active(), state_, h, [&](Index b, const Velocity& v) { assign(v_[b], v); });
  }

  /// Moves q to q ⊕ h v and back: the configuration at which an integrator wants the constraints linearised.
  void shift(double h) {
    state_.keep_poses();
    for (const Index b : slots_.active())
      if (motion_[b] != Motion::fixed) state_.displace(b, T(h) * linear_part(v_[b]), T(h) * angular_part(v_[b]));
  }
  /// Back to the poses that `shift` set aside.
  void restore() { state_.restore_poses(slots_.active()); }

  /// What a midpoint rule that is solved by Newton's method does with each body.
  using Midpoint = inner::RigidMidpoint<T>;
  auto& state() { return state_; }  ///< poses, masses and inertias: what `Midpoint` and `Path` work on
  /// What a scheme that finds q and v of the end itself does with each body; it leaves q there, and v_next.
  using Path = inner::RigidPath<T>;
  /// v ← v_next of dynamic bodies, whose q is there already; moves kinematic ones by h (s).
  void finish_step(double h) {
    quarantine_ = {};
    for (const Index b : slots_.active()) {
      if (motion_[b] != Motion::dynamic) {
        advance_block(b, v_next[b], h, T(0), quarantine_);
        continue;
      }
      if (is_finite(v_next[b])) assign(v_[b], v_next[b]);
      else quarantine_.leave(load_.data(), load_[b]);
      set_all(load_[b], T(0));
    }
  }
  auto& targets() { return targets_; }  ///< of `move_to`, for a scheme that does a step in parts

  /// What collision detection needs of each body.
  bool has_collider(Index b) const { return this->is_alive(b) && shapes_.kind(b) != ShapeKind::none; }
  Shape shape(Index b) const { return shapes_.of(b); }  ///< a hull has its centre of volume at the origin
  /// Centre of mass (m) and axes, to the world.
  Pose pose(Index b) const { return {position_of(b), converted<double>(state_.R[b])}; }

  /// What outlives a step, shapes included; handles of the set that wrote it stay with that set.
  void memory(auto& archive) {
    BodyStorage::memory(archive);
    archive(state_, motion_, targets_, shapes_, surfaces_, has_kinematic_);
  }

 private:
  Vec3 position_of(Index b) const { return state_.x[b]; }
  Vec3 surface_velocity(Index b, const Vec3& point) const {
    const Mat3 R = converted<double>(state_.R[b]);
    return R * surfaces_.at(b, transposed_times(R, point - position_of(b)));
  }
  void check_velocity(const Vec3& velocity, const Vec3& angular_velocity, Index b) const {
    DELASSUS_EXPECT(is_finite(velocity) && is_finite(angular_velocity), who(b) + ": velocity is not finite");
    DELASSUS_EXPECT(inner::fits<T>(velocity), who(b) + ": velocity " + inner::beyond<T>(velocity, "m/s"));
    DELASSUS_EXPECT(inner::fits<T>(angular_velocity),
                    who(b) + ": angular velocity " + inner::beyond<T>(angular_velocity, "rad/s"));
  }
  void check_pose(const Vec3& position, const Quat& orientation, Index b) const {
    const double length = norm(orientation.coeffs());
    DELASSUS_EXPECT(is_finite(position) && std::isfinite(length) && length > 1e-12, who(b) + ": pose is not finite");
    DELASSUS_EXPECT(inner::fits<T>(position), who(b) + ": position " + inner::beyond<T>(position, "m"));
  }
  void set_mass(Index b) { state_.set_mass(b, motion_[b] == Motion::dynamic); }
  void advance_with(double h, auto share) {
    quarantine_ = {};
    for (const Index b : slots_.active()) advance_block(b, v_next[b], h, share, quarantine_);
  }
  /// q and v of body b from its v_next.
  void advance_block(Index b, const Velocity& next, double h_, auto share, inner::QuarantineRecord& record) {
    if (motion_[b] == Motion::fixed) return;
    const T h = T(h_);
    const bool is_done =
        motion_[b] == Motion::kinematic ? follow(b, next, h) : state_.drift(b, v_[b], next, h, share);
    if (!is_done) [[unlikely]] return record.leave(load_.data(), load_[b]);
    set_all(load_[b], T(0));
  }
  /// A kinematic body goes where it was told, or on with its velocity.
  bool follow(Index b, const Velocity& next, T h) {
    if (!state_.displace(b, h * linear_part(next), h * angular_part(next))) return false;
    if (targets_.reach(b, state_)) set_all(v_[b], T(0));
    return true;
  }

  using BodyStorage::checked, BodyStorage::slots_, BodyStorage::quarantine_, BodyStorage::v_, BodyStorage::load_;
  T inverse_scale_ = 1;
  inner::RigidState<T> state_;
  Array<Motion> motion_;
  inner::Targets targets_;
  inner::Shapes shapes_;
  inner::SurfaceVelocities surfaces_;
  bool has_kinematic_ = false;  ///< one was added, at some time
};

using RigidBodies = BasicRigidBodies<double>;  ///< in double
using RigidBodiesF = BasicRigidBodies<float>;  ///< in float

template <class T>
typename BasicRigidBodies<T>::Handle BasicRigidBodies<T>::add(const Body& body) {
  const Index next = slots_.size();
  const std::string name = who(next);
  const Quat orientation = inner::check_state(body, name);
  check_pose(body.position, orientation, next);
  check_velocity(body.velocity, body.angular_velocity, next);
  check(body.shape, name);
  const bool is_dynamic = body.motion == Motion::dynamic;
  MassProperties mass;
  if (is_dynamic) mass = inner::check_mass<T>(body, name);

  Velocity velocity = twist<T>(converted<T>(body.velocity), converted<T>(body.angular_velocity));
  if (body.motion == Motion::fixed) set_zero(velocity);
  const Index b = BodyStorage::take(body, velocity);
  const std::size_t n = std::size_t(slots_.size());
  state_.resize(n);
  motion_.resize(n);
  targets_.resize(n);
  state_.mass[b] = T(mass.mass);
  state_.inertia[b] = Mat<3, 3, T>(converted<T>(mass.inertia));
  if (is_dynamic) state_.inverse_inertia[b] = Mat<3, 3, T>(converted<T>(inner::inverse_of_inertia(mass.inertia)));
  state_.place(b, body.position, orientation);
  motion_[b] = body.motion;
  has_kinematic_ = has_kinematic_ || body.motion == Motion::kinematic;
  targets_.drop(b);
  shapes_.give(b, body.shape);
  set_mass(b);
  return this->handle(b);
}

}  // namespace delassus
