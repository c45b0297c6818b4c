/// Actuators, contact filters and keyframes of a machine.
#pragma once

#include <delassus/adapters/mjcf/instances.hpp>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace delassus::inner::mjcf {

inline std::vector<Reference> actuator_references(const Document&, const Element& e) {
  std::vector<Reference> names = references_of(e, Kind::joint, {"joint", "jointinparent"});
  for (const auto& more : {references_of(e, Kind::tendon, {"tendon"}), references_of(e, Kind::body, {"body"}),
                           references_of(e, Kind::site, {"site", "refsite", "cranksite", "slidersite"})})
    names.insert(names.end(), more.begin(), more.end());
  return names;
}

/// What the actuator acts on; says why it is left out, if it is.
inline std::string set_target(const Reading& r, const Instance& in, model::Actuator& a) {
  const Element& e = in.element;
  int count = 0;
  for (const char* target : {"joint", "jointinparent", "tendon", "site", "body", "cranksite"})
    count += e.has(target);
  if (count != 1)
    e.refuse("an actuator acts on one joint, tendon or site, and this names " + std::to_string(count));
  if (e.has("cranksite")) return "its transmission is a slider and crank";
  if (e.has("body")) return "it acts on a body";
  if (e.has("site")) {
    a.transmission = model::Transmission::site;
    a.target = in.find(r, Kind::site, "site");
    return e.has("refsite") ? "it acts on a site as seen from another" : "";
  }
  if (e.has("tendon")) {
    a.transmission = model::Transmission::tendon;
    a.target = in.find(r, Kind::tendon, "tendon");
    return a.target == Names::left_out ? "so is its tendon" : "";
  }
  a.target = in.find(r, Kind::joint, e.has("joint") ? "joint" : "jointinparent");
  const auto kind = r.model.joints[std::size_t(a.target)].kind;
  const bool turns = kind == model::JointKind::ball || kind == model::JointKind::free;
  return turns && e.has("jointinparent") ? "its torque keeps the axes of the joint's parent" : "";
}

/// A control range in proportion to that of the joint or tendon.
inline void inherit_range(const Reading& r, const Element& e, const ActuatorSpec& s, model::Actuator& a) {
  if (!(s.inherit_range > 0)) return;
  if (s.control.has_range()) e.refuse("both ctrlrange and inheritrange are given; give one");
  double lower = 0, upper = 0;
  if (a.transmission == model::Transmission::joint) {
    const model::Joint& j = r.model.joints[std::size_t(a.target)];
    lower = j.lower;
    upper = j.upper;
  } else if (a.transmission == model::Transmission::tendon) {
    const model::Tendon& t = r.model.tendons[std::size_t(a.target)];
    lower = t.lower;
    upper = t.upper;
  }
  if (!(lower < upper)) e.refuse("inheritrange is given, and what the actuator acts on has no range");
  const double middle = (lower + upper) / 2, half = s.inherit_range * (upper - lower) / 2;
  a.control_lower = middle - half;
  a.control_upper = middle + half;
  a.control_is_limited = s.control.is_on != 0;
}

/// How many controls and activations the file's actuators have, and which of them are read.
struct Controls {
  std::vector<bool> is_kept, has_activation;  ///< one an actuator of the file
  std::vector<int> scopes;
};

inline Controls read_actuators(Reading& r) {
  Controls controls;
  for (const Instance& in : instances(r, "actuator", actuator_references)) {
    const Element& e = in.element;
    ActuatorSpec s = in.source->classes.of(e, "class", in.source->classes.main()).actuator;
    read(e, s, r.skipped);
    model::Actuator a;
    std::string why = set_target(r, in, a);
    if (why.empty()) why = beyond_model(s);
    controls.is_kept.push_back(why.empty());
    controls.has_activation.push_back(s.dynamics != Dynamics::none);
    controls.scopes.push_back(in.scope);
    if (!why.empty()) {
      r.skipped.add(e,
                    "the actuator '" + in.name(r) + "' (" + std::string(e.name()) + ") is left out: " + why);
      continue;
    }
    const auto transmission = a.transmission;
    const Index target = a.target;
    a = make_actuator(e, s, in.source->compiler);
    a.name = in.name(r);
    a.transmission = transmission;
    a.target = target;
    inherit_range(r, e, s, a);
    if (holds(e, in.source->compiler, s.activation, "act"))
      r.skipped.add(e, "actrange: the activation of '" + a.name + "' has no bounds of its own");
    r.model.actuators.push_back(std::move(a));
  }
  return controls;
}

inline std::vector<Reference> contact_references(const Document&, const Element& e) {
  return e.name() == "pair" ? references_of(e, Kind::geom, {"geom1", "geom2"})
                            : references_of(e, Kind::body, {"body1", "body2"});
}

inline void read_contacts(Reading& r) {
  for (const Instance& in : instances(r, "contact", contact_references)) {
    const Element& e = in.element;
    if (e.name() == "exclude") {
      e.required("body1");
      e.required("body2");
      const Index a = in.find(r, Kind::body, "body1"), b = in.find(r, Kind::body, "body2");
      if (a == b) e.refuse("exclude names one body twice");
      r.model.excludes.push_back({a, b});
      continue;
    }
    e.required("geom1");
    e.required("geom2");
    PairSpec s = in.source->classes.of(e, "class", in.source->classes.main()).pair;
    read(e, s, r.skipped);
    if (s.condim != 1 && s.condim != 3 && s.condim != 4 && s.condim != 6)
      e.refuse("condim " + std::to_string(s.condim) + " of the pair must be 1, 3, 4 or 6");
    for (const double f : s.friction) expect_not_below_zero(e, "friction", f);
    if (s.friction[0] != s.friction[1] || s.friction[3] != s.friction[4])
      r.skipped.add(e, "friction: of two directions of the pair the first number counts");
    const Index a = in.find(r, Kind::geom, "geom1"), b = in.find(r, Kind::geom, "geom2");
    if (a == b) e.refuse("the pair names one geom twice");
    r.model.pairs.push_back({a, b, s.condim, s.friction[0], s.friction[2], s.friction[3]});
  }
}

}  // namespace delassus::inner::mjcf
