/// q and q̇ of the joints of one body from the poses and velocities of that body and its parent.
#pragma once

#include <delassus/model/inner/joint_space/least_squares.hpp>

#include <array>
#include <numbers>

namespace delassus {

/// How far a body is from where its joints can take it: its origin, m, and its axes, rad.
struct JointGap {
  double distance = 0, angle = 0;
};

namespace inner::tree {

/// The same turn as the last one, or as its opposite, whichever is nearer.
inline void store_near(const Mat3& R, double* q) {
  Quat now(R);
  const Quat last(q[0], q[1], q[2], q[3]);
  if (now.coeffs().dot(last.coeffs()) < 0) now.coeffs() = -now.coeffs();
  store(unit(now), q);
}

/// An angle with the turns that bring it nearest to the last one.
inline double near(double angle, double last) {
  const double turn = 2 * std::numbers::pi;
  return angle + turn * std::round((last - angle) / turn);
}

/// Where a body should be yet, seen from where its joints have it now: a step along its own axes.
inline Vec<6> step_to(const Tree& tree, const Place& body, std::span<const double> q, const Pose& goal) {
  Pose reached;
  for (Index i = body.first; i < body.last; ++i) {
    const Node& node = tree.nodes[std::size_t(i)];
    reached = composed(reached, moved(node, &q[std::size_t(node.q)]));
  }
  const Pose left = reached.to_local(goal);
  return twist<double>(left.position, logarithm(Quat(left.rotation)));
}

/// q ⊕ share · x of the joints of one body; x by the freedoms of that body.
inline void turn_by(const Tree& tree, const Place& body, const Vec<6>& x, double share, std::span<double> q) {
  Index k = 0;
  for (Index i = body.first; i < body.last; ++i) {
    const Node& node = tree.nodes[std::size_t(i)];
    double* const to = &q[std::size_t(node.q)];
    if (node.kind == JointKind::ball)
      store(unit(turn_at(to) * exponential<double>(share * Vec3(x[k], x[k + 1], x[k + 2]))), to);
    else
      to[0] += share * x[k];
    k += v_count(node.kind);
  }
}

/// The numbers of the joints of one body, to go back to: six freedoms have eight at most.
struct Saved {
  std::array<double, 8> numbers{};

  Saved(const Tree& tree, const Place& body, std::span<const double> q) {
    Index n = 0;
    for (Index i = body.first; i < body.last; ++i)
      for (Index k = 0; k < q_count(tree.nodes[std::size_t(i)].kind); ++k)
        numbers[std::size_t(n++)] = q[std::size_t(tree.nodes[std::size_t(i)].q + k)];
  }
  void restore(const Tree& tree, const Place& body, std::span<double> q) const {
    Index n = 0;
    for (Index i = body.first; i < body.last; ++i)
      for (Index k = 0; k < q_count(tree.nodes[std::size_t(i)].kind); ++k)
        q[std::size_t(tree.nodes[std::size_t(i)].q + k)] = numbers[std::size_t(n++)];
  }
};

/// Whether a step turns a joint by more than half a turn: near a pose in which two hinges are parallel it could be any number of turns.
inline bool is_wild(const Tree& tree, const Place& body, const Vec<6>& x) {
  Index k = 0;
  for (Index i = body.first; i < body.last; ++i)
    for (Index j = v_count(tree.nodes[std::size_t(i)].kind); j > 0; --j, ++k)
      if (tree.nodes[std::size_t(i)].kind != JointKind::slide && !(std::abs(x[k]) <= std::numbers::pi)) return true;
  return false;
}

/// Gauss-Newton from the last q, with steps that are halved until they lead nearer, and that of Levenberg and Marquardt where a step
/// is wild.
inline void solve_along_axes(const Tree& tree, const Place& body, const Pose& goal, std::span<double> q) {
  Vec<6> left = step_to(tree, body, q, goal);
  for (int iteration = 0; iteration < 50; ++iteration) {
    const Axes axes = axes_of(tree, body, q);
    Vec<6> x = nearest_rates(axes, left);
    if (is_wild(tree, body, x)) x = nearest_rates(axes, left, squared_norm(left));
    const Saved saved(tree, body, q);
    double share = 1;
    for (int halving = 0; halving < 12; ++halving, share /= 2) {
      turn_by(tree, body, x, share, q);
      const Vec<6> trial = step_to(tree, body, q, goal);
      if (squared_norm(trial) < squared_norm(left)) {
        left = trial;
        share = 0;
        break;
      }
      saved.restore(tree, body, q);
    }
    if (share > 0) return;
  }
}

/// A joint that is alone has its q in closed form; `goal` is where the body is, seen from where it is at its
/// reference.
inline void solve_alone(const Node& node, const Pose& goal, double* q) {
  switch (node.kind) {
    case JointKind::slide:
      q[0] = node.reference + dot(node.axis, goal.position);
      return;
    case JointKind::hinge: {
      const Quat turn(goal.rotation);
      const double sine = dot(node.axis, Vec3(turn.x(), turn.y(), turn.z()));
      q[0] = near(node.reference + 2 * std::atan2(sine, turn.w()), q[0]);
      return;
    }
    case JointKind::ball:
      store_near(goal.rotation, q);
      return;
    case JointKind::free:
      break;
  }
  store(goal.position, q);
  store_near(goal.rotation, q + 3);
}

/// Writes the numbers of the joints of `body` to q, which has the last ones.
inline JointGap read_q(const Tree& tree, const Place& body, const Pose& parent, const Pose& pose,
                       std::span<double> q) {
  const bool is_free = body.first < body.last && tree.nodes[std::size_t(body.first)].kind == JointKind::free;
  const Pose goal = is_free ? pose : composed(parent, body.frame).to_local(pose);
  if (body.last - body.first == 1) {
    const Node& node = tree.nodes[std::size_t(body.first)];
    solve_alone(node, goal, &q[std::size_t(node.q)]);
  } else if (body.first < body.last) {
    solve_along_axes(tree, body, goal, q);
  }
  const Vec<6> left = step_to(tree, body, q, goal);
  return {norm(linear_part(left)), norm(angular_part(left))};
}

/// Writes the rates of the joints of `body` to v. Velocities are those of origins along the axes of the
/// world.
inline void read_v(const Tree& tree, const Place& body, std::span<const double> q, const Pose& parent,
                   const Pose& pose, const Vec<6>& parent_velocity, const Vec<6>& velocity,
                   std::span<double> v) {
  if (body.first == body.last) return;
  const Node& first = tree.nodes[std::size_t(body.first)];
  double* const to = &v[std::size_t(first.v)];
  const Vec3 turning = angular_part(velocity) - angular_part(parent_velocity);
  if (first.kind == JointKind::free) {
    store(linear_part(velocity), to);
    store(Vec3(transposed_times(pose.rotation, angular_part(velocity))), to + 3);
    return;
  }
  const Vec3 carried =
      linear_part(parent_velocity) + cross(angular_part(parent_velocity), pose.position - parent.position);
  const Vec3 linear = transposed_times(pose.rotation, linear_part(velocity) - carried);
  const Vec3 angular = transposed_times(pose.rotation, turning);
  if (body.last - body.first == 1) {
    if (first.kind == JointKind::ball)
      store(angular, to);
    else
      to[0] = dot(first.axis, first.kind == JointKind::slide ? linear : angular);
    return;
  }
  const Vec<6> x = nearest_rates(axes_of(tree, body, q), twist<double>(linear, angular));
  Index k = 0;
  for (Index i = body.first; i < body.last; ++i) {
    const Node& node = tree.nodes[std::size_t(i)];
    for (Index j = 0; j < v_count(node.kind); ++j) v[std::size_t(node.v + j)] = x[k++];
  }
}

}  // namespace inner::tree
}  // namespace delassus
