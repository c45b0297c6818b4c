/// The description of a robot from its links, its joints and the groups that they make.
#pragma once

#include <delassus/adapters/urdf/groups.hpp>
#include <delassus/adapters/urdf/joints.hpp>
#include <delassus/adapters/urdf/meshes.hpp>
#include <delassus/bodies/body_input.hpp>

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace delassus::inner::urdf_file {

class Builder {
 public:
  Builder(Source& in, const Robot& robot, const Reading& reading, const UrdfOptions& options,
          std::string folder)
      : in_(in),
        robot_(robot),
        reading_(reading),
        groups_(robot, reading, in, options.base),
        meshes_(model_, options, std::move(folder)) {}

  Model made() {
    model_.name = robot_.name;
    for (const LinkElement& link : robot_.links) check_inertial(link);
    body_of_.assign(robot_.links.size(), -1);
    joint_of_.assign(robot_.joints.size(), -1);
    for (const Index i : robot_.order)
      if (groups_.is_head(i) && groups_.heavy(i) >= 0) add_body(i);
    for (const Index i : robot_.order) {
      if (groups_.heavy(i) != i) add_site(i);
      for (std::size_t k = 0; k < robot_.link(i).collisions.size(); ++k) add_geometry(i, k);
    }
    for (Index j = 0; j < Index(robot_.joints.size()); ++j) add_mimic(j);
    return std::move(model_);
  }

 private:
  Index body_of(Index link) const {
    return groups_.heavy(link) < 0 ? -1 : body_of_[std::size_t(groups_.heavy(link))];
  }

  static Mat3 inertia_of(const urdf::Inertial& i) {
    Mat3 I;
    I << i.ixx, i.ixy, i.ixz, i.ixy, i.iyy, i.iyz, i.ixz, i.iyz, i.izz;
    return I;
  }

  void check_inertial(const LinkElement& link) {
    const urdf::Link& read = reading_.link(Index(&link - robot_.links.data()));
    if (!read.inertial) return;
    const Mat3 I = inertia_of(*read.inertial);
    if (read.inertial->mass < 0)
      in_.refuse_at(link.line, "the mass of link '" + link.name + "' is " + text(read.inertial->mass) +
                                   " kg and must be >= 0");
    if (read.inertial->mass == 0) {
      if (!is_zero(I) && link.joint >= 0)
        in_.skip(link.line, "the inertia of link '" + link.name + "', which has no mass");
      return;
    }
    try {
      check_inertia(I, "link '" + link.name + "'");
    } catch (const InvalidArgument& refused) {
      const std::string sentence = refused.what();
      in_.skip(link.line, sentence.substr(std::string("delassus: ").size()) + "; it is kept as it stands");
    }
  }

  /// The body of the group that hangs on the rest by the link `head`.
  void add_body(Index head) {
    const Index heavy = groups_.heavy(head), j = robot_.link(head).joint;
    const urdf::Inertial& inertial = *reading_.link(heavy).inertial;
    const Pose centre = pose_of(inertial.origin);
    const Pose to_heavy = groups_.frame(head).to_local(Pose{});  // the heavy link's frame in that of the head
    model::Body body{
        .name = robot_.link(heavy).name, .pose = to_heavy, .mass = inertial.mass, .centre = centre.position};
    body.inertia = centre.rotation * inertia_of(inertial) * transposed(centre.rotation);
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < r; ++c)
        body.inertia(c, r) = body.inertia(r, c) = 0.5 * (body.inertia(r, c) + body.inertia(c, r));
    if (j >= 0) {
      const Index parent = robot_.joint(j).parent;
      body.parent = body_of(parent);
      body.pose = product(product(groups_.frame(parent), groups_.origin(j)), to_heavy);
      for (model::Joint& joint : joints_of(in_, robot_.joint(j), reading_.joint(j), groups_.frame(head)))
        add_joint(body, std::move(joint), j);
    } else if (!groups_.is_fixed()) {
      add_joint(body, {.name = robot_.link(head).name, .kind = model::JointKind::free}, -1);
    }
    body_of_[std::size_t(heavy)] = Index(model_.bodies.size());
    model_.bodies.push_back(std::move(body));
  }

  void add_joint(model::Body& body, model::Joint joint, Index j) {
    const Index index = Index(model_.joints.size());
    while ((j < 0 || joint.name != robot_.joint(j).name) && robot_.joint_called(joint.name) >= 0)
      joint.name += "_";
    if (j >= 0 && joint.name == robot_.joint(j).name && has_one_freedom(joint))
      joint_of_[std::size_t(j)] = index;
    body.joints.push_back(index);
    model_.joints.push_back(std::move(joint));
  }

  void add_site(Index link) {
    model_.sites.push_back(
        {.name = robot_.link(link).name, .body = body_of(link), .pose = groups_.frame(link)});
  }

  void add_geometry(Index link, std::size_t k) {
    const CollisionElement& element = robot_.link(link).collisions[k];
    const urdf::Collision& read = *reading_.link(link).collision_array[k];
    model::Geometry g{.body = body_of(link), .pose = product(groups_.frame(link), pose_of(read.origin))};
    if (!shape_of(element, *read.geometry, g.shape)) return;
    const Touch& touch = robot_.link(link).touch;
    g.friction = touch.friction;
    g.rolling_friction = touch.rolling;
    g.spinning_friction = touch.spinning;
    g.restitution = touch.restitution;
    g.contact_freedoms = touch.rolling > 0 ? 6 : touch.spinning > 0 ? 4 : 3;
    const std::string name = element.name.empty() ? robot_.link(link).name : element.name;
    int& count = geometries_called_[name];
    do g.name = ++count == 1 ? name : name + "_" + std::to_string(count);
    while (!geometry_names_.insert(g.name).second);
    model_.geometries.push_back(std::move(g));
  }

  /// False where there is none to build, and that is named.
  bool shape_of(const CollisionElement& element, const urdf::Geometry& read, model::GeometryShape& to) {
    if (const auto* mesh = dynamic_cast<const urdf::Mesh*>(&read)) {
      const Vec3 scale = vector_of(mesh->scale);
      if (scale[0] == 0 || scale[1] == 0 || scale[2] == 0)
        in_.refuse_at(element.line, "the scale of mesh '" + element.mesh + "' must not be zero");
      const auto [index, reason] = meshes_.find(element.mesh, scale);
      if (index < 0) in_.skip(element.line, "collision mesh '" + element.mesh + "': " + reason);
      to = model::HullOf{index};
      return index >= 0;
    }
    std::vector<double> sizes;
    if (const auto* box = dynamic_cast<const urdf::Box*>(&read)) {
      to = Box{box->dim.x, box->dim.y, box->dim.z};
      sizes = {box->dim.x, box->dim.y, box->dim.z};
    } else if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(&read)) {
      to = Sphere{sphere->radius};
      sizes = {sphere->radius};
    } else {
      const auto& round = dynamic_cast<const urdf::Cylinder&>(read);
      if (element.is_capsule)
        to = Capsule{round.radius, round.length};
      else
        to = Cylinder{round.radius, round.length};
      sizes = {round.radius, round.length};
    }
    for (const double size : sizes)
      if (size < 0)
        in_.refuse_at(element.line, "a size of a collision's shape is " + text(size) + " m and must be > 0");
    for (const double size : sizes)
      if (size == 0) {
        in_.skip(element.line, "a collision whose shape has no volume");
        return false;
      }
    return true;
  }

  void add_mimic(Index j) {
    const JointElement& joint = robot_.joint(j);
    if (joint.mimic_line == 0) return;
    const Index other = robot_.joint_called(joint.mimics);
    if (other < 0)
      in_.refuse_at(joint.mimic_line, "there is no joint '" + joint.mimics.substr(0, 80) + "' to mimic");
    if (other == j) in_.refuse_at(joint.mimic_line, "joint '" + joint.name + "' mimics itself");
    if (joint_of_[std::size_t(j)] < 0 || joint_of_[std::size_t(other)] < 0) {
      in_.skip(joint.mimic_line,
               "a mimic between joints that are not both revolute, continuous or prismatic");
      return;
    }
    const urdf::JointMimic& mimic = *reading_.joint(j).mimic;
    model_.couplings.push_back({.name = joint.name,
                                .joint = joint_of_[std::size_t(j)],
                                .other = joint_of_[std::size_t(other)],
                                .coefficients = {mimic.offset, mimic.multiplier, 0, 0, 0}});
  }

  Source& in_;
  const Robot& robot_;
  const Reading& reading_;
  Groups groups_;
  Model model_;
  Meshes meshes_;
  std::vector<Index> body_of_;   ///< of a heavy link
  std::vector<Index> joint_of_;  ///< that can be coupled, of a joint of the file
  std::map<std::string, int> geometries_called_;
  std::set<std::string> geometry_names_;
};

}  // namespace delassus::inner::urdf_file
