/// Poses and velocities of the frames of a tree, and the Jacobian of a point.
#pragma once

#include <delassus/math/rotation.hpp>
#include <delassus/model/inner/joint_space/tree.hpp>

#include <span>

namespace delassus::inner::tree {

inline Vec3 vector_at(const double* x) { return {x[0], x[1], x[2]}; }
inline Quat turn_at(const double* x) { return unit(Quat(x[0], x[1], x[2], x[3])); }
inline void store(const Vec3& v, double* to) {
  for (int k = 0; k < 3; ++k) to[k] = v[k];
}
inline void store(const Quat& q, double* to) { to[0] = q.w(), to[1] = q.x(), to[2] = q.y(), to[3] = q.z(); }

/// Where a joint takes its frame from where it is at its reference, q being its own numbers. Of a free one:
/// in the world.
inline Pose moved(const Node& node, const double* q) {
  const auto about = [&](const Mat3& R) { return Pose{node.point - R * node.point, R}; };
  switch (node.kind) {
    case JointKind::slide:
      return {(q[0] - node.reference) * node.axis, identity<Mat3>()};
    case JointKind::hinge:
      return about(rotation_matrix(exponential<double>((q[0] - node.reference) * node.axis)));
    case JointKind::ball:
      return about(rotation_matrix(turn_at(q)));
    case JointKind::free:
      break;
  }
  return {vector_at(q), rotation_matrix(turn_at(q + 3))};
}

/// Writes `local`, `world` and the axes of free joints.
inline void place(Tree& tree, std::span<const double> q) {
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const Node& node = tree.nodes[i];
    const Pose by_joint = moved(node, &q[std::size_t(node.q)]);
    tree.local[i] = node.kind == JointKind::free ? by_joint : composed(node.frame, by_joint);
    tree.world[i] =
        node.parent < 0 ? tree.local[i] : composed(tree.world[std::size_t(node.parent)], tree.local[i]);
    if (node.kind == JointKind::free)  // linear velocities along the axes of the world
      for (int k = 0; k < 3; ++k)
        tree.S[std::size_t(node.v + k)] =
            twist<double>(transposed_times(by_joint.rotation, unit_axis(k)), zero<Vec3>());
  }
}

/// Writes `velocity`: v_i = X v_parent + S q̇, in the axes of each frame. After `place`.
inline void move(Tree& tree, std::span<const double> v) {
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const Node& node = tree.nodes[i];
    tree.velocity[i] = tree.along(node, v.data());
    if (node.parent >= 0)
      tree.velocity[i] += motion_into(tree.local[i], tree.velocity[std::size_t(node.parent)]);
  }
}

inline Pose pose_of(const Tree& tree, const Place& body) {
  return body.node < 0 ? body.pose : composed(tree.world[std::size_t(body.node)], body.pose);
}

/// Of the origin of a body's frame, along the axes of the world. After `move`.
inline Vec<6> velocity_of(const Tree& tree, const Place& body) {
  if (body.node < 0) return zero<Vec<6>>();
  const Vec<6>& v = tree.velocity[std::size_t(body.node)];
  const Mat3& R = tree.world[std::size_t(body.node)].rotation;
  const Vec3 w = angular_part(v);
  return twist<double>(R * (linear_part(v) + cross(w, body.pose.position)), R * w);
}

/// A column for each freedom: how the point x of the world moves with the body if that freedom has the
/// rate 1. After `place`.
inline void jacobian(const Tree& tree, const Place& body, const Vec3& x, std::span<Vec<6>> columns) {
  for (Vec<6>& column : columns) set_zero(column);
  for (Index n = body.node; n >= 0; n = tree.nodes[std::size_t(n)].parent) {
    const Node& node = tree.nodes[std::size_t(n)];
    const Pose& frame = tree.world[std::size_t(n)];
    for (Index k = node.v; k < node.v + v_count(node.kind); ++k) {
      const Vec<6>& S = tree.S[std::size_t(k)];
      const Vec3 w = frame.rotation * angular_part(S);
      columns[std::size_t(k)] =
          twist<double>(frame.rotation * linear_part(S) + cross(w, x - frame.position), w);
    }
  }
}

}  // namespace delassus::inner::tree
