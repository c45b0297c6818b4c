/// Rods: needles, catheters and threads as chains of corotational Timoshenko beams.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/fem/inner/bodies_of_nodes.hpp>
#include <delassus/fem/inner/elastic_line.hpp>
#include <delassus/fem/rod.hpp>
#include <delassus/geometry/shape.hpp>
#include <delassus/math/pose.hpp>
#include <delassus/math/twist.hpp>

#include <algorithm>
#include <concepts>
#include <string>
#include <utility>
#include <vector>

namespace delassus {

/// q = (x, R) and v = (ẋ, ω) of the nodes, in the world's frame. f = (m g + loads − ∂Ψ/∂x, moments);
/// A = mass M + stiffness K. M is lumped: half of each segment's mass and of its section's ρ diag(I_y + I_z,
/// I_y, I_z) L goes to each end and turns with it. Between steps nodes turn as free bodies do. One
/// block-tridiagonal factor of A a rod. Damping is the integrator's: `ImplicitEuler{.rayleigh_mass,
/// .rayleigh_stiffness}`.
///
/// Neighbours must not be turned by half a turn against each other. An explicit integrator is stable only for
/// h below the time that sound takes through the shortest segment, and far less for a thin one.
template <class T>
class BasicRods
    : public inner::BodiesOfNodes<BasicRods<T>, inner::BodyStorage<BasicRods<T>, T, 6>, Rod, inner::ElasticLine<T>> {
  using Nodes = inner::BodiesOfNodes<BasicRods, inner::BodyStorage<BasicRods, T, 6>, Rod, inner::ElasticLine<T>>;

 public:
  using Nodes::gravity, Nodes::name, Nodes::v_free, Nodes::v_next;
  using typename Nodes::BodyHandle, typename Nodes::Handle, typename Nodes::Velocity;
  static constexpr const char* body_kind = "rod";  ///< its word in messages, as in "rod #3"

  BasicRods() = default;
  /// `auto set = bodies<...>(loop.world());` is a copy of which its loop knows nothing.
  template <std::same_as<BasicRods> Set>
  [[deprecated("delassus: a copy of a set of bodies, which its loop does not see; write `auto&` for the set of a "
               "loop, or std::as_const(set) for a copy that is meant")]] BasicRods(Set& set)
      : BasicRods(std::as_const(set)) {}

  // --- editing -------------------------------------------------------------------------------------------

  /// Adds a rod; throws InvalidArgument when it cannot be one.
  BodyHandle add(const Rod& rod);

  /// Adds a force (world, N) that acts on a node during the next step only.
  void apply_force(Handle node, const Vec3& force) {
    load_[checked(node)] += twist<T>(converted<T>(force), Vec<3, T>::Zero());
  }
  /// The same with a moment about the node, world, N·m.
  void apply_torque(Handle node, const Vec3& torque) {
    load_[checked(node)] += twist<T>(Vec<3, T>::Zero(), converted<T>(torque));
  }
  /// World, m/s and rad/s. Refuses a fixed node, and numbers that are not finite.
  void set_velocity(Handle node, const Vec3& velocity, const Vec3& angular_velocity = Vec3::Zero()) {
    const Index b = checked(node);
    DELASSUS_EXPECT(inner::fits<T>(velocity),
                    name(b) + ": velocity " + inner::beyond<T>(velocity, "m/s"));
    DELASSUS_EXPECT(inner::fits<T>(angular_velocity),
                    name(b) + ": angular velocity " + inner::beyond<T>(angular_velocity, "rad/s"));
    DELASSUS_EXPECT(!is_fixed_[b], name(b) + ": a fixed node has no velocity; release it first");
    v_[b] = twist<T>(converted<T>(velocity), converted<T>(angular_velocity));
  }
  /// Puts a node somewhere else at once, its velocity unchanged.
  void place(Handle node, const Vec3& position, const Quat& orientation) {
    const Index b = checked(node);
    DELASSUS_EXPECT(inner::fits<T>(position),
                    name(b) + ": position " + inner::beyond<T>(position, "m"));
    DELASSUS_EXPECT(std::abs(orientation.coeffs().norm() - 1) < 1e-6,
                    name(b) + ": orientation is not a unit quaternion");
    state_.place(b, position, unit(orientation));
  }

  // --- reading -------------------------------------------------------------------------------------------

  Vec3 position(Handle node) const { return position_of(checked(node)); }  ///< world, m
  /// Node to world, unit.
  Quat orientation(Handle node) const { return converted<double>(state_.q[checked(node)]); }
  using Nodes::velocity;
  /// World, m/s.
  Vec3 velocity(Handle node) const { return converted<double>(linear_part(v_[checked(node)])); }
  /// World, rad/s.
  Vec3 angular_velocity(Handle node) const {
    return converted<double>(angular_part(v_[checked(node)]));
  }
  /// Half of the mass of the segments at a node, kg; fixed nodes have theirs too.
  T mass(Index b) const { return state_.mass[b]; }
  /// M_b times a velocity: kg·m/s, and kg·m²/s about the node.
  Velocity momentum(Index b, const Velocity& v) const { return state_.momentum(b, v, T(1)); }
  /// ∫Ψ of all rods where they are now, J. Evaluates every beam.
  double elastic_energy() const {
    double sum = 0;
    each_body([&](const auto& rod) { sum += rod.energy(state_); });
    return sum;
  }
  /// The point of a rod's line next to `point` (world, m), by where it is now: a joint's end, held by the two
  /// nodes beside it. It has no frame; those of nodes have. Refuses a point further away than a tenth of that
  /// segment.
  Anchor anchor_at(BodyHandle rod, const Vec3& point) const;

  // --- what the loop asks: the BodySet concept -----------------------------------------------------------

  bool moves(Index b) const { return state_.inverse_mass[b] > T(0); }
  /// Takes a node's answer to impulses away, or gives it back where the user has not fixed it.
  void set_fixed(Index b, bool is_held) {
    state_.inverse_mass[b] = is_held || is_fixed_[b] ? T(0) : T(1) / state_.mass[b];
  }
  void factor(SystemScale scale) {
    scale_ = scale;
    each_body([&](auto& rod) { rod.factor(scale, state_); });
  }

  /// The elastic ones are those of the last `factor`.
  void add_forces(std::span<Velocity> p) const {
    const Vec<3, T> g = converted<T>(gravity);
    each_body([&](const auto& rod) {
      const auto blocks = rod.blocks();
      for (std::size_t k = 0; k < blocks.size(); ++k) {
        const Index b = blocks[k];
        if (!moves(b)) continue;
        for (int i = 0; i < 6; ++i) p[b][i] += load_[b][i] + rod.force()[k][i];
        for (int i = 0; i < 3; ++i) p[b][i] += state_.mass[b] * g[i];
      }
    });
  }
  /// p += s M v.
  void add_mass_times_velocity(std::span<Velocity> p, double s) const {
    for (const Index b : slots_.active()) p[b] += state_.momentum(b, v_[b], T(s));
  }

  /// The mass alone: M_b⁻¹ x / mass scale for each column of x.
  template <int C>
  Mat<6, C, T> solve_block(Index b, const Mat<6, C, T>& x) const {
    if (!moves(b)) return Mat<6, C, T>::Zero();
    return state_.solve(b, x, T(1 / scale_.mass));
  }

  /// A node's anchor has a frame and a place in it. One on a segment is held by both of its nodes: a joint
  /// says where along it, and a contact, whose anchor nobody owns, has its own point.
  int anchor_blocks(const Anchor& a) const { return is_on_segment(a) ? 2 : moves(a.block) ? 1 : 0; }
  Index anchor_block(const Anchor& a, int k) const { return k == 0 ? a.block : next_[a.block]; }
  Velocity along(const Anchor& a, int k, const Vec3& point, const Vec3& direction) const {
    const double share = share_of(a, point), mine = k == 0 ? 1 - share : share;
    const Vec3 arm = point - on_segment(a.block, share);
    return twist<T>(converted<T>(mine * direction), converted<T>(mine * arm.cross(direction)));
  }
  Velocity about(const Anchor& a, int k, const Vec3& axis) const {
    const double share = a.element < 0 ? 0 : a.local[0];
    return twist<T>(Vec<3, T>::Zero(), converted<T>((k == 0 ? 1 - share : share) * axis));
  }
  /// World, m.
  Vec3 point(const Anchor& a) const {
    if (a.element >= 0) return on_segment(a.block, a.local[0]);
    return position_of(a.block) + converted<double>(state_.R[a.block]) * a.local;
  }
  /// Of a joint on it, to the world.
  Quat frame(const Anchor& a) const { return converted<double>(state_.q[a.block]) * a.frame; }

  void begin_step(double) {}  ///< no node moves by itself
  void advance(double h) { advance_with(h, T(0)); }
  void advance_midpoint(double h) { advance_with(h, T(0.5)); }  ///< x₊ = x + h (v + v_next)/2, turns likewise
  /// By m and rad, the velocity unchanged.
  void displace(Index b, const Velocity& by) { state_.displace(b, linear_part(by), angular_part(by)); }
  /// Sets the poses aside and moves q to q ⊕ h v.
  void shift(double h) {
    state_.keep_poses();
    for (const Index b : slots_.active())
      if (moves(b)) displace(b, Velocity(T(h) * v_[b]));
  }
  void restore() { state_.restore_poses(slots_.active()); }  ///< back to the poses that `shift` set aside

  /// The collider of a block is the segment after its node.
  bool has_collider(Index b) const { return slots_.is_alive(b) && radius_[b] > 0 && next_[b] >= 0; }
  /// By either end of the segment.
  bool collider_moves(Index b) const { return moves(b) || moves(next_[b]); }
  /// As long as the segment is now.
  Shape shape(Index b) const { return Capsule{radius_[b], chord(b).norm()}; }
  /// Of the segment, z along it; of the last node, its own.
  Pose pose(Index b) const;

  void memory(auto& archive) {
    Nodes::memory(archive);
    archive(state_, radius_, next_);
  }

 private:
  using Nodes::bodies_, Nodes::body_slots_, Nodes::scale_;
  using Nodes::checked, Nodes::checked_body, Nodes::body_name, Nodes::each_body;
  using Nodes::slots_, Nodes::quarantine_, Nodes::v_, Nodes::load_, Nodes::is_fixed_;

  Vec3 position_of(Index b) const { return state_.x[b]; }
  Vec3 chord(Index b) const { return position_of(next_[b]) - position_of(b); }
  Vec3 on_segment(Index b, double share) const {
    return share == 0 ? position_of(b) : Vec3(position_of(b) + share * chord(b));
  }
  bool is_on_segment(const Anchor& a) const {
    return (a.element >= 0 || a.owner == 0) && next_[a.block] >= 0;
  }
  double share_of(const Anchor& a, const Vec3& point) const {
    if (!is_on_segment(a)) return 0;
    return a.element >= 0 ? a.local[0] : nearest_share(a.block, point);
  }
  /// Where along the segment after node b a point is, in [0, 1].
  double nearest_share(Index b, const Vec3& point) const {
    const Vec3 d = chord(b);
    const double share = d.dot(Vec3(point - position_of(b))) / d.squaredNorm();
    return share > 0 ? std::min(share, 1.0) : 0;
  }

  /// Kick and drift, as rigid bodies do. A rod with a velocity that is not finite stays where it is, whole.
  void advance_with(double h, T old_share) {
    quarantine_ = {};
    each_body([&](const auto& rod) {
      bool is_sound = true;
      for (const Index b : rod.blocks()) is_sound = is_sound && (!moves(b) || is_finite(v_next[b]));
      for (const Index b : rod.blocks())
        if (is_sound && moves(b)) is_sound = state_.drift(b, v_[b], v_next[b], T(h), old_share);
      if (!is_sound) this->note_held(rod);
      for (const Index b : rod.blocks()) load_[b].setZero();
    });
  }

  inner::RigidState<T> state_;
  Array<double> radius_;
  Array<Index> next_;  ///< the block of the next node of the rod; −1 at its end
};

using Rods = BasicRods<double>;  ///< in double
using RodsF = BasicRods<float>;  ///< in float

template <class T>
Pose BasicRods<T>::pose(Index b) const {
  const Mat3 R = converted<double>(state_.R[b]);
  if (next_[b] < 0) return {position_of(b), R};
  const Vec3 d = chord(b), z = d / d.norm();
  const Vec3 y_of_node(R(0, 1), R(1, 1), R(2, 1)), z_of_node(R(0, 2), R(1, 2), R(2, 2));
  Vec3 x = y_of_node.cross(z);
  if (!(x.norm() > 0.1)) x = z_of_node.cross(z);
  x /= x.norm();
  return {position_of(b) + 0.5 * d, columns<double>(x, z.cross(x), z)};
}

template <class T>
auto BasicRods<T>::add(const Rod& rod) -> BodyHandle {
  const std::string who = body_name(body_slots_.size());
  inner::check_rod<T>(rod, who);
  std::vector<Vec3> points = rod.points;
  for (Vec3& p : points) {
    p = rod.position + unit(rod.orientation) * p;
    DELASSUS_EXPECT(inner::fits<T>(p), who + ": a node at " + inner::beyond<T>(p, "m"));
  }
  const Array<Quat> frames = inner::frames_along(points, unit(rod.orientation) * rod.up);
  // Half of each segment's mass and moments, the moments in the node's axes.
  const Index n = Index(points.size());
  Array<double> mass(n, 0);
  Array<Mat3> inertia(n, Mat3::Zero());
  const RodSection& s = rod.section;
  const Vec3 section(s.second_y + s.second_z, s.second_y, s.second_z);
  for (Index e = 0; e + 1 < n; ++e)
    for (const Index k : {e, e + 1}) {
      const double half = 0.5 * rod.density * (points[e + 1] - points[e]).norm();
      const Mat3 turn = rotation_matrix<double>(frames[std::min(k, n - 2)].conjugate() * frames[e]);
      mass[k] += half * s.area;
      inertia[k] += turn * Mat3(Mat3(Vec3(half * section).asDiagonal()) * turn.transpose());
    }
  for (Index k = 0; k < n; ++k) {
    const std::string node = who + ": node " + std::to_string(k);
    DELASSUS_EXPECT(inner::has_inverse<T>(mass[k]),
                    node + " has a mass of " + inner::without_inverse<T>(inner::text(mass[k]), "kg"));
    for (int i = 0; i < 3; ++i)
      DELASSUS_EXPECT(inner::has_inverse<T>(inertia[k](i, i)),
                      node + " has a moment of inertia of " +
                          inner::without_inverse<T>(inner::text(inertia[k](i, i)), "kg·m²"));
  }

  const Index k = this->take_body(rod.material);
  Array<Index> blocks;
  for (Index i = 0; i < n; ++i) {
    const Index b = this->take_node(rod, k, i, twist<T>(converted<T>(rod.velocity), Vec<3, T>::Zero()));
    const std::size_t size = std::size_t(slots_.size());
    state_.resize(size);
    radius_.resize(size), next_.resize(size);
    state_.mass[b] = T(mass[i]);
    state_.inertia[b] = converted<T>(inertia[i]);
    const double scale = inertia[i].trace();
    state_.inverse_inertia[b] = converted<T>(1 / scale * inverse(Mat3(1 / scale * inertia[i])));
    state_.place(b, points[i], frames[std::min(i, n - 2)]);
    radius_[b] = rod.contact_radius;
    next_[b] = -1;
    if (i > 0) next_[blocks.back()] = b;
    blocks.push_back(b);
  }
  return this->give(k, inner::ElasticLine<T>(rod, points, frames, std::move(blocks)));
}

template <class T>
Anchor BasicRods<T>::anchor_at(BodyHandle rod, const Vec3& point) const {
  Anchor anchor{.has_frame = false, .owner = this->owner()};
  double nearest = -1;
  for (const Index b : bodies_[checked_body(rod)].blocks()) {
    if (next_[b] < 0) continue;
    const double share = nearest_share(b, point), away = (on_segment(b, share) - point).norm();
    if (nearest >= 0 && !(away < nearest)) continue;
    nearest = away;
    anchor.block = anchor.element = b;
    anchor.local = {share, 0, 0};
  }
  DELASSUS_EXPECT(nearest >= 0 && nearest <= 0.1 * chord(anchor.block).norm(),
                  "anchor_at: the point " + inner::text(point) + " m is not on " +
                      body_name(rod.index) + ", whose line passes " + inner::text(nearest) +
                      " m from it");
  anchor.generation = slots_.generation(anchor.block);
  return anchor;
}

}  // namespace delassus

#include <delassus/fem/rod_invariants.hpp>  // its energy and momentum
#include <span>
