// Where the joints of a machine are as its run begins.
#include "joint_numbers.hpp"

#include <delassus/model/joint_space.hpp>

#include <algorithm>
#include <optional>
#include <utility>

namespace delassus_run {

namespace {

/// What --at says: a number for some of the joints.
using Places = std::vector<std::optional<double>>;

Places asked_places(const Model& model, const Options& options) {
  Places places(model.joints.size());
  for (const std::string& words : options.places) {
    const std::size_t equals = words.rfind('=');
    const std::string name = words.substr(0, equals);
    double value = 0;
    DELASSUS_EXPECT(equals != words.npos && equals > 0 && CLI::detail::lexical_cast(words.substr(equals + 1), value) && std::isfinite(value),
                    "--at " + words + ": write JOINT=PLACE with a number of rad or m");
    std::size_t j = 0;
    std::string names;
    for (; j < model.joints.size() && model.joints[j].name != name; ++j)
      if (has_number(model.joints[j])) names += (names.empty() ? " '" : ", '") + model.joints[j].name + "'";
    DELASSUS_EXPECT(j < model.joints.size(), "--at " + words + ": there is no joint '" + name + "'; there is" + (names.empty() ? " none" : names));
    DELASSUS_EXPECT(has_number(model.joints[j]), "--at " + words + ": joint '" + name + "' is no hinge and no slide");
    DELASSUS_EXPECT(!follows(model, Index(j)), "--at " + words + ": joint '" + name + "' follows another; place that");
    places[j] = value;
  }
  return places;
}

/// Of the joints that move on this base; a root that the base frees stands where the tree has it.
void take_keyframe(const Model& model, const model::Keyframe& key, const JointSpace& space, JointNumbers& to) {
  const JointSpace file(model, Base::as_file);
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const model::JointKind kind = model.joints[j].kind;
    const int positions = kind == model::JointKind::free ? 7 : kind == model::JointKind::ball ? 4 : 1;
    const int rates = kind == model::JointKind::free ? 6 : kind == model::JointKind::ball ? 3 : 1;
    const Index q = space.q_of(Index(j)), v = space.v_of(Index(j)), from_q = file.q_of(Index(j)), from_v = file.v_of(Index(j));
    if (q < 0) {
      to.notes.push_back("the base is fixed: keyframe '" + key.name + "' does not move '" + model.joints[j].name + "'");
      continue;
    }
    for (int k = 0; k < positions && !key.q.empty(); ++k) to.q[std::size_t(q + k)] = key.q[std::size_t(from_q + k)];
    for (int k = 0; k < rates && !key.v.empty(); ++k) to.v[std::size_t(v + k)] = key.v[std::size_t(from_v + k)];
  }
}

/// Something else but its own axis may say where a joint is: then it stays where the file has it.
bool is_tied(const Model& model, Index joint) {
  return !model.connects.empty() || !model.welds.empty() ||
         std::any_of(model.couplings.begin(), model.couplings.end(), [&](const model::Coupling& c) { return c.joint == joint || c.other == joint; });
}

/// Pushed to its limits, a joint would start with a speed. True where one has moved.
bool take_limits(const Model& model, const JointSpace& space, const Places& places, JointNumbers& to) {
  bool any = false;
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const model::Joint& joint = model.joints[j];
    if (!has_number(joint) || !joint.is_limited || places[j] || is_tied(model, Index(j))) continue;
    double& at = to.q[std::size_t(space.q_of(Index(j)))];
    const double asked = at;
    at = std::clamp(at, joint.lower, joint.upper);
    if (at == asked) continue;
    any = true;
    to.notes.push_back("joint '" + joint.name + "' starts at its limit " + inner::text(at) + unit_of(joint) + ", since the file's " + inner::text(asked) + " is outside of " +
                       inner::text(joint.lower) + " and " + inner::text(joint.upper));
  }
  return any;
}

/// Moves those that follow, once what leads them is placed; a joint may follow one that follows.
void take_couplings(const Model& model, const JointSpace& space, JointNumbers& to) {
  for (std::size_t pass = 0; pass < model.couplings.size(); ++pass)
    for (const model::Coupling& c : model.couplings) {
      if (c.of_tendons || c.joint < 0) continue;
      const double s = c.other < 0 ? 0 : to.q[std::size_t(space.q_of(c.other))] - model.joints[std::size_t(c.other)].reference;
      double sum = 0;
      for (int k = 4; k >= 0; --k) sum = sum * s + c.coefficients[std::size_t(k)];
      to.q[std::size_t(space.q_of(c.joint))] = model.joints[std::size_t(c.joint)].reference + sum;
    }
}

}  // namespace

bool follows(const Model& model, Index joint) {
  return std::any_of(model.couplings.begin(), model.couplings.end(), [&](const model::Coupling& c) { return !c.of_tendons && c.joint == joint; });
}

const model::Keyframe* keyframe(const Model& model, const Options& options) {
  if (options.key.empty()) return nullptr;
  std::string names;
  for (const model::Keyframe& key : model.keyframes) {
    if (key.name == options.key) return &key;
    names += " '" + key.name + "'";
  }
  inner::refuse("model '" + model.name + "' has no keyframe '" + options.key + "'; it has" + (names.empty() ? " none" : names));
}

JointNumbers joint_numbers(const Model& model, Base base, const Options& options) {
  const model::Keyframe* const key = keyframe(model, options);
  const Places places = asked_places(model, options);
  const JointSpace space(model, base);
  JointNumbers numbers{.q = std::vector<double>(std::size_t(space.q_size())), .v = std::vector<double>(std::size_t(space.v_size()), 0), .notes = {}};
  space.reference(numbers.q);
  if (key) take_keyframe(model, *key, space, numbers);
  for (std::size_t j = 0; j < places.size(); ++j)
    if (places[j]) numbers.q[std::size_t(space.q_of(Index(j)))] = *places[j];
  bool has_moved = key || !options.places.empty();
  if (!key) has_moved = take_limits(model, space, places, numbers) || has_moved;
  if (!options.places.empty()) {
    take_couplings(model, space, numbers);
    if (!model.connects.empty() || !model.welds.empty())
      numbers.notes.push_back("bodies of the file are tied in loops: where --at opens one, the first step closes it");
  }
  if (!has_moved) numbers.q.clear(), numbers.v.clear();
  return numbers;
}

}  // namespace delassus_run
