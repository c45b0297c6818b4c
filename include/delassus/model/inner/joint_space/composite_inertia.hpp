/// The mass matrix of a tree in its joints: the composite-rigid-body algorithm.
#pragma once

#include <delassus/model/inner/joint_space/passive.hpp>

namespace delassus::inner::tree {

/// H_ij = S_iᵀ X* I S_j for i on the way from j to the world, I being what moves with j as if it were one
/// body; zero for joints of two branches. Row by row, with both halves. After `place`. Source:
/// [Featherstone2008], chapter 6.
inline void composite_inertia(Tree& tree, TreeForces acting, std::span<double> H) {
  const std::size_t n = std::size_t(tree.v_size);
  for (double& entry : H) entry = 0;
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) tree.composite[i] = tree.nodes[i].inertia;
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {
    const Node& node = tree.nodes[i];
    for (Index j = node.v; j < node.v + v_count(node.kind); ++j) {
      Vec<6> force = tree.composite[i] * tree.S[std::size_t(j)];
      for (Index at = Index(i); at >= 0;) {
        const Node& other = tree.nodes[std::size_t(at)];
        for (Index k = other.v; k < other.v + v_count(other.kind); ++k)
          H[std::size_t(j) * n + std::size_t(k)] = H[std::size_t(k) * n + std::size_t(j)] =
              dot(tree.S[std::size_t(k)], force);
        force = force_out_of(tree.local[std::size_t(at)], force);
        at = other.parent;
      }
      H[std::size_t(j) * (n + 1)] += armature(node, acting);
    }
    if (node.parent >= 0)
      tree.composite[std::size_t(node.parent)] += inertia_out_of(tree.local[i], tree.composite[i]);
  }
}

}  // namespace delassus::inner::tree
