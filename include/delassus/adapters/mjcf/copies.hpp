/// Copies of parts of a model: `replicate` and `attach`.
#pragma once

#include <delassus/adapters/mjcf/world.hpp>

#include <algorithm>
#include <string>

namespace delassus::inner::mjcf {

/// "007" for the seventh of 100 to 999.
inline std::string suffix_digits(int i, int count) {
  const std::string digits = std::to_string(i);
  return std::string(std::to_string(count).size() - digits.size(), '0') + digits;
}

/// The i-th copy is turned by i times the angles, and each begins where the one before ends after one offset.
inline void read_replicate(Reading& r, const Element& e, const Place& at) {
  int count = 0;
  Vec3 offset = zero<Vec3>(), angles = zero<Vec3>();
  if (!e.read("count", count) || count < 0) e.refuse("replicate needs a count that is not below 0");
  r.budget.expect_elements(e, count);
  e.read("offset", offset);
  e.read("euler", angles);
  Pose pose;
  Place in = at;
  in.defaults = &at.source.classes.of(e, "childclass", *at.defaults);
  ++in.depth;
  for (int i = 0; i < count; ++i) {
    r.budget.take_element(e);
    pose.rotation = euler_rotation(Vec3(double(i) * angles), at.source.compiler);
    in.frame = product(at.frame, pose);
    in.scope = r.names.add_scope(e, at.scope, "", e.text("sep") + suffix_digits(i, count), false, r.budget);
    read_children(r, e, in);
    pose.position += pose.rotation * offset;
  }
}

/// The bodies and frames of a document by name, with the class in which each stands.
inline void index_named(Source& source, const Element& parent, const Defaults& defaults) {
  source.document->for_each(parent, [&](const Element& e) {
    const std::string_view kind = e.name();
    if (kind != "body" && kind != "frame" && kind != "replicate") return;
    if (kind == "body") source.bodies.try_emplace(e.text("name"), Named{e, &defaults});
    if (kind == "frame") source.frames.try_emplace(e.text("name"), Named{e, &defaults});
    index_named(source, e, source.classes.of(e, "childclass", defaults));
  });
}

inline const Named& find_named(const Element& e, const Source& source, const char* kind) {
  const auto& all = std::string_view(kind) == "body" ? source.bodies : source.frames;
  const auto found = all.find(e.required(kind));
  if (found == all.end() || found->first.empty())
    e.refuse(std::string("there is no ") + kind + " '" + e.text(kind).substr(0, 200) + "' to attach");
  return found->second;
}

/// A body or a frame of this document or of another, or all that another holds.
inline void read_attach(Reading& r, const Element& e, const Place& at) {
  const bool has_body = e.has("body"), has_frame = e.has("frame"), is_other = e.has("model");
  if (has_body && has_frame) e.refuse("attach names both a body and a frame; name one");
  Source* source = &at.source;
  if (is_other) {
    const auto found = source->models.find(e.text("model"));
    if (found == source->models.end())
      e.refuse("there is no model '" + e.text("model").substr(0, 200) + "' among the assets");
    source = found->second;
  } else if (!has_body && !has_frame) {
    e.refuse("attach needs a model, a body or a frame");
  }
  const int scope = r.names.add_scope(e, at.scope, e.required("prefix"), "", is_other, r.budget);
  const Index first = Index(r.model.joints.size());
  Place in{*source, scope, at.body, at.frame, &source->classes.main(), at.depth + 1};
  const auto* self = e.xml();
  if (std::find(r.open_attached.begin(), r.open_attached.end(), self) != r.open_attached.end())
    e.refuse("what is attached holds this attach itself, without end");
  r.open_attached.push_back(self);
  if (has_body || has_frame) {
    const Named& named = find_named(e, *source, has_body ? "body" : "frame");
    in.defaults = named.defaults;
    r.budget.take_element(named.element);
    has_body ? read_body(r, named.element, in) : read_frame(r, named.element, in);
  } else {
    source->document->for_each_section("worldbody",
                                       [&](const Element& world) { read_children(r, world, in); });
  }
  r.open_attached.pop_back();
  if (is_other) r.copies.push_back({source, scope, first, Index(r.model.joints.size()), {}});
}

inline void read_children(Reading& r, const Element& parent, const Place& at) {
  if (at.depth > deepest_body)
    parent.refuse("bodies and frames lie within each other deeper than " + std::to_string(deepest_body));
  at.source.document->for_each(parent, [&](const Element& e) {
    r.budget.take_element(e);
    const std::string_view kind = e.name();
    if (kind == "body")
      read_body(r, e, at);
    else if (kind == "geom")
      read_geom(r, e, at);
    else if (kind == "joint" || kind == "freejoint")
      read_joint(r, e, at);
    else if (kind == "site")
      read_site(r, e, at);
    else if (kind == "frame")
      read_frame(r, e, at);
    else if (kind == "replicate")
      read_replicate(r, e, at);
    else if (kind == "attach")
      read_attach(r, e, at);
    else if (kind == "plugin" || kind == "composite" || kind == "flexcomp")
      r.skipped.add(e, std::string(kind) + " is left out");
    else if (kind == "inertial" && at.body < 0)
      e.refuse("the world has no inertial");
  });
}

}  // namespace delassus::inner::mjcf
