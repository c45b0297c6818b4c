/// Keyframes: states that a file names.
#pragma once

#include <delassus/adapters/mjcf/forces.hpp>

#include <string>
#include <utility>
#include <vector>

namespace delassus::inner::mjcf {

/// q of the pose of the file: the reference of each joint, and for a free one where its body stands.
inline std::vector<double> reference_q(const Model& model, const std::vector<Index>& joints) {
  std::vector<Index> body_of(model.joints.size(), -1);
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    for (const Index j : model.bodies[b].joints) body_of[std::size_t(j)] = Index(b);
  std::vector<double> q;
  for (const Index j : joints) {
    const model::Joint& joint = model.joints[std::size_t(j)];
    if (joint.kind == model::JointKind::free) {
      const Pose pose = pose_in_world(model, body_of[std::size_t(j)]);
      const Quat turn(pose.rotation);
      q.insert(q.end(), {pose.position[0], pose.position[1], pose.position[2], turn.w(), turn.x(), turn.y(),
                         turn.z()});
    } else if (joint.kind == model::JointKind::ball) {
      q.insert(q.end(), {1, 0, 0, 0});
    } else {
      q.push_back(joint.reference);
    }
  }
  return q;
}

/// Where each joint's numbers begin in q, or in v.
inline std::vector<std::size_t> offsets(const Model& model, int (*size)(const model::Joint&)) {
  std::vector<std::size_t> at{0};
  for (const model::Joint& j : model.joints) at.push_back(at.back() + std::size_t(size(j)));
  return at;
}

/// Writes the numbers of some joints over a whole q or v. Pre: as many as they have.
inline void put_numbers(const Model& model, const std::vector<Index>& joints,
                        int (*size)(const model::Joint&), const std::vector<double>& from,
                        std::vector<double>& to) {
  const std::vector<std::size_t> at = offsets(model, size);
  std::size_t k = 0;
  for (const Index j : joints)
    for (int i = 0; i < size(model.joints[std::size_t(j)]); ++i)
      to[at[std::size_t(j)] + std::size_t(i)] = from[k++];
}

/// The numbers of an attribute; those of the reference where it is absent. Not as many as there must be:
/// refused in a model of its own, and in an attached one said by an empty list.
inline std::vector<double> key_numbers(const Element& e, const char* attribute, std::vector<double> otherwise,
                                       bool& fits) {
  if (!e.has(attribute)) return otherwise;
  std::vector<double> given = e.numbers(attribute);
  if (given.size() == otherwise.size()) return given;
  fits = false;
  return otherwise;
}

inline void read_key(Reading& r, const Element& e, const Copy& copy, const Controls& controls) {
  Model& model = r.model;
  std::vector<Index> joints, all;
  for (Index j = 0; j < Index(model.joints.size()); ++j) {
    all.push_back(j);
    if (copy.joints[std::size_t(j)]) joints.push_back(j);
  }
  const std::vector<double> q = reference_q(model, joints);
  std::size_t v_count = 0, control_count = 0, activation_count = 0;
  for (const Index j : joints) v_count += std::size_t(v_size(model.joints[std::size_t(j)]));
  std::vector<std::size_t> own;  // the file's actuators that belong to the copy
  for (std::size_t i = 0; i < controls.is_kept.size(); ++i)
    if (copy.scope == 0 || r.names.scopes[std::size_t(controls.scopes[i])].owner == copy.scope) {
      own.push_back(i);
      ++control_count;
      activation_count += controls.has_activation[i];
    }
  bool fits = true;
  const std::vector<double> key_q = key_numbers(e, "qpos", q, fits),
                            key_v = key_numbers(e, "qvel", std::vector<double>(v_count, 0.0), fits),
                            key_a = key_numbers(e, "act", std::vector<double>(activation_count, 0.0), fits),
                            key_c = key_numbers(e, "ctrl", std::vector<double>(control_count, 0.0), fits);
  if (!fits) {
    const std::string wanted = std::to_string(q.size()) + " numbers in qpos, " + std::to_string(v_count) +
                               " in qvel, " + std::to_string(activation_count) + " in act and " +
                               std::to_string(control_count) + " in ctrl";
    if (copy.scope == 0) e.refuse("the key must have " + wanted + ", where it has any");
    return r.skipped.add(e, "the key '" + e.text("name") + "' is left out: the attached part has " + wanted);
  }
  model::Keyframe key{.q = reference_q(model, all)};
  key.name = r.names.scopes[std::size_t(copy.scope)].name(e.text("name"));
  e.read("time", key.time);
  std::size_t v_all = 0;
  for (const model::Joint& j : model.joints) v_all += std::size_t(v_size(j));
  key.v.assign(v_all, 0.0);
  put_numbers(model, joints, q_size, key_q, key.q);
  put_numbers(model, joints, v_size, key_v, key.v);
  std::size_t next = 0, next_activation = 0;
  for (std::size_t i = 0; i < controls.is_kept.size(); ++i) {
    const bool is_own = next < own.size() && own[next] == i;
    const double control = is_own ? key_c[next++] : 0;
    const double activation = is_own && controls.has_activation[i] ? key_a[next_activation++] : 0;
    if (!controls.is_kept[i]) continue;
    key.control.push_back(control);
    if (controls.has_activation[i]) key.activation.push_back(activation);
  }
  for (const char* mocap : {"mpos", "mquat"})
    if (e.has(mocap)) r.skipped.add(e, std::string(mocap) + ": keyframes do not place mocap bodies");
  model.keyframes.push_back(std::move(key));
}

inline void read_keys(Reading& r, const Controls& controls) {
  for (const Copy& copy : r.copies)
    copy.source->document->for_each_section("keyframe", [&](const Element& s) {
      copy.source->document->for_each(s, [&](const Element& e) {
        r.budget.take_element(e);
        r.budget.take_points(e, 14.0 * double(r.model.joints.size()));  // of q, v and what is compared
        read_key(r, e, copy, controls);
      });
    });
}

}  // namespace delassus::inner::mjcf
