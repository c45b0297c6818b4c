/// Bodies with what they hold, frames, and the copies that `replicate` and `attach` make.
#pragma once

#include <delassus/adapters/mjcf/reading.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace delassus::inner::mjcf {

/// Where an element stands.
struct Place {
  Source& source;
  int scope;
  Index body;  ///< −1: the world
  Pose frame;  ///< in that body's frame
  const Defaults* defaults;
  int depth;
};

void read_children(Reading& r, const Element& parent, const Place& at);

/// Beyond it a chain of bodies could exhaust the stack.
inline constexpr int deepest_body = 1000;

inline Pose read_pose(const Element& e, const Compiler& c) {
  Pose pose;
  e.read("pos", pose.position);
  read_orientation(e, c, pose.rotation);
  return pose;
}

/// Moments and mass in words of the file; those along axes, or all six.
inline MassProperties read_inertial(const Element& e, const Compiler& c) {
  MassProperties p;
  if (!e.read("mass", p.mass)) e.refuse("inertial needs a mass");
  if (!e.read("pos", p.centre)) e.refuse("inertial needs a pos, the centre of mass");
  expect_not_below_zero(e, "mass", p.mass);
  Pose pose;
  const bool is_turned = read_orientation(e, c, pose.rotation);
  Vec3 along = zero<Vec3>();
  std::array<double, 6> full{};
  const bool has_along = e.read("diaginertia", along);
  if (e.read("fullinertia", full, 6)) {
    if (has_along || is_turned) e.refuse("fullinertia stands beside diaginertia or an orientation; give one");
    for (int k = 0; k < 3; ++k) p.inertia(k, k) = full[std::size_t(k)];
    p.inertia(0, 1) = p.inertia(1, 0) = full[3];
    p.inertia(0, 2) = p.inertia(2, 0) = full[4];
    p.inertia(1, 2) = p.inertia(2, 1) = full[5];
    if (!(principal_moments(p.inertia).moments[2] > 1e-14))
      e.refuse("fullinertia has a principal moment that is not above 0");
    return p;
  }
  for (int k = 0; k < 3; ++k) expect_not_below_zero(e, "diaginertia", along[k]);
  p.inertia = inertia_of({along, pose.rotation});
  return p;
}

/// A geom's mesh, loaded when it is first asked for; nullptr where it cannot be had and the geom does
/// without.
inline const LoadedMesh* find_mesh(Reading& r, const Element& e, const GeomSpec& s, const Place& at,
                                   bool is_needed) {
  Source& source = at.source;
  if (const auto old = source.loaded_meshes.find(s.mesh); old != source.loaded_meshes.end())
    return &old->second;
  const auto asset = source.meshes.find(s.mesh);
  if (asset == source.meshes.end()) e.refuse("there is no mesh '" + s.mesh.substr(0, 200) + "'");
  const Element& mesh = asset->second.element;
  if (!is_needed && !is_there(mesh, *source.document, source.compiler)) {
    r.skipped.add(mesh,
                  "the mesh file '" + mesh.text("file") +
                      "' is not found; a geom that shows it and neither collides nor weighs is left out");
    return nullptr;
  }
  MeshSpec spec = asset->second.defaults->mesh;
  read(mesh, spec, r.skipped);
  const std::string name =
      r.names.scopes[std::size_t(r.names.scopes[std::size_t(at.scope)].owner)].name(s.mesh);
  return &source.loaded_meshes
              .emplace(s.mesh,
                       load_mesh(mesh, spec, *source.document, source.compiler, name, r.model, r.budget))
              .first->second;
}

inline Index find_field(Reading& r, const Element& e, const GeomSpec& s, const Place& at) {
  Source& source = at.source;
  if (const auto old = source.loaded_fields.find(s.field); old != source.loaded_fields.end())
    return old->second;
  const auto asset = source.fields.find(s.field);
  if (asset == source.fields.end()) e.refuse("there is no hfield '" + s.field.substr(0, 200) + "'");
  const std::string name =
      r.names.scopes[std::size_t(r.names.scopes[std::size_t(at.scope)].owner)].name(s.field);
  const Index field = load_field(asset->second, *source.document, source.compiler, name, r.model, r.budget);
  source.loaded_fields.emplace(s.field, field);
  return field;
}

inline void read_geom(Reading& r, const Element& e, const Place& at) {
  const Compiler& c = at.source.compiler;
  GeomSpec s = at.source.classes.of(e, "class", *at.defaults).geom;
  read(e, c, s, r.skipped);
  if (s.type == GeomType::sdf) return r.skipped.add(e, "a geom of type sdf is left out");
  const bool is_mesh = s.type == GeomType::mesh;
  if ((s.type == GeomType::hfield) != !s.field.empty())
    e.refuse("a geom of type hfield needs the name of an hfield, and no other has one");
  if (is_mesh && s.mesh.empty()) e.refuse("a geom of type mesh needs the name of a mesh");
  const bool in_groups = s.group >= c.lowest_group && s.group <= c.highest_group;
  const bool weighs =
      at.body >= 0 && in_groups && s.type != GeomType::plane && !(s.mass && *s.mass == 0) &&
      (c.inertia_from_geoms == FromGeoms::always ||
       (c.inertia_from_geoms == FromGeoms::where_no_inertial && !r.parts[std::size_t(at.body)].has_inertial));
  model::Geometry g{.body = at.body};
  Pose pose = place(e, s.placement, s.type, s.size);
  MassProperties solid;
  if (!s.mesh.empty()) {
    if (s.placement.has_ends) e.refuse("fromto is not for a geom with a mesh");
    if (is_mesh && s.is_shell) e.refuse("of a mesh, inertia='shell' is said in the asset");
    const LoadedMesh* mesh =
        find_mesh(r, e, s, at, weighs || !is_mesh || s.contype != 0 || s.conaffinity != 0);
    if (!mesh) return;
    if (is_mesh) {
      g.shape = model::HullOf{mesh->mesh};
      solid = mesh->solid;
    } else {
      pose = product(pose, fit_to_mesh(e, s.type, *mesh, r.model.meshes[std::size_t(mesh->mesh)], c.fit_boxes,
                                       s.fit_scale, s.size));
    }
  }
  if (s.type == GeomType::hfield) {
    const Index field = find_field(r, e, s, at);
    const model::HeightField& f = r.model.height_fields[std::size_t(field)];
    const double high = f.heights.empty() ? 0 : *std::max_element(f.heights.begin(), f.heights.end());
    s.size = {f.half_x, f.half_y, 0.25 * high + 0.5 * f.base};
    g.shape = model::FieldOf{field};
  } else if (!is_mesh) {
    for (int k = 0; k < size_count(s.type); ++k)
      if (!(s.size[std::size_t(k)] > 0))
        e.refuse("size " + std::to_string(k + 1) + " of the geom is " + text(s.size[std::size_t(k)]) +
                 " and must be > 0");
    g.shape = shape_of(s.type, s.size);
  }
  if (!is_mesh && weighs) solid = s.is_shell ? shell(s.type, s.size) : filled(s.type, s.size);
  g.pose = product(at.frame, pose);
  set_contact(e, s, g);
  const MassProperties mass = weigh(e, s, solid);
  if (weighs && mass.mass > 1e-14) r.parts[std::size_t(at.body)].geoms.push_back(seen_at(g.pose, mass));
  g.name = r.names.add(e, Kind::geom, at.scope, Index(r.model.geometries.size()), r.budget);
  r.model.geometries.push_back(std::move(g));
}

inline void read_site(Reading& r, const Element& e, const Place& at) {
  SiteSpec s = at.source.classes.of(e, "class", *at.defaults).site;
  read(e, at.source.compiler, s);
  model::Site site{.body = at.body, .pose = product(at.frame, place(e, s.placement, s.type, s.size))};
  site.name = r.names.add(e, Kind::site, at.scope, Index(r.model.sites.size()), r.budget);
  r.model.sites.push_back(std::move(site));
}

inline void read_joint(Reading& r, const Element& e, const Place& at) {
  if (at.body < 0) e.refuse("the world has no joints");
  const bool is_free = e.name() == "freejoint";
  JointSpec s;
  if (is_free) {
    s.type = 0;
    if (e.choice("align", {"false", "true", "auto"}) == 1)
      r.skipped.add(e, "align: the body keeps the frame that the file gives it");
  } else {
    s = at.source.classes.of(e, "class", *at.defaults).joint;
    read(e, s, r.skipped);
  }
  model::Joint joint = make_joint(e, s, at.source.compiler, at.frame, r.skipped);
  model::Body& body = r.model.bodies[std::size_t(at.body)];
  if (joint.kind == model::JointKind::free && body.parent >= 0)
    e.refuse("a free joint is for a child of the world; give this body slides and a ball instead");
  const auto kind_of = [&](Index j) { return r.model.joints[std::size_t(j)].kind; };
  for (const Index j : body.joints) {
    if (joint.kind == model::JointKind::free || kind_of(j) == model::JointKind::free)
      e.refuse("a free joint must be the only one of its body");
    if (kind_of(j) == model::JointKind::ball && joint.kind != model::JointKind::slide)
      e.refuse("a ball joint is followed by another turn of the same body");
  }
  if (body.joints.size() == 6) e.refuse("a body has more than six joints");
  const Index index = Index(r.model.joints.size());
  joint.name = r.names.add(e, Kind::joint, at.scope, index, r.budget);
  body.joints.push_back(index);
  r.model.joints.push_back(std::move(joint));
}

inline void read_body(Reading& r, const Element& e, const Place& at) {
  const Compiler& c = at.source.compiler;
  const Index index = Index(r.model.bodies.size());
  model::Body body{.parent = at.body, .pose = product(at.frame, read_pose(e, c))};
  body.name = r.names.add(e, Kind::body, at.scope, index, r.budget);
  e.read("gravcomp", body.gravity_compensation);
  e.read("mocap", body.is_kinematic);
  if (body.is_kinematic && at.body >= 0) e.refuse("a mocap body must be a child of the world");
  r.model.bodies.push_back(std::move(body));
  r.parts.push_back({.element = e, .source = &at.source});
  at.source.document->for_each(e, [&](const Element& child) {
    if (child.name() != "inertial") return;
    if (r.parts.back().has_inertial) child.refuse("the body has two inertials");
    r.parts.back().has_inertial = true;
    r.parts.back().inertial = read_inertial(child, c);
  });
  const Defaults& defaults = at.source.classes.of(e, "childclass", *at.defaults);
  read_children(r, e, {at.source, at.scope, index, {}, &defaults, at.depth + 1});
  const model::Body& whole = r.model.bodies[std::size_t(index)];
  if (whole.is_kinematic && !whole.joints.empty()) e.refuse("a mocap body must have no joints");
}

inline void read_frame(Reading& r, const Element& e, const Place& at) {
  Place in = at;
  in.frame = product(at.frame, read_pose(e, at.source.compiler));
  in.defaults = &at.source.classes.of(e, "childclass", *at.defaults);
  ++in.depth;
  read_children(r, e, in);
}

}  // namespace delassus::inner::mjcf
