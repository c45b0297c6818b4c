/// Whether the numbers that a joint space is asked about will do.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/model/inner/joint_space/tree.hpp>

#include <span>

namespace delassus::inner::tree {

inline std::string of(const Tree& tree) { return "joint space of '" + tree.name + "': "; }

inline void expect_size(const Tree& tree, const char* what, std::size_t size, std::size_t wanted) {
  DELASSUS_EXPECT(size == wanted, of(tree) + what + " has " + std::to_string(size) +
                                      " entries and must have " + std::to_string(wanted));
}

/// So many numbers, all finite.
inline void expect_numbers(const Tree& tree, const char* what, std::span<const double> x, Index wanted) {
  expect_size(tree, what, x.size(), std::size_t(wanted));
  for (std::size_t i = 0; i < x.size(); ++i)
    DELASSUS_EXPECT(std::isfinite(x[i]), of(tree) + what + "[" + std::to_string(i) + "] is not finite");
}

/// Quaternions are of length 1 to 1e-6; they are taken as if they were to the last digit.
inline void expect_q(const Tree& tree, std::span<const double> q) {
  expect_numbers(tree, "q", q, tree.q_size);
  for (const Node& node : tree.nodes) {
    if (v_count(node.kind) == 1) continue;
    const double* const x = &q[std::size_t(node.kind == JointKind::free ? node.q + 3 : node.q)];
    const double length = std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + x[3] * x[3]);
    DELASSUS_EXPECT(std::abs(length - 1) <= 1e-6, of(tree) + "the quaternion of " + node.name +
                                                      " in q has the length " + text(length) +
                                                      " and must have 1");
  }
}

inline const Place& expect_body(const Tree& tree, Index body) {
  DELASSUS_EXPECT(
      body >= 0 && std::size_t(body) < tree.bodies.size(),
      of(tree) + "there is no body " + std::to_string(body) + ", only " + std::to_string(tree.bodies.size()));
  return tree.bodies[std::size_t(body)];
}

inline void expect_pose(const Tree& tree, Index body, const Pose& pose) {
  DELASSUS_EXPECT(is_finite(pose.position) && is_finite(pose.rotation),
                  of(tree) + "the pose of body '" + tree.body_names[std::size_t(body)] + "' is not finite");
}

}  // namespace delassus::inner::tree
