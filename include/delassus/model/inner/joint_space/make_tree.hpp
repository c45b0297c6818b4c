/// The tree of a model: a node for each joint, bodies that are fixed to others joined with them.
#pragma once

#include <delassus/model/check.hpp>
#include <delassus/model/inner/joint_space/tree.hpp>

namespace delassus::inner::tree {

/// Makes one tree.
class TreeMaker {
 public:
  TreeMaker(const Model& model, Base base, const Pose& pose) : model_(model), base_(base), pose_(pose) {
    tree_.name = model.name;
    tree_.gravity = model.gravity;
    tree_.of_joint.assign(model.joints.size(), -1);
  }

  Tree made() {
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) add_body(model_.bodies[b]);
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) add_mass(model_.bodies[b], tree_.bodies[b]);
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) check_mass(model_.bodies[b], tree_.bodies[b]);
    number_joints();
    tree_.make_room();
    for (const Node& node : tree_.nodes) set_axes(node);
    return std::move(tree_);
  }

 private:
  void add_body(const model::Body& body) {
    const bool is_root = body.parent < 0;
    Place place{.parent = body.parent, .frame = is_root ? composed(pose_, body.pose) : body.pose};
    const Place above = is_root ? Place{} : tree_.bodies[std::size_t(body.parent)];
    place.node = above.node;
    place.pose = composed(above.pose, place.frame);
    place.first = Index(tree_.nodes.size());
    for (const Index j : body.joints)
      if (!(is_root && base_ == Base::fixed && model_.joints[std::size_t(j)].kind == JointKind::free)) {
        tree_.of_joint[std::size_t(j)] = Index(tree_.nodes.size());
        const model::Joint& joint = model_.joints[std::size_t(j)];
        add_node(place, joint,
                 joint.name.empty() ? "joint " + std::to_string(j) : "joint '" + joint.name + "'");
      }
    if (is_root && base_ == Base::free && body.joints.empty() && !body.is_kinematic) {
      of_base_.push_back(Index(tree_.nodes.size()));
      add_node(place, {.kind = JointKind::free}, "the free base '" + body.name + "'");
    }
    place.last = Index(tree_.nodes.size());
    Index freedoms = 0;
    for (Index i = place.first; i < place.last; ++i) freedoms += v_count(tree_.nodes[std::size_t(i)].kind);
    DELASSUS_EXPECT(freedoms <= 6, of_model() + "body '" + body.name + "' has " + std::to_string(freedoms) +
                                       " freedoms to its parent; six are what a body can have");
    tree_.bodies.push_back(place);
    tree_.body_names.push_back(body.name);
  }

  /// The joint moves the place from here on.
  void add_node(Place& place, const model::Joint& joint, std::string name) {
    const bool is_free = joint.kind == JointKind::free;
    Node node{.kind = joint.kind, .parent = is_free ? -1 : place.node};
    at_rest_.push_back(in_world(place));
    node.frame = is_free ? at_rest_.back() : place.pose;
    node.point = joint.point;
    node.axis = joint.axis;
    node.reference = joint.reference;
    node.armature = joint.armature;
    node.damping = joint.damping;
    node.stiffness = joint.stiffness;
    node.spring_reference = joint.spring_reference;
    node.name = std::move(name);
    place.node = Index(tree_.nodes.size());
    place.pose = Pose{};
    tree_.nodes.push_back(std::move(node));
  }

  /// Where a place is with all joints at their references.
  Pose in_world(const Place& place) const {
    return place.node < 0 ? place.pose : composed(at_rest_[std::size_t(place.node)], place.pose);
  }

  void add_mass(const model::Body& body, const Place& place) {
    if (place.node < 0) return;
    const Mat3 c = skew(body.centre);
    const RigidInertia own{body.mass, body.mass * body.centre, body.inertia - body.mass * (c * c)};
    const RigidInertia I = inertia_out_of(place.pose, own);
    Node& node = tree_.nodes[std::size_t(place.node)];
    node.inertia += I;
    node.lifted += body.gravity_compensation * I.mass;
    node.lifted_moment += body.gravity_compensation * I.moment;
  }

  void check_mass(const model::Body& body, const Place& place) const {
    DELASSUS_EXPECT(place.first == place.last || tree_.nodes[std::size_t(place.node)].inertia.mass > 0,
                    of_model() + "body '" + body.name +
                        "' moves, and neither it nor what is fixed to it has mass; give it some, or fix it");
  }

  /// First what `base` sets free, then in the order of the model.
  void number_joints() {
    for (const Index n : of_base_) number(tree_.nodes[std::size_t(n)]);
    for (const Index n : tree_.of_joint)
      if (n >= 0) number(tree_.nodes[std::size_t(n)]);
  }
  void number(Node& node) {
    node.q = tree_.q_size, node.v = tree_.v_size;
    tree_.q_size += q_count(node.kind);
    tree_.v_size += v_count(node.kind);
  }

  /// The velocity of the frame's origin and the angular velocity, for a joint whose axis passes `point`.
  /// Those of a free joint turn with it.
  void set_axes(const Node& node) {
    Vec<6>* const S = &tree_.S[std::size_t(node.v)];
    if (node.kind == JointKind::slide) S[0] = twist<double>(node.axis, zero<Vec3>());
    if (node.kind == JointKind::hinge) S[0] = twist<double>(cross(node.point, node.axis), node.axis);
    if (node.kind == JointKind::ball)
      for (int k = 0; k < 3; ++k) S[k] = twist<double>(cross(node.point, unit_axis(k)), unit_axis(k));
    if (node.kind == JointKind::free)
      for (int k = 0; k < 3; ++k) S[3 + k] = twist<double>(zero<Vec3>(), unit_axis(k));
  }

  std::string of_model() const { return "joint space of '" + model_.name + "': "; }

  const Model& model_;
  Base base_;
  Pose pose_;
  Tree tree_;
  std::vector<Pose> at_rest_;   ///< of nodes, in the world
  std::vector<Index> of_base_;  ///< nodes
};

}  // namespace delassus::inner::tree
