// A machine as its run begins.
#include "start.hpp"

#include "joint_numbers.hpp"

#include <delassus/geometry/support.hpp>
#include <delassus/model/actuators.hpp>
#include <delassus/model/inner/add_shapes.hpp>
#include <delassus/model/inner/contact_kinds.hpp>
#include <delassus/model/joint_space.hpp>
#include <delassus/study/code_of.hpp>

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace delassus_run {

namespace {

Index root_of(const Model& model, Index link) {
  while (model.bodies[std::size_t(link)].parent >= 0) link = model.bodies[std::size_t(link)].parent;
  return link;
}

bool collides(const Model& model, const model::Geometry& geometry) {
  return geometry.type != 0 || geometry.affinity != 0 || inner::is_paired(model, Index(&geometry - model.geometries.data()));
}

/// The lowest point of what a machine moves, m; 0 where it has no shape.
double lowest_point(const Model& model, const std::vector<Pose>& at) {
  inner::ModelShapes shapes(model);
  double lowest = std::numeric_limits<double>::infinity();
  for (const model::Geometry& geometry : model.geometries) {
    if (geometry.body < 0 || !collides(model, geometry)) continue;
    const auto [shape, pose] = shapes.placed(geometry, at[std::size_t(geometry.body)]);
    if (shape.kind == ShapeKind::none || shape.kind == ShapeKind::half_space) continue;
    const Vec3 down = transposed_times(pose.rotation, Vec3(0, 0, -1));
    lowest = std::min(lowest, pose.to_world(support(shape, down)).z());
  }
  return std::isfinite(lowest) ? lowest : 0;
}

}  // namespace

Index link_of(const Machine& machine, const Anchor& body) {
  for (std::size_t b = 0; b < machine.parts.size(); ++b)
    if (!machine.parts[b].is_world && !body.is_world() && machine.parts[b].body.index == body.block) return Index(b);
  return -1;
}

Start::Start(const Model& model, const Options& options) : model_(model), base_(options.base), key_(keyframe(model_, options)), own_actuators_(model.actuators.size()) {
  JointNumbers numbers = joint_numbers(model_, base_, options);
  q_ = std::move(numbers.q), v_ = std::move(numbers.v), notes = std::move(numbers.notes);
  if (!options.hold.empty()) add_holders(options);
  if (options.has_ground) find_floor(options);
  const std::unique_ptr<Motion> first = put({});
  tell_limits(*first), tell_fall(*first);
  find_overlaps(*first, options);
}

/// A servo for each joint that nothing else drives. It has the cap of the joint.
void Start::add_holders(const Options& options) {
  const double stiffness = options.hold[0], damping = options.hold.size() > 1 ? options.hold[1] : Options::usual_damping * stiffness;
  const auto is_driven = [&](Index joint) {
    return std::any_of(model_.actuators.begin(), model_.actuators.end(),
                       [&](const model::Actuator& a) { return a.transmission == model::Transmission::joint && a.target == joint; });
  };
  for (std::size_t j = 0; j < model_.joints.size(); ++j) {
    const model::Joint& joint = model_.joints[j];
    if (!has_number(joint) || follows(model_, Index(j)) || is_driven(Index(j))) continue;
    model::Actuator servo{.name = joint.name, .target = Index(j), .gain = stiffness, .bias = {0, -stiffness, -damping}};
    servo.force_is_limited = joint.effort > 0;
    servo.force_lower = -joint.effort, servo.force_upper = joint.effort;
    model_.actuators.push_back(servo);
  }
  if (model_.actuators.size() == own_actuators_) notes.push_back("no joint is left for --hold: each has an actuator or follows another");
}

/// The pose that sets the machine on z = 0 or above it, unless the file has a floor.
void Start::find_floor(const Options& options) {
  for (const model::Geometry& geometry : model_.geometries)
    if (geometry.body < 0 && collides(model_, geometry) && (std::holds_alternative<model::Plane>(geometry.shape) || std::holds_alternative<model::FieldOf>(geometry.shape))) {
      const bool is_plane = std::holds_alternative<model::Plane>(geometry.shape);
      notes.push_back(is_plane ? "the file has a floor of its own: --ground adds none and lifts nothing"
                               : "the file has a height field, which does not act here: --ground adds a level floor at z = 0");
      if (is_plane) return;
    }
  adds_floor_ = true;
  JointSpace space(model_, base_);
  std::vector<double> q(std::size_t(space.q_size()));
  space.reference(q);
  if (!q_.empty()) q = q_;
  std::vector<Pose> at(model_.bodies.size());
  space.poses(q, at);
  const double lift = options.height - lowest_point(model_, at);
  pose_.position[2] = lift;
  // A free joint counts from the world, whatever the frame of the model is.
  if (q_.empty()) return;
  const JointSpace lifted(model_, base_, pose_);
  std::vector<double> reference(q_.size()), before(q_.size());
  lifted.reference(reference), space.reference(before);
  for (std::size_t k = 0; k < q_.size(); ++k) q_[k] += reference[k] - before[k];
}

std::unique_ptr<Motion> Start::put(const Asked& asked) const {
  std::unique_ptr<Motion> motion = moved(model_, pose_, base_, asked);
  Machine& machine = motion->machine;
  if (adds_floor_) motion->set().add_fixed(HalfSpace{});
  JointSpace space(model_, base_, pose_);
  if (!q_.empty()) motion->set_joints(space, q_, v_);
  motion->joints.resize(model_.joints.size());
  for (std::size_t j = 0; j < model_.joints.size(); ++j)
    if (has_number(model_.joints[j])) motion->joints[j] = q_.empty() ? model_.joints[j].reference : q_[std::size_t(space.q_of(Index(j)))];
  if (key_) {
    model::Keyframe key = *key_;
    if (!key.control.empty()) key.control.resize(machine.actuators.size());
    set_controls(machine, key);
  }
  for (std::size_t k = own_actuators_; k < machine.actuators.size(); ++k) machine.controls[k] = motion->joints[std::size_t(model_.actuators[k].target)];
  return motion;
}

void Start::tell_limits(const Motion& motion) {
  for (std::size_t j = 0; j < model_.joints.size(); ++j) {
    const model::Joint& joint = model_.joints[j];
    const model::Axis& axis = motion.machine.axes[j];
    if (!has_number(joint) || !joint.is_limited || (axis.a.is_world() && axis.b.is_world())) continue;
    const double q = motion.joints[j], slack = 1e-9 * (1 + std::abs(joint.lower) + std::abs(joint.upper));
    if (q >= joint.lower - slack && q <= joint.upper + slack) continue;
    notes.push_back("joint '" + joint.name + "' starts at " + inner::text(q) + unit_of(joint) + ", outside of its limits " + inner::text(joint.lower) + " and " +
                    inner::text(joint.upper) + ", and is pushed back");
  }
}

/// A robot whose base is free, and nothing to stand on.
void Start::tell_fall(const Motion& motion) {
  const bool has_something = adds_floor_ || std::any_of(model_.geometries.begin(), model_.geometries.end(),
                                                        [&](const model::Geometry& geometry) { return geometry.body < 0 && collides(model_, geometry); });
  if (has_something || is_zero(model_.gravity)) return;
  for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
    const model::Body& body = model_.bodies[b];
    const bool is_free = body.joints.empty() || (body.joints.size() == 1 && model_.joints[std::size_t(body.joints[0])].kind == model::JointKind::free);
    if (body.parent >= 0 || body.is_kinematic || motion.machine.parts[b].is_world || !is_free) continue;
    notes.push_back("nothing holds '" + body.name + "' and there is no floor: it falls; --base fixed holds it, --ground adds a floor");
    return;
  }
}

/// What joints hold cannot be pushed apart: bodies of one tree that are in each other by more than rest leaves.
void Start::find_overlaps(Motion& motion, const Options& options) {
  constexpr double most = 1e-3;  // m
  std::map<std::pair<Index, Index>, double> deepest;
  motion.step(1e-9);
  for (const ContactResult& contact : motion.contacts()) {
    const Index a = link_of(motion.machine, contact.record.a), b = link_of(motion.machine, contact.record.b);
    if (a < 0 || b < 0 || contact.record.gap > -most || root_of(model_, a) != root_of(model_, b)) continue;
    double& gap = deepest[std::minmax(a, b)];
    gap = std::min(gap, contact.record.gap);
  }
  for (const auto& [pair, gap] : deepest) {
    const auto name = [&](Index link) { return "'" + model_.bodies[std::size_t(link)].name + "'"; };
    notes.push_back("links " + name(pair.first) + " and " + name(pair.second) + " are " + inner::number_text(-gap, 2) + " m in each other at the start, " +
                    (options.pushes_apart ? "and are pushed apart" : "and do not collide; --push-apart lets them"));
    if (!options.pushes_apart) model_.excludes.push_back({.body = pair.first, .other = pair.second});
  }
}

}  // namespace delassus_run
