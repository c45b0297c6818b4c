/// Accelerations of the joints of a tree from their forces: the articulated-body algorithm.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/model/inner/joint_space/newton_euler.hpp>

#include <limits>

namespace delassus::inner::tree {

/// Σ |S_i| |I_ij| |S_j|: what SᵀI S is a difference of. Below its rounding there is nothing that the freedom
/// moves.
inline double largest_inertia(const ArticulatedInertia& I, const Vec<6>& S) {
  double sum = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      sum += std::abs(S[i] * I.linear(i, j) * S[j]) + 2 * std::abs(S[i] * I.mixed(i, j) * S[3 + j]) +
             std::abs(S[3 + i] * I.angular(i, j) * S[3 + j]);
  return sum;
}

/// Takes one freedom out of the equation force = I a + p of its frame:
///
///   U = I S,  D = Sᵀ U,  u = τ − Sᵀ p,   I ← I − U Uᵀ / D,   p ← p + U u / D.
inline void eliminate(Tree& tree, const Node& node, Index k, double force, double rotor,
                      ArticulatedInertia& I, Vec<6>& p) {
  const Vec<6>& S = tree.S[std::size_t(k)];
  const Vec<6> U = I * S;
  const double D = dot(S, U) + rotor, u = force - dot(S, p);
  DELASSUS_EXPECT(
      D > 64 * std::numeric_limits<double>::epsilon() * (largest_inertia(I, S) + rotor),
      "joint space of '" + tree.name + "': in this q " + node.name +
          " moves nothing that has inertia, or the same as other joints of its body; give it armature");
  I.subtract(U, D);
  p += U * (u / D);
  tree.U[std::size_t(k)] = U;
  tree.D[std::size_t(k)] = D;
  tree.u[std::size_t(k)] = u;
}

/// q̈ from the forces `total` of motors, springs and dampers. The freedoms of a joint are taken out one after
/// another, so that none needs a matrix to be inverted. After `place` and `move`. Source: [Featherstone2008],
/// chapter 7.
inline void articulated_body(Tree& tree, const double* v, TreeForces acting, std::span<const double> total,
                             std::span<double> a) {
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    tree.articulated[i] = ArticulatedInertia::of(tree.nodes[i].inertia);
    tree.force[i] =
        cross_force(tree.velocity[i], tree.nodes[i].inertia * tree.velocity[i]) - lift(tree, i, acting);
    tree.acceleration[i] = rate_of_axes(tree, i, v);
  }
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {
    const Node& node = tree.nodes[i];
    for (Index k = node.v + v_count(node.kind); k-- > node.v;)
      eliminate(tree, node, k, total[std::size_t(k)], armature(node, acting), tree.articulated[i],
                tree.force[i]);
    if (node.parent < 0) continue;
    const Vec<6> p = tree.force[i] + tree.articulated[i] * tree.acceleration[i];
    tree.articulated[std::size_t(node.parent)] += inertia_out_of(tree.local[i], tree.articulated[i]);
    tree.force[std::size_t(node.parent)] += force_out_of(tree.local[i], p);
  }
  const Vec<6> of_world = acceleration_of_world(tree, acting);
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const Node& node = tree.nodes[i];
    Vec<6>& acceleration = tree.acceleration[i];
    acceleration +=
        motion_into(tree.local[i], node.parent < 0 ? of_world : tree.acceleration[std::size_t(node.parent)]);
    for (Index k = node.v; k < node.v + v_count(node.kind); ++k) {
      const double rate =
          (tree.u[std::size_t(k)] - dot(tree.U[std::size_t(k)], acceleration)) / tree.D[std::size_t(k)];
      a[std::size_t(k)] = rate;
      acceleration += tree.S[std::size_t(k)] * rate;
    }
  }
}

}  // namespace delassus::inner::tree
