/// Tendons of a machine.
#pragma once

#include <delassus/adapters/mjcf/instances.hpp>

#include <string>
#include <vector>

namespace delassus::inner::mjcf {

inline std::vector<Reference> tendon_references(const Document& document, const Element& e) {
  std::vector<Reference> names;
  document.for_each(e, [&](const Element& part) {
    if (part.name() == "joint") names.push_back({Kind::joint, part.required("joint")});
    if (part.name() == "site") names.push_back({Kind::site, part.required("site")});
    if (part.name() == "geom") names.push_back({Kind::geom, part.required("geom")});
  });
  return names;
}

/// Why a tendon is left out; empty where it is read.
inline std::string beyond_model(const Document& document, const Element& e) {
  std::string why;
  document.for_each(e, [&](const Element& part) {
    if (part.name() == "geom") why = "it wraps around the geom '" + part.text("geom") + "'";
    if (part.name() == "pulley") why = "it has a pulley";
  });
  return why;
}

/// Poses of all bodies in the world with every spring of a hinge or slide at rest.
inline std::vector<Pose> poses_at_rest(const Model& model) {
  std::vector<Pose> poses;
  for (const model::Body& body : model.bodies) {
    Pose pose = body.parent < 0 ? body.pose : product(poses[std::size_t(body.parent)], body.pose);
    for (const Index j : body.joints) {
      const model::Joint& joint = model.joints[std::size_t(j)];
      const double moved = joint.spring_reference - joint.reference;
      const Vec3 anchor = pose.to_world(joint.point);
      if (joint.kind == model::JointKind::slide) pose.position += pose.rotation * Vec3(moved * joint.axis);
      if (joint.kind != model::JointKind::hinge) continue;
      pose.rotation = pose.rotation * rotation_matrix(exponential<double>(moved * joint.axis));
      pose.position = anchor - pose.rotation * joint.point;
    }
    poses.push_back(pose);
  }
  return poses;
}

/// Length with the springs of all joints at rest. Pre: `poses` are those of the bodies then.
inline double length_at_rest(const Model& model, const std::vector<Pose>& poses, const model::Tendon& t) {
  double length = 0;
  for (const model::TendonJoint& j : t.joints)
    length += j.coefficient * model.joints[std::size_t(j.joint)].spring_reference;
  Vec3 last = zero<Vec3>();
  for (std::size_t i = 0; i < t.sites.size(); ++i) {
    const model::Site& site = model.sites[std::size_t(t.sites[i])];
    const Vec3 at = site.pose.position,
               here = site.body < 0 ? at : poses[std::size_t(site.body)].to_world(at);
    if (i > 0) length += norm(Vec3(here - last));
    last = here;
  }
  return length;
}

inline void read_path(const Reading& r, const Instance& in, model::Tendon& t) {
  in.source->document->for_each(in.element, [&](const Element& part) {
    if (part.name() == "joint") {
      const Index joint = r.names.find({Kind::joint, part.text("joint")}, in.scope);
      const auto kind = r.model.joints[std::size_t(joint)].kind;
      if (kind != model::JointKind::hinge && kind != model::JointKind::slide)
        part.refuse("a fixed tendon takes hinges and slides alone");
      double coefficient = 0;
      if (!part.read("coef", coefficient)) part.refuse("the joint of a tendon needs a coef");
      t.joints.push_back({joint, coefficient});
    } else {
      const Index site = r.names.find({Kind::site, part.text("site")}, in.scope);
      if (!t.sites.empty() && t.sites.back() == site)
        part.refuse("the path of the tendon names a site twice in a row");
      t.sites.push_back(site);
    }
  });
  if (t.joints.empty() && t.sites.size() < 2)
    in.element.refuse("the path of a tendon needs two sites or a joint");
}

inline void read_tendons(Reading& r) {
  const std::vector<Pose> poses = poses_at_rest(r.model);
  for (const Instance& in : instances(r, "tendon", tendon_references)) {
    const Element& e = in.element;
    if (const std::string why = beyond_model(*in.source->document, e); !why.empty()) {
      r.skipped.add(e, "the tendon '" + in.name(r) + "' is left out: " + why);
      r.names.add(e, Kind::tendon, in.scope, Names::left_out, r.budget);
      continue;
    }
    TendonSpec s = in.source->classes.of(e, "class", in.source->classes.main()).tendon;
    read(e, s, r.skipped);
    model::Tendon t;
    read_path(r, in, t);
    if ((t.is_limited = holds(e, in.source->compiler, s.limit, ""))) {
      t.lower = s.limit.range[0];
      t.upper = s.limit.range[1];
    }
    t.damping = s.damping;
    t.friction_loss = s.friction_loss;
    t.stiffness = s.stiffness;
    expect_not_below_zero(e, "stiffness", s.stiffness);
    expect_not_below_zero(e, "damping", s.damping);
    expect_not_below_zero(e, "frictionloss", s.friction_loss);
    if (s.rest[0] > s.rest[1]) e.refuse("springlength of a tendon must not fall");
    const bool is_of_pose = s.rest[0] == -1 && s.rest[1] == -1;
    const double length = is_of_pose ? length_at_rest(r.model, poses, t) : 0;
    t.rest_lower = is_of_pose ? length : s.rest[0];
    t.rest_upper = is_of_pose ? length : s.rest[1];
    t.name = r.names.add(e, Kind::tendon, in.scope, Index(r.model.tendons.size()), r.budget);
    r.model.tendons.push_back(std::move(t));
  }
}

}  // namespace delassus::inner::mjcf
