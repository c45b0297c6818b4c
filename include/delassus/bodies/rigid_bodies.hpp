/// Rigid bodies as a structure of arrays: six velocities each, inertia turned with the body.
#pragma once

#include <delassus/bodies/body_input.hpp>
#include <delassus/bodies/inner/rigid_state.hpp>
#include <delassus/core/handle.hpp>
#include <delassus/core/slots.hpp>
#include <delassus/math/pose.hpp>
#include <delassus/math/rotation.hpp>
#include <delassus/math/twist.hpp>
#include <delassus/rows/body_set.hpp>

#include <deque>
#include <string>
#include <vector>

namespace delassus {

/// State q = (x, R) of the centre of mass and the axes, v = (ẋ, ω) in the world's frame.
///
///   A = mass · diag(m 1, R I Rᵀ),   f = (m g + forces, torques about the centre of mass).
///
/// The gyroscopic term is not in f: a step kicks at fixed R, so that impulses enter P and L exactly, then drifts
/// by free rotation by the midpoint rule (`midpoint_rate`), which keeps L and the energy of each body.
template <class T>
class BasicRigidBodies {
 public:
  using Scalar = T;
  using Body = RigidBody;
  using Handle = delassus::Handle<BasicRigidBodies>;
  using Velocity = Vec<6, T>;
  static constexpr int width = 6;

  Vec3 gravity{0, 0, -9.81};

  // --- editing -------------------------------------------------------------------------------------------------

  /// Adds a body; throws InvalidArgument when it cannot be one.
  Handle add(const Body& body);

  /// Adds a body that never moves, or moves as the user says.
  Handle add_fixed(const Shape& shape, const Vec3& position = Vec3::Zero(),
                   const Quat& orientation = Quat::Identity());

  /// Takes a body out. Its handle is stale from then on; nothing else moves.
  void remove(Handle body) {
    slots_.give_back(checked(body));
    motion_[body.index] = Motion::fixed;
    set_mass(body.index);
  }

  /// Adds a force (N, at the world point, m) that acts during the next step only.
  void apply_force(Handle body, const Vec3& force, const Vec3& point) {
    const Index b = checked(body);
    const Vec3 arm = point - position_of(b);
    load_[b] += twist<T>(force.template cast<T>(), arm.cross(force).template cast<T>());
  }
  void apply_force(Handle body, const Vec3& force) {
    load_[checked(body)] += twist<T>(force.template cast<T>(), Vec<3, T>::Zero());
  }
  /// Adds a torque (N·m) that acts during the next step only.
  void apply_torque(Handle body, const Vec3& torque) {
    load_[checked(body)] += twist<T>(Vec<3, T>::Zero(), torque.template cast<T>());
  }

  void set_velocity(Handle body, const Vec3& velocity, const Vec3& angular_velocity = Vec3::Zero()) {
    DELASSUS_EXPECT(is_finite(velocity) && is_finite(angular_velocity),
                    who(body.index) + ": velocity is not finite");
    v_[checked(body)] = twist<T>(velocity.template cast<T>(), angular_velocity.template cast<T>());
  }

  /// Where a kinematic body shall be at the end of the next step; its velocity is (q(t+h) ⊖ q(t)) / h.
  void move_to(Handle body, const Vec3& position, const Quat& orientation = Quat::Identity()) {
    const Index b = checked(body);
    DELASSUS_EXPECT(motion_[b] == Motion::kinematic, who(b) + ": only a kinematic body can be moved along a path");
    DELASSUS_EXPECT(is_pose(position, orientation), who(b) + ": pose is not finite");
    target_[b] = Target{position, unit(orientation), true};
    has_targets_ = true;
  }

  /// Puts a body somewhere else at once, its velocity unchanged.
  void place(Handle body, const Vec3& position, const Quat& orientation = Quat::Identity()) {
    const Index b = checked(body);
    DELASSUS_EXPECT(is_pose(position, orientation), who(b) + ": pose is not finite");
    state_.x[b] = position.template cast<T>();
    state_.q[b] = unit(orientation).template cast<T>();
    state_.turn(b);
  }

  // --- reading -------------------------------------------------------------------------------------------------

  Vec3 position(Handle body) const { return position_of(checked(body)); }
  Quat orientation(Handle body) const { return state_.q[checked(body)].template cast<double>(); }
  Vec3 velocity(Handle body) const { return linear_part(v_[checked(body)]).template cast<double>(); }
  Vec3 angular_velocity(Handle body) const { return angular_part(v_[checked(body)]).template cast<double>(); }
  double mass(Handle body) const { return state_.mass[checked(body)]; }
  bool contains(Handle body) const {
    return body.owner == owner_ && slots_.is_current(body.index, body.generation);
  }
  Handle handle(Index block) const { return {block, slots_.generation(block), owner_}; }
  const std::vector<Index>& active() const { return slots_.active(); }

  const Mat<3, 3, T>& inertia(Index b) const { return state_.inertia[b]; }
  T mass(Index b) const { return state_.mass[b]; }

  // --- what the loop asks: the BodySet concept -----------------------------------------------------------------

  Index blocks() const { return slots_.size(); }
  bool is_alive(Index b) const { return slots_.is_alive(b); }
  bool is_awake(Index b) const { return slots_.is_awake(b); }
  bool moves(Index b) const { return state_.inverse_mass[b] > T(0); }
  const Velocity& load(Index b) const { return load_[b]; }
  /// Puts a body to sleep where it is: it is in no list of `active`, and its velocity reads zero.
  void lull(Index b) {
    slots_.set_awake(b, false);
    v_[b].setZero();
    v_free[b] = v_next[b] = v_[b];
  }
  void rouse(Index b) { slots_.set_awake(b, true); }
  /// Takes a body's answer to impulses away (A⁻¹ = 0), or gives it back.
  void hold(Index b, bool is_held) {
    if (is_held) state_.inverse_mass[b] = T(0), state_.inverse_inertia_world[b].setZero();
    else set_mass(b);
  }
  Motion motion(Index b) const { return motion_[b]; }

  void factor(SystemScale scale) { inverse_scale_ = T(1 / scale.mass); }

  void add_forces(std::vector<Velocity>& p) const {
    for (const Index b : slots_.active()) add_force(b, p[b]);
  }
  void add_force(Index b, Velocity& p) const {
    p += load_[b];
    const Vec<3, T> weight = state_.mass[b] * Vec<3, T>(gravity.template cast<T>());
    for (int k = 0; k < 3; ++k) p[k] += weight[k];
  }

  /// p += s M v.
  void add_mass_times_velocity(std::vector<Velocity>& p, double s) const {
    for (const Index b : slots_.active()) add_mass_times_velocity(b, p[b], s);
  }
  void add_mass_times_velocity(Index b, Velocity& p, double s) const {
    if (moves(b)) p += state_.momentum(b, v_[b], T(s));
  }

  /// A_b⁻¹ x for each column of x: diag(1/m, R I⁻¹ Rᵀ) / mass scale.
  template <int C>
  Mat<6, C, T> solve_block(Index b, const Mat<6, C, T>& x) const {
    return state_.solve(b, x, inverse_scale_);
  }

  /// A fixed body answers to nothing and does not move: it has no block in any row.
  int anchor_blocks(const Anchor& a) const { return motion_[a.block] == Motion::fixed ? 0 : 1; }
  Index anchor_block(const Anchor& a, int) const { return a.block; }
  /// Row of H: direction · (v + ω × r) = (direction, r × direction) · (v, ω), r from the centre of mass to `point`.
  Velocity along(const Anchor& a, int, const Vec3& point, const Vec3& direction) const {
    const Vec3 arm = point - position_of(a.block);
    return twist<T>(direction.template cast<T>(), arm.cross(direction).template cast<T>());
  }
  Velocity about(const Anchor&, int, const Vec3& axis) const {
    return twist<T>(Vec<3, T>::Zero(), axis.template cast<T>());
  }
  Vec3 point(const Anchor& a) const {
    return (state_.x[a.block] + state_.R[a.block] * Vec<3, T>(a.local.template cast<T>()))
        .template cast<double>();
  }
  Quat frame(const Anchor& a) const { return state_.q[a.block].template cast<double>() * a.frame; }

  /// Kick and drift: x₊ = x + h v_next, and free rotation from ω_next. A body whose v_next is not finite stays where it is.
  void advance(double h) { advance_with(h, T(0)); }
  /// The midpoint rule: x₊ = x + h (v + v_next)/2, and rotation with the angular impulse I (ω_next − ω).
  void advance_midpoint(double h) { advance_with(h, T(0.5)); }

  /// One body at a time.
  struct Blocks {
    BasicRigidBodies& set;

    bool moves(Index b) const { return set.moves(b); }
    const Velocity& velocity(Index b) const { return set.v_[b]; }
    void add_force(Index b, Velocity& p) const { set.add_force(b, p); }
    void add_mass_times_velocity(Index b, Velocity& p, double s) const { set.add_mass_times_velocity(b, p, s); }
    Velocity solve(Index b, const Velocity& p) const { return set.template solve_block<1>(b, p); }
    void advance(Index b, const Velocity& next, double h, T old_share) const { set.advance_block(b, next, h, old_share); }
  };
  Blocks by_block(SystemScale scale) {
    factor(scale);
    held_ = 0;
    return {*this};
  }
  /// No force acts between bodies: every one moves by itself.
  bool is_separable() const { return true; }

  /// How many bodies the last advance left where they were.
  Index held() const { return held_; }
  /// Moves block b by a small displacement (m, rad) without touching its velocity.
  void displace(Index b, const Velocity& by) { state_.displace(b, linear_part(by), angular_part(by)); }

  /// Velocities: of kinematic bodies for this step, and the arrays the stages write.
  void begin_step(double h);
  const std::vector<Velocity>& velocity() const { return v_; }
  std::vector<Velocity>& velocity() { return v_; }
  std::vector<Velocity> v_free, v_next;

  /// Moves q to q ⊕ h v and back: the configuration at which an integrator wants the constraints linearised.
  void shift(double h);
  void restore();

  /// What collision detection needs of each body.
  Index collider_count() const { return blocks(); }
  bool has_collider(Index b) const { return slots_.is_alive(b) && shape_[b].kind != ShapeKind::none; }
  Shape shape(Index b) const {
    Shape shape = shape_[b];
    if (hull_[b] >= 0) shape.hull = &hulls_[hull_[b]];
    return shape;
  }
  Pose pose(Index b) const { return {position_of(b), state_.R[b].template cast<double>()}; }
  Index material(Index b) const { return material_[b]; }
  std::uint32_t group(Index b) const { return group_[b]; }
  std::uint32_t collides_with(Index b) const { return collides_with_[b]; }

  std::uint32_t owner() const { return owner_; }
  std::string who(Index b) const { return "rigid body #" + std::to_string(b); }

  /// What outlives a step, shapes included; handles of the set that wrote it stay with that set.
  void memory(auto& archive) {
    archive(gravity, slots_, has_targets_, state_.x, state_.q, state_.R, state_.inertia,
            state_.inverse_inertia, state_.inverse_inertia_world, state_.mass, state_.inverse_mass, v_, load_,
            motion_, target_, shape_, hulls_, hull_, material_, group_, collides_with_, v_free, v_next);
  }

 private:
  struct Target {
    Vec3 position = Vec3::Zero();
    Quat orientation = Quat::Identity();
    bool is_set = false;
  };

  Vec3 position_of(Index b) const { return state_.x[b].template cast<double>(); }
  Index checked(Handle body) const {
    DELASSUS_EXPECT(body.owner == owner_, "this rigid body handle belongs to another world");
    DELASSUS_EXPECT(slots_.is_current(body.index, body.generation), who(body.index) + " was removed; its handle is stale");
    return body.index;
  }
  static bool is_pose(const Vec3& position, const Quat& orientation) {
    const double norm = orientation.coeffs().norm();
    return is_finite(position) && std::isfinite(norm) && norm > 1e-12;
  }
  void set_mass(Index b) { state_.set_mass(b, motion_[b] == Motion::dynamic); }
  void advance_with(double h, T old_share);
  /// q and v of body b from its v_next.
  void advance_block(Index b, const Velocity& next, double h, T old_share);
  void follow(Index b, const Velocity& next, T h);

  Slots slots_;
  std::uint32_t owner_ = inner::next_owner();
  T inverse_scale_ = 1;
  Index held_ = 0;
  bool has_targets_ = false;  ///< move_to was called and the step that goes there is not over
  inner::RigidState<T> state_;
  std::vector<Vec<3, T>> shifted_x_;
  std::vector<Eigen::Quaternion<T>> shifted_q_;
  std::vector<Velocity> v_, load_;
  std::vector<Motion> motion_;
  std::vector<Target> target_;
  std::vector<Shape> shape_;
  std::deque<ConvexHull> hulls_;
  std::vector<Index> hull_, material_;
  std::vector<std::uint32_t> group_, collides_with_;
};

using RigidBodies = BasicRigidBodies<double>;
using RigidBodiesF = BasicRigidBodies<float>;

template <class T>
typename BasicRigidBodies<T>::Handle BasicRigidBodies<T>::add(const Body& body) {
  const std::string name = who(slots_.size());
  const Quat orientation = inner::check_state(body, name);
  check(body.shape, name);
  MassProperties mass;
  if (body.motion == Motion::dynamic) mass = inner::check_mass(body, name);

  const Index b = slots_.take();
  const std::size_t n = std::size_t(slots_.size());
  state_.resize(n);
  shifted_x_.resize(n);
  shifted_q_.resize(n);
  for (auto* array : {&v_, &load_, &v_free, &v_next}) array->resize(n);
  motion_.resize(n);
  target_.resize(n);
  shape_.resize(n);
  hull_.resize(n);
  material_.resize(n);
  group_.resize(n);
  collides_with_.resize(n);

  state_.x[b] = body.position.template cast<T>();
  state_.q[b] = orientation.template cast<T>();
  motion_[b] = body.motion;
  state_.mass[b] = T(mass.mass);
  state_.inertia[b] = mass.inertia.template cast<T>();
  if (body.motion == Motion::dynamic) state_.inverse_inertia[b] = inverse(mass.inertia).template cast<T>();
  v_[b] = twist<T>(body.velocity.template cast<T>(), body.angular_velocity.template cast<T>());
  if (body.motion == Motion::fixed) v_[b].setZero();
  load_[b].setZero();
  v_free[b] = v_next[b] = v_[b];
  target_[b] = {};
  shape_[b] = body.shape;
  hull_[b] = -1;
  if (body.shape.hull) {
    hull_[b] = Index(hulls_.size());
    hulls_.push_back(body.shape.hull->centred());
    shape_[b].hull = nullptr;
  }
  material_[b] = body.material;
  group_[b] = body.group;
  collides_with_[b] = body.collides_with;
  set_mass(b);
  return handle(b);
}

template <class T>
typename BasicRigidBodies<T>::Handle BasicRigidBodies<T>::add_fixed(const Shape& shape, const Vec3& position,
                                                                    const Quat& orientation) {
  return add({.position = position, .orientation = orientation, .shape = shape, .motion = Motion::fixed});
}

template <class T>
void BasicRigidBodies<T>::begin_step(double h) {
  if (!has_targets_) return;
  has_targets_ = false;
  for (const Index b : slots_.active()) {
    if (motion_[b] != Motion::kinematic || !target_[b].is_set) continue;
    has_targets_ = true;
    const Quat now = state_.q[b].template cast<double>();
    const Vec3 way = target_[b].position - position_of(b),
               turn = logarithm<double>(target_[b].orientation * now.conjugate());
    v_[b] = twist<T>((way / h).template cast<T>(), (turn / h).template cast<T>());
  }
}

template <class T>
void BasicRigidBodies<T>::advance_with(double h, T old_share) {
  held_ = 0;
  for (const Index b : slots_.active()) advance_block(b, v_next[b], h, old_share);
}

template <class T>
void BasicRigidBodies<T>::advance_block(Index b, const Velocity& next, double h_, T old_share) {
  if (motion_[b] == Motion::fixed) return;
  const T h = T(h_);
  load_[b].setZero();
  if (!is_finite(next)) {
    ++held_;
    return;
  }
  if (motion_[b] == Motion::kinematic) return follow(b, next, h);
  v_[b] = state_.drift(b, v_[b], next, h, old_share);
}

/// A kinematic body goes where it was told, exactly.
template <class T>
void BasicRigidBodies<T>::follow(Index b, const Velocity& next, T h) {
  state_.displace(b, h * linear_part(next), h * angular_part(next));
  if (!target_[b].is_set) return;
  state_.x[b] = target_[b].position.template cast<T>();
  state_.q[b] = target_[b].orientation.template cast<T>();
  state_.turn(b);
  target_[b].is_set = false;
  v_[b].setZero();
}

template <class T>
void BasicRigidBodies<T>::shift(double h) {
  shifted_x_ = state_.x;
  shifted_q_ = state_.q;
  for (const Index b : slots_.active()) {
    if (motion_[b] == Motion::fixed) continue;
    state_.displace(b, T(h) * linear_part(v_[b]), T(h) * angular_part(v_[b]));
  }
}

template <class T>
void BasicRigidBodies<T>::restore() {
  state_.x = shifted_x_;
  state_.q = shifted_q_;
  for (const Index b : slots_.active()) state_.turn(b);
}

}  // namespace delassus
