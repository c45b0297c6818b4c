/// Forces that a model has without a motor: springs and damping of joints, and weight that is taken off.
#pragma once

#include <delassus/model/inner/joint_space/kinematics.hpp>

namespace delassus {

/// What acts in the dynamics of a `JointSpace`; each can be left out.
struct TreeForces {
  bool gravity = true;
  bool gravity_compensation = true;  ///< share of its weight that a body is relieved of
  bool springs = true;               ///< of joints
  bool damping = true;               ///< of joints
  bool armature = true;              ///< inertia of rotors
};

namespace inner::tree {

/// q past the rest of the spring of a node, in the axes of its rates. A ball is at rest at the identity, a
/// free joint where the model has it.
inline void spring_strain(const Node& node, const double* q, double* strain) {
  if (node.kind == JointKind::hinge || node.kind == JointKind::slide)
    strain[0] = q[0] - node.spring_reference;
  if (node.kind == JointKind::ball) store(logarithm(turn_at(q)), strain);
  if (node.kind != JointKind::free) return;
  store(Vec3(vector_at(q) - node.frame.position), strain);
  const Mat3 past = transposed_times(node.frame.rotation, rotation_matrix(turn_at(q + 3)));
  store(logarithm(Quat(past)), strain + 3);
}

/// Adds `share` times the forces of springs and dampers to τ.
inline void add_passive(const Tree& tree, std::span<const double> q, const double* v, TreeForces acting,
                        double share, std::span<double> tau) {
  for (const Node& node : tree.nodes) {
    double* const to = &tau[std::size_t(node.v)];
    if (acting.springs && node.stiffness > 0) {
      double strain[6];
      spring_strain(node, &q[std::size_t(node.q)], strain);
      for (Index k = 0; k < v_count(node.kind); ++k) to[k] -= share * node.stiffness * strain[k];
    }
    if (acting.damping)
      for (Index k = 0; k < v_count(node.kind); ++k) to[k] -= share * node.damping * v[node.v + k];
  }
}

/// The force on a node that takes off its share of weight, in its own frame. After `place`.
inline Vec<6> lift(const Tree& tree, std::size_t i, TreeForces acting) {
  const Node& node = tree.nodes[i];
  if (!acting.gravity_compensation || (node.lifted == 0 && is_zero(node.lifted_moment)))
    return zero<Vec<6>>();
  const Vec3 up = -transposed_times(tree.world[i].rotation, tree.gravity);
  return twist<double>(node.lifted * up, cross(node.lifted_moment, up));
}

/// Weight as an acceleration of the world: what stands in it is pushed up.
inline Vec<6> acceleration_of_world(const Tree& tree, TreeForces acting) {
  return twist<double>(acting.gravity ? Vec3(-tree.gravity) : zero<Vec3>(), zero<Vec3>());
}

inline double armature(const Node& node, TreeForces acting) { return acting.armature ? node.armature : 0; }

/// ½ Σ v·I v. After `move`.
inline double kinetic_energy(const Tree& tree, std::span<const double> v, TreeForces acting) {
  double twice = 0;
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const Node& node = tree.nodes[i];
    twice += dot(tree.velocity[i], node.inertia * tree.velocity[i]);
    for (Index k = node.v; k < node.v + v_count(node.kind); ++k)
      twice += armature(node, acting) * v[std::size_t(k)] * v[std::size_t(k)];
  }
  return twice / 2;
}

/// −Σ g·m x less the share that is taken off, and ½ k s² of the springs. After `place`.
inline double potential_energy(const Tree& tree, std::span<const double> q, TreeForces acting) {
  double sum = 0;
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const Node& node = tree.nodes[i];
    const auto height = [&](double mass, const Vec3& moment) {
      return -dot(tree.gravity, mass * tree.world[i].position + tree.world[i].rotation * moment);
    };
    if (acting.gravity) sum += height(node.inertia.mass, node.inertia.moment);
    if (acting.gravity_compensation) sum -= height(node.lifted, node.lifted_moment);
    if (!acting.springs || !(node.stiffness > 0)) continue;
    double strain[6];
    spring_strain(node, &q[std::size_t(node.q)], strain);
    for (Index k = 0; k < v_count(node.kind); ++k) sum += node.stiffness / 2 * strain[k] * strain[k];
  }
  return sum;
}

}  // namespace inner::tree
}  // namespace delassus
