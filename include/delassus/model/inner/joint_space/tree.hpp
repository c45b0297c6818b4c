/// A tree of bodies as its joints: what the algorithms of joint space read, and the room they work in.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/model/inner/joint_space/spatial.hpp>
#include <delassus/model/model.hpp>

#include <string>
#include <vector>

namespace delassus::inner::tree {

using model::JointKind;

constexpr Index q_count(JointKind kind) {
  return kind == JointKind::free ? 7 : kind == JointKind::ball ? 4 : 1;
}
constexpr Index v_count(JointKind kind) {
  return kind == JointKind::free ? 6 : kind == JointKind::ball ? 3 : 1;
}

/// One joint and the frame that it moves: that of its body, before the later joints of the same body move it.
struct Node {
  JointKind kind = JointKind::hinge;
  Index parent = -1;   ///< node, before this one; −1: the world, as for all that are free
  Index q = 0, v = 0;  ///< its first numbers
  Pose frame;          ///< its own in that of the parent, where the joint is at its reference
  Vec3 point, axis;    ///< of the joint, own frame
  double reference = 0, armature = 0, damping = 0, stiffness = 0, spring_reference = 0;
  RigidInertia inertia;  ///< of its body and what is fixed to it; none before the last joint of a body
  double lifted = 0;     ///< share of that mass whose weight is taken off, kg
  Vec3 lifted_moment = zero<Vec3>();
  std::string name;  ///< for sentences
};

/// A body of the model.
struct Place {
  Index node = -1;            ///< that moves it; −1: it stands in the world
  Pose pose;                  ///< in the frame of the node
  Index parent = -1;          ///< body
  Pose frame;                 ///< in that of the parent, where its joints are at their references
  Index first = 0, last = 0;  ///< nodes of its own joints, [first, last)
};

struct Tree {
  std::string name;  ///< of the model
  Vec3 gravity = zero<Vec3>();
  Index q_size = 0, v_size = 0;
  std::vector<Node> nodes;      ///< parents first
  std::vector<Place> bodies;    ///< as in the model
  std::vector<Index> of_joint;  ///< node of a joint of the model; −1: it is held
  std::vector<std::string> body_names;

  // What an evaluation writes and the next one overwrites, by nodes and, the last four, by freedoms.
  std::vector<Pose> local, world;  ///< in the parent, in the world
  std::vector<Vec<6>> velocity, acceleration, force;
  std::vector<RigidInertia> composite;
  std::vector<ArticulatedInertia> articulated;
  std::vector<Vec<6>> S, U;  ///< axes of the joints in their own frames, and inertia times axis
  std::vector<double> D, u;

  void make_room() {
    const std::size_t n = nodes.size(), m = std::size_t(v_size);
    local.resize(n), world.resize(n);
    velocity.resize(n), acceleration.resize(n), force.resize(n);
    composite.resize(n), articulated.resize(n);
    S.resize(m, zero<Vec<6>>()), U.resize(m);
    D.resize(m), u.resize(m);
  }
  /// Σ S_k x_k over the freedoms of a node.
  Vec<6> along(const Node& node, const double* x) const {
    Vec<6> sum = zero<Vec<6>>();
    for (Index k = 0; k < v_count(node.kind); ++k) sum += S[std::size_t(node.v + k)] * x[node.v + k];
    return sum;
  }
};

}  // namespace delassus::inner::tree
