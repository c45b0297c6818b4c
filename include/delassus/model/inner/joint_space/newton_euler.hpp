/// Forces of the joints of a tree from its accelerations: the recursive Newton-Euler algorithm.
#pragma once

#include <delassus/model/inner/joint_space/passive.hpp>

namespace delassus::inner::tree {

/// The share of a node's acceleration that its rates alone make: v × S q̇ + Ṡ q̇. Only the axes of a free joint
/// turn in its own frame, by −ω, and they are those of the world.
inline Vec<6> rate_of_axes(const Tree& tree, std::size_t i, const double* v) {
  const Node& node = tree.nodes[i];
  if (node.kind == JointKind::free)
    return twist<double>(-cross(angular_part(tree.velocity[i]), linear_part(tree.velocity[i])), zero<Vec3>());
  return node.parent < 0 ? zero<Vec<6>>() : cross_motion(tree.velocity[i], tree.along(node, v));
}

/// τ = H q̈ + C − what acts without a motor, from the world outwards and back:
///
///   a = X a_parent + S q̈ + v × S q̇ + Ṡ q̇,   f = I a + v ×* I v + Σ Xᵀ f_child,   τ = Sᵀ f.
///
/// After `place` and `move`. `a` may be null, for none, and τ the same memory. Source: [Featherstone2008],
/// chapter 5.
inline void newton_euler(Tree& tree, std::span<const double> q, const double* v, const double* a,
                         TreeForces acting, std::span<double> tau) {
  const Vec<6> of_world = acceleration_of_world(tree, acting);
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const Node& node = tree.nodes[i];
    const Vec<6>& velocity = tree.velocity[i];
    Vec<6>& acceleration = tree.acceleration[i];
    acceleration =
        motion_into(tree.local[i], node.parent < 0 ? of_world : tree.acceleration[std::size_t(node.parent)]);
    acceleration += rate_of_axes(tree, i, v);
    if (a) acceleration += tree.along(node, a);
    tree.force[i] =
        node.inertia * acceleration + cross_force(velocity, node.inertia * velocity) - lift(tree, i, acting);
  }
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {
    const Node& node = tree.nodes[i];
    for (Index k = node.v; k < node.v + v_count(node.kind); ++k)
      tau[std::size_t(k)] =
          dot(tree.S[std::size_t(k)], tree.force[i]) + (a ? armature(node, acting) * a[k] : 0.0);
    if (node.parent >= 0) tree.force[std::size_t(node.parent)] += force_out_of(tree.local[i], tree.force[i]);
  }
  add_passive(tree, q, v, acting, -1, tau);
}

}  // namespace delassus::inner::tree
