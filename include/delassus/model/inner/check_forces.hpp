/// Whether what couples and drives the bodies of a description names what is there, with numbers that will
/// do.
#pragma once

#include <delassus/model/inner/check_numbers.hpp>

#include <initializer_list>

namespace delassus::inner {

/// Whether it has one coordinate.
inline bool has_one_freedom(const model::Joint& joint) {
  return joint.kind == model::JointKind::hinge || joint.kind == model::JointKind::slide;
}

inline void check_couplings(const Model& model) {
  check_each(model, "coupling", model.couplings, [&](const model::Coupling& c, const ModelElement& who) {
    const std::size_t count = c.of_tendons ? model.tendons.size() : model.joints.size();
    who.expect_index(c.joint, count, c.of_tendons ? "the index of its tendon" : "the index of its joint");
    who.expect_index(c.other, count,
                     c.of_tendons ? "the index of its other tendon" : "the index of its other joint", -1);
    who.expect(c.joint != c.other, "it couples one thing with itself");
    if (!c.of_tendons)
      for (const Index j : {c.joint, c.other})
        who.expect(j < 0 || has_one_freedom(model.joints[std::size_t(j)]),
                   "only hinges and slides can be coupled");
    for (const double x : c.coefficients) who.expect_sane(x, "a coefficient");
  });
  const auto two_bodies = [&](Index a, Index b, const ModelElement& who) {
    who.expect_index(a, model.bodies.size(), "the index of a body", -1);
    who.expect_index(b, model.bodies.size(), "the index of a body", -1);
    who.expect(a != b, "it names one body twice");
  };
  check_each(model, "connect", model.connects, [&](const model::Connect& c, const ModelElement& who) {
    two_bodies(c.body, c.other, who);
    who.expect_sane(c.point, "a point");
    who.expect_sane(c.other_point, "a point");
  });
  check_each(model, "weld", model.welds, [&](const model::Weld& w, const ModelElement& who) {
    two_bodies(w.body, w.other, who);
    who.expect_pose(w.pose);
  });
}

inline void check_tendons(const Model& model) {
  check_each(model, "site", model.sites, [&](const model::Site& s, const ModelElement& who) {
    who.expect_index(s.body, model.bodies.size(), "the index of its body", -1);
    who.expect_pose(s.pose);
  });
  check_each(model, "tendon", model.tendons, [&](const model::Tendon& t, const ModelElement& who) {
    who.expect(t.joints.empty() != t.sites.empty(),
               "it must have joints (a fixed one) or sites (a spatial one), not both");
    who.expect(t.joints.size() > 0 || t.sites.size() >= 2, "its path needs two sites");
    for (const model::TendonJoint& j : t.joints) {
      who.expect_index(j.joint, model.joints.size(), "the index of a joint");
      who.expect(has_one_freedom(model.joints[std::size_t(j.joint)]),
                 "only hinges and slides share in a length");
      who.expect_sane(j.coefficient, "a coefficient");
    }
    for (const Index s : t.sites) who.expect_index(s, model.sites.size(), "the index of a site");
    if (t.is_limited) who.expect_range(t.lower, t.upper, "its limits");
    who.expect_range(t.rest_lower, t.rest_upper, "the lengths at rest");
    who.expect_at_least_zero(t.damping, "damping");
    who.expect_at_least_zero(t.friction_loss, "friction loss");
    who.expect_at_least_zero(t.stiffness, "stiffness");
  });
}

inline void check_actuators(const Model& model) {
  using model::Transmission;
  check_each(model, "actuator", model.actuators, [&](const model::Actuator& a, const ModelElement& who) {
    const std::size_t count = a.transmission == Transmission::joint    ? model.joints.size()
                              : a.transmission == Transmission::tendon ? model.tendons.size()
                                                                       : model.sites.size();
    who.expect_index(a.target, count, "the index of what it moves");
    for (const double x : a.gear) who.expect_sane(x, "a number of its gear");
    who.expect_sane(a.gain, "its gain");
    for (const double x : a.bias) who.expect_sane(x, "a number of its bias");
    who.expect_at_least_zero(a.time_constant, "its time constant");
    if (a.control_is_limited) who.expect_range(a.control_lower, a.control_upper, "the limits of its control");
    if (a.force_is_limited) who.expect_range(a.force_lower, a.force_upper, "the limits of its force");
  });
}

/// Each list of a keyframe is empty, or has a number for each freedom.
inline void check_keyframes(const Model& model) {
  std::size_t q = 0, v = 0, filters = 0;
  for (const model::Joint& joint : model.joints) {
    const bool is_ball = joint.kind == model::JointKind::ball, is_free = joint.kind == model::JointKind::free;
    q += is_free ? 7 : is_ball ? 4 : 1;
    v += is_free ? 6 : is_ball ? 3 : 1;
  }
  for (const model::Actuator& a : model.actuators) filters += a.time_constant > 0;
  check_each(model, "keyframe", model.keyframes, [&](const model::Keyframe& key, const ModelElement& who) {
    who.expect_sane(key.time, "its time");
    who.expect(key.q.empty() || key.q.size() == q,
               "its q must have a number for each coordinate of the joints");
    who.expect(key.v.empty() || key.v.size() == v, "its v must have a number for each freedom of the joints");
    who.expect(key.activation.empty() || key.activation.size() == filters,
               "it must have an activation for each actuator with a filter");
    who.expect(key.control.empty() || key.control.size() == model.actuators.size(),
               "it must have a control for each actuator");
    for (const auto* list : {&key.q, &key.v, &key.activation, &key.control})
      for (const double x : *list) who.expect_sane(x, "a number");
  });
}

}  // namespace delassus::inner
