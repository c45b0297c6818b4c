/// Equalities of a machine.
#pragma once

#include <delassus/adapters/mjcf/instances.hpp>

#include <array>
#include <string>
#include <vector>

namespace delassus::inner::mjcf {

inline std::vector<Reference> equality_references(const Document&, const Element& e) {
  const std::string_view kind = e.name();
  if (kind == "joint") return references_of(e, Kind::joint, {"joint1", "joint2"});
  if (kind == "tendon") return references_of(e, Kind::tendon, {"tendon1", "tendon2"});
  if (kind != "connect" && kind != "weld") return {};
  std::vector<Reference> names = references_of(e, Kind::body, {"body1", "body2"});
  for (Reference& site : references_of(e, Kind::site, {"site1", "site2"})) names.push_back(std::move(site));
  return names;
}

/// Two bodies, and where in each the constraint acts.
struct Ends {
  Index body = -1, other = -1;
  Pose at, other_at;
};

inline Ends read_ends(const Reading& r, const Instance& in) {
  const Element& e = in.element;
  Ends ends;
  if (e.has("site1") != e.has("site2")) e.refuse("site1 and site2 go together");
  if (e.has("site1")) {
    if (e.has("body1") || e.has("body2") || e.has("anchor") || e.has("relpose"))
      e.refuse("an equality names two sites, or bodies with an anchor or a relpose, and not both");
    const model::Site &a = r.model.sites[std::size_t(in.find(r, Kind::site, "site1"))],
                      &b = r.model.sites[std::size_t(in.find(r, Kind::site, "site2"))];
    ends = {a.body, b.body, a.pose, b.pose};
  } else {
    e.required("body1");
    ends.body = in.find(r, Kind::body, "body1");
    ends.other = e.has("body2") ? in.find(r, Kind::body, "body2") : -1;
  }
  if (ends.body == ends.other) e.refuse("the equality holds a body to itself");
  return ends;
}

inline void read_connect(Reading& r, const Instance& in) {
  Ends ends = read_ends(r, in);
  if (!in.element.has("site1")) {
    if (!in.element.read("anchor", ends.at.position))
      in.element.refuse("connect needs an anchor, or two sites");
    const Vec3 point = pose_in_world(r.model, ends.body).to_world(ends.at.position);
    ends.other_at.position = pose_in_world(r.model, ends.other).to_local(point);
  }
  r.model.connects.push_back({in.name(r), ends.body, ends.other, ends.at.position, ends.other_at.position});
}

/// The other body's pose is what `relpose` says, or as in the file. An anchor is a point of the other body,
/// and what `relpose` places.
inline void read_weld(Reading& r, const Instance& in) {
  const Element& e = in.element;
  const Ends ends = read_ends(r, in);
  Pose pose;
  std::array<double, 7> x{};
  e.read("relpose", x, 7);
  const bool is_given = x[3] != 0 || x[4] != 0 || x[5] != 0 || x[6] != 0;
  if (e.has("site1")) {
    pose = product(ends.at, inverse_of(ends.other_at));
  } else if (is_given) {
    Vec3 anchor = zero<Vec3>();
    e.read("anchor", anchor);
    pose.rotation = rotation_matrix(unit(Quat(x[3], x[4], x[5], x[6])));
    pose.position = Vec3(x[0], x[1], x[2]) - pose.rotation * anchor;
  } else {
    pose = pose_in_world(r.model, ends.body).to_local(pose_in_world(r.model, ends.other));
  }
  r.model.welds.push_back({in.name(r), ends.body, ends.other, pose});
}

inline void read_coupling(Reading& r, const Instance& in, Kind kind) {
  const Element& e = in.element;
  const bool of_tendons = kind == Kind::tendon;
  const char *first = of_tendons ? "tendon1" : "joint1", *second = of_tendons ? "tendon2" : "joint2";
  e.required(first);
  model::Coupling c{.name = in.name(r), .joint = in.find(r, kind, first), .of_tendons = of_tendons};
  if (e.has(second)) c.other = in.find(r, kind, second);
  if (c.joint == Names::left_out || c.other == Names::left_out)
    return r.skipped.add(e, "the equality '" + c.name + "' is left out: so is a tendon of it");
  if (c.joint == c.other) e.refuse("the equality couples a thing to itself");
  e.read("polycoef", c.coefficients, 1);
  for (const Index j : {c.joint, c.other})
    if (!of_tendons && j >= 0)
      if (const auto k = r.model.joints[std::size_t(j)].kind;
          k != model::JointKind::hinge && k != model::JointKind::slide)
        e.refuse("an equality of joints takes hinges and slides alone");
  r.model.couplings.push_back(std::move(c));
}

inline void read_equalities(Reading& r) {
  for (const Instance& in : instances(r, "equality", equality_references)) {
    const Element& e = in.element;
    const std::string_view kind = e.name();
    if (kind == "flex" || kind == "flexvert" || kind == "flexstrain" || kind == "distance") {
      r.skipped.add(e, "an equality of kind " + std::string(kind) + " is left out");
      continue;
    }
    EqualitySpec s = in.source->classes.of(e, "class", in.source->classes.main()).equality;
    read(e, s, r.skipped);
    if (!s.is_active)
      r.skipped.add(e, "the equality '" + in.name(r) + "' is not active, and is left out");
    else if (kind == "connect")
      read_connect(r, in);
    else if (kind == "weld")
      read_weld(r, in);
    else
      read_coupling(r, in, kind == "joint" ? Kind::joint : Kind::tendon);
  }
}

}  // namespace delassus::inner::mjcf
