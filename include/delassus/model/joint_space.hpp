/// A machine in the numbers of its joints: poses, velocities, Jacobians, forces and accelerations.
#pragma once

#include <delassus/model/inner/joint_space/articulated_body.hpp>
#include <delassus/model/inner/joint_space/composite_inertia.hpp>
#include <delassus/model/inner/joint_space/coordinates.hpp>
#include <delassus/model/inner/joint_space/inputs.hpp>
#include <delassus/model/inner/joint_space/make_tree.hpp>

namespace delassus {

/// The tree of a `Model` as q and q̇ (here v): lists of numbers, those of each joint in the order of
/// `model.joints`.
///
/// - hinge, slide: q is an angle or a way (rad, m), v its rate
/// - ball: q is the unit quaternion w x y z that turns the body against its parent, v the angular velocity
///   against the parent, in the axes that the joint moves
/// - free: q is position and unit quaternion w x y z in the world, whatever the parent; v is the velocity of
///   the origin in the axes of the world, then the angular velocity in those of the body
///
/// τ is the force to v: τ·v is power, in W. So that of a free joint is a force in the axes of the world, and
/// a moment about the body's origin in the axes of the body. These are MuJoCo's qpos, qvel and qfrc.
///
/// Contacts, limits, friction loss, equalities, actuators and tendons are not seen here. What `TreeForces`
/// names acts.
///
/// Results go to lists of the caller, and no call allocates. Wrong sizes, numbers that are not finite and
/// quaternions whose length is not 1 to 1e-6 are refused (InvalidArgument). Calls share room for their work:
/// two threads take two copies. The cost of a call grows linearly with the number of bodies and joints, that
/// of `mass_matrix` with the square. Source: [Featherstone2008].
class JointSpace {
 public:
  /// A model that `check` refuses is refused. `pose` is where the frame of the model is; gravity stays in the
  /// world's axes. Base::fixed holds all that is free at the root. Base::free gives six freedoms to each root
  /// without joints, ahead of all others; it must have mass then.
  explicit JointSpace(const Model& model, Base base = Base::as_file, const Pose& pose = {})
      : tree_((check(model), inner::tree::TreeMaker(model, base, pose).made())) {}

  Index q_size() const { return tree_.q_size; }
  Index v_size() const { return tree_.v_size; }
  /// Where the numbers of a joint of the model begin; −1 of one that `Base::fixed` holds.
  Index q_of(Index joint) const { return joint_node(joint) ? joint_node(joint)->q : -1; }
  Index v_of(Index joint) const { return joint_node(joint) ? joint_node(joint)->v : -1; }

  /// q of the pose that the tree describes.
  void reference(std::span<double> q) const {
    inner::tree::expect_size(tree_, "q", q.size(), std::size_t(q_size()));
    for (const inner::tree::Node& node : tree_.nodes) {
      double* const to = &q[std::size_t(node.q)];
      if (node.kind == model::JointKind::free) {
        inner::tree::store(node.frame.position, to);
        inner::tree::store(unit(Quat(node.frame.rotation)), to + 3);
      } else if (node.kind == model::JointKind::ball) {
        inner::tree::store(Quat(1, 0, 0, 0), to);
      } else {
        to[0] = node.reference;
      }
    }
  }

  /// q ← q ⊕ x: where the rates x lead in 1 s, each joint by itself.
  void advance(std::span<double> q, std::span<const double> x) const {
    inner::tree::expect_q(tree_, q);
    inner::tree::expect_numbers(tree_, "the step", x, v_size());
    for (const inner::tree::Node& node : tree_.nodes) {
      double* to = &q[std::size_t(node.q)];
      const double* by = &x[std::size_t(node.v)];
      const bool is_free = node.kind == model::JointKind::free;
      for (Index k = 0; k < (is_free ? 3 : node.kind == model::JointKind::ball ? 0 : 1); ++k) to[k] += by[k];
      if (is_free) to += 3, by += 3;
      if (is_free || node.kind == model::JointKind::ball)
        inner::tree::store(unit(inner::tree::turn_at(to) * exponential<double>(inner::tree::vector_at(by))),
                           to);
    }
  }

  /// Of each body of the model, in the world.
  void poses(std::span<const double> q, std::span<Pose> to) {
    place(q);
    inner::tree::expect_size(tree_, "the list of poses", to.size(), tree_.bodies.size());
    for (std::size_t b = 0; b < to.size(); ++b) to[b] = inner::tree::pose_of(tree_, tree_.bodies[b]);
  }

  /// Of each body: the velocity of the origin of its frame and the angular velocity (`math/twist.hpp`), in
  /// the world's axes.
  void velocities(std::span<const double> q, std::span<const double> v, std::span<Vec<6>> to) {
    place(q), move(v);
    inner::tree::expect_size(tree_, "the list of velocities", to.size(), tree_.bodies.size());
    for (std::size_t b = 0; b < to.size(); ++b) to[b] = inner::tree::velocity_of(tree_, tree_.bodies[b]);
  }

  /// J as its columns, one for each entry of v: J v is the velocity of the place `point` (in the body's
  /// frame, m) and the angular velocity of the body, in the world's axes. Jᵀ f are the forces of joints that
  /// f makes there.
  void jacobian(std::span<const double> q, Index body, const Vec3& point, std::span<Vec<6>> J) {
    place(q);
    const inner::tree::Place& of = inner::tree::expect_body(tree_, body);
    DELASSUS_EXPECT(is_finite(point), inner::tree::of(tree_) + "the point of a Jacobian is not finite");
    inner::tree::expect_size(tree_, "the list of columns", J.size(), std::size_t(v_size()));
    inner::tree::jacobian(tree_, of, inner::tree::pose_of(tree_, of).to_world(point), J);
  }

  /// τ that motors must give for the acceleration a = v̇. τ may be the list a.
  void inverse_dynamics(std::span<const double> q, std::span<const double> v, std::span<const double> a,
                        std::span<double> tau, TreeForces acting = {}) {
    place(q), move(v);
    inner::tree::expect_numbers(tree_, "a", a, v_size());
    inner::tree::expect_size(tree_, "tau", tau.size(), std::size_t(v_size()));
    inner::tree::newton_euler(tree_, q, v.data(), a.data(), acting, tau);
  }

  /// τ that holds the machine at rest: the inverse dynamics without v and a.
  void gravity_compensation(std::span<const double> q, std::span<double> tau, TreeForces acting = {}) {
    place(q);
    inner::tree::expect_size(tree_, "tau", tau.size(), std::size_t(v_size()));
    for (Vec<6>& velocity : tree_.velocity) set_zero(velocity);
    for (double& none : tree_.u) none = 0;
    acting.damping = false;
    inner::tree::newton_euler(tree_, q, tree_.u.data(), nullptr, acting, tau);
  }

  /// a = v̇ under the forces τ of motors. a may be the list τ. Refused where a freedom moves no inertia: a
  /// point mass on its own axis, or the first and third of three hinges of a body when they are parallel.
  void forward_dynamics(std::span<const double> q, std::span<const double> v, std::span<const double> tau,
                        std::span<double> a, TreeForces acting = {}) {
    place(q), move(v);
    inner::tree::expect_numbers(tree_, "tau", tau, v_size());
    inner::tree::expect_size(tree_, "a", a.size(), std::size_t(v_size()));
    for (std::size_t k = 0; k < a.size(); ++k) a[k] = tau[k];
    inner::tree::add_passive(tree_, q, v.data(), acting, 1, a);
    inner::tree::articulated_body(tree_, v.data(), acting, a, a);
  }

  /// H with v·H v / 2 the kinetic energy, v_size × v_size, symmetric, row by row.
  void mass_matrix(std::span<const double> q, std::span<double> H, TreeForces acting = {}) {
    place(q);
    inner::tree::expect_size(tree_, "the mass matrix", H.size(),
                             std::size_t(v_size()) * std::size_t(v_size()));
    inner::tree::composite_inertia(tree_, acting, H);
  }

  /// J.
  double kinetic_energy(std::span<const double> q, std::span<const double> v, TreeForces acting = {}) {
    place(q), move(v);
    return inner::tree::kinetic_energy(tree_, v, acting);
  }
  /// Of weight, less the share that is taken off, and springs, J; 0 with all centres of mass in the origin of
  /// the world.
  double potential_energy(std::span<const double> q, TreeForces acting = {}) {
    place(q);
    return inner::tree::potential_energy(tree_, q, acting);
  }

  /// Writes to q the numbers of the joints of one body, from its pose and that of its parent (of no account
  /// where that is the world). q has the last ones: an angle is counted on from there by whole turns, a
  /// quaternion keeps its sign. The body may be off what its joints allow; q is then what leads nearest, and
  /// how far off is returned. Joints that are several are solved for together, by Newton's method from the
  /// last q: where they can move the body in the same way, the later ones stay, and from afar it may end
  /// elsewhere, with a gap.
  JointGap read_q(Index body, const Pose& parent, const Pose& pose, std::span<double> q) const {
    const inner::tree::Place& of = inner::tree::expect_body(tree_, body);
    inner::tree::expect_q(tree_, q);
    expect_poses(of, body, parent, pose);
    return inner::tree::read_q(tree_, of, of.parent < 0 ? Pose{} : parent, pose, q);
  }
  /// Writes to v the rates of the joints of one body, from velocities as `velocities` gives them, at poses of
  /// which q was read.
  void read_v(Index body, std::span<const double> q, const Pose& parent, const Pose& pose,
              const Vec<6>& parent_velocity, const Vec<6>& velocity, std::span<double> v) const {
    const inner::tree::Place& of = inner::tree::expect_body(tree_, body);
    inner::tree::expect_q(tree_, q);
    inner::tree::expect_size(tree_, "v", v.size(), std::size_t(v_size()));
    expect_poses(of, body, parent, pose);
    DELASSUS_EXPECT(is_finite(velocity) && (of.parent < 0 || is_finite(parent_velocity)),
                    inner::tree::of(tree_) + "a velocity is not finite");
    inner::tree::read_v(tree_, of, q, of.parent < 0 ? Pose{} : parent, pose,
                        of.parent < 0 ? zero<Vec<6>>() : parent_velocity, velocity, v);
  }

 private:
  const inner::tree::Node* joint_node(Index joint) const {
    DELASSUS_EXPECT(joint >= 0 && std::size_t(joint) < tree_.of_joint.size(),
                    inner::tree::of(tree_) + "there is no joint " + std::to_string(joint) + ", only " +
                        std::to_string(tree_.of_joint.size()));
    const Index node = tree_.of_joint[std::size_t(joint)];
    return node < 0 ? nullptr : &tree_.nodes[std::size_t(node)];
  }
  void expect_poses(const inner::tree::Place& of, Index body, const Pose& parent, const Pose& pose) const {
    if (of.parent >= 0) inner::tree::expect_pose(tree_, of.parent, parent);
    inner::tree::expect_pose(tree_, body, pose);
  }
  void place(std::span<const double> q) {
    inner::tree::expect_q(tree_, q);
    inner::tree::place(tree_, q);
  }
  void move(std::span<const double> v) {
    inner::tree::expect_numbers(tree_, "v", v, v_size());
    inner::tree::move(tree_, v);
  }

  inner::tree::Tree tree_;
};

}  // namespace delassus
