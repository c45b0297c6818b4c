/// Which links of a URDF become one body: massless ones go to the heavy link to which a fixed joint holds
/// them.
#pragma once

#include <delassus/adapters/urdf/urdfdom.hpp>
#include <delassus/math/pose.hpp>
#include <delassus/math/rotation.hpp>

#include <string>
#include <vector>

namespace delassus::inner::urdf_file {

inline Vec3 vector_of(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }
inline Pose pose_of(const urdf::Pose& p) {
  return {vector_of(p.position),
          rotation_matrix(Quat(p.rotation.w, p.rotation.x, p.rotation.y, p.rotation.z))};
}
/// b, given in the frame of a, in the frame in which a is given.
inline Pose product(const Pose& a, const Pose& b) {
  return {a.to_world(b.position), a.rotation * b.rotation};
}

/// The links by groups: each has one heavy link, whose frame is the body's, or is the world. A massless link
/// goes to its parent where it can, else to the first of its children where it can.
class Groups {
 public:
  static constexpr Index world = -1, none = -2;

  Groups(const Robot& robot, const Reading& reading, const Source& in, Base base)
      : robot_(robot), reading_(reading), heavy_(robot.links.size(), none), frame_(robot.links.size()) {
    const Index root = robot.order[0];
    const bool is_named_world = robot.link(root).name == "world";
    for (const Index i : robot.order)
      if (mass_of(i) > 0) heavy_[std::size_t(i)] = i;
    if (is_named_world && mass_of(root) == 0 && base != Base::free) heavy_[std::size_t(root)] = world;
    join_parents();
    join_children();
    is_fixed_ = base == Base::fixed || (base == Base::as_file && (is_named_world || heavy(root) == none));
    if (heavy(root) == none) {
      if (!is_fixed_)
        in.refuse_at(robot.link(root).line,
                     "the root '" + robot.link(root).name +
                         "' has no mass and is fixed to nothing that has, so it cannot be free; "
                         "give it mass, or ask for Base::fixed");
      heavy_[std::size_t(root)] = world;
    }
    join_parents();
    for (const Index i : robot.order)
      if (heavy(i) == none)
        in.refuse_at(robot.link(i).line,
                     "link '" + robot.link(i).name +
                         "' has no mass, and no fixed joint holds it to a link that has; give it mass");
    find_frames();
  }

  double mass_of(Index link) const {
    return reading_.link(link).inertial ? reading_.link(link).inertial->mass : 0;
  }
  /// The link of its group that has mass, or `world`.
  Index heavy(Index link) const { return heavy_[std::size_t(link)]; }
  /// Of a link, in that of its group's heavy one; of the world, in the root's.
  const Pose& frame(Index link) const { return frame_[std::size_t(link)]; }
  bool is_fixed() const { return is_fixed_; }
  /// Whether the link is the one of its group by which it hangs on another, or the root.
  bool is_head(Index link) const {
    const Index j = robot_.link(link).joint;
    return j < 0 || heavy(robot_.joint(j).parent) != heavy(link);
  }
  Pose origin(Index joint) const { return pose_of(reading_.joint(joint).parent_to_joint_origin_transform); }

 private:
  bool is_held(Index joint) const { return reading_.joint(joint).type == urdf::Joint::FIXED; }

  void join_parents() {
    for (const Index i : robot_.order) {
      const Index j = robot_.link(i).joint;
      if (heavy(i) == none && j >= 0 && is_held(j)) heavy_[std::size_t(i)] = heavy(robot_.joint(j).parent);
    }
  }
  void join_children() {
    for (std::size_t k = robot_.order.size(); k-- > 0;) {
      const Index i = robot_.order[k];
      for (const Index j : robot_.link(i).child_joints)
        if (heavy(i) == none && is_held(j)) heavy_[std::size_t(i)] = heavy(robot_.joint(j).child);
    }
  }
  /// First in the frame of the head, from which the links of a group hang, and then in that of the heavy
  /// link.
  void find_frames() {
    for (const Index i : robot_.order)
      if (!is_head(i))
        frame_[std::size_t(i)] =
            product(frame(robot_.joint(robot_.link(i).joint).parent), origin(robot_.link(i).joint));
    std::vector<Pose> heavy_frame = frame_;
    for (const Index i : robot_.order)
      if (heavy(i) >= 0)
        frame_[std::size_t(i)] = heavy_frame[std::size_t(heavy(i))].to_local(heavy_frame[std::size_t(i)]);
  }

  const Robot& robot_;
  const Reading& reading_;
  std::vector<Index> heavy_;
  std::vector<Pose> frame_;
  bool is_fixed_ = false;
};

}  // namespace delassus::inner::urdf_file
