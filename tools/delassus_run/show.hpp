/// A machine as a recording: one body a shape, one pose a frame, the numbers of its joints as a table.
#pragma once

#include <delassus/delassus.hpp>
#include <delassus/geometry/support.hpp>
#include <delassus/io/recording.hpp>
#include <delassus/io/table.hpp>
#include <delassus/model/add.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace delassus_run {

using namespace delassus;

/// The lowest point of what a machine moves, m; 0 where it has no shape.
inline double lowest_point(const Model& model) {
  std::vector<Pose> at(model.bodies.size());
  for (std::size_t b = 0; b < at.size(); ++b)
    at[b] = model.bodies[b].parent < 0 ? model.bodies[b].pose : inner::Lumps::in(at[std::size_t(model.bodies[b].parent)], model.bodies[b].pose);
  inner::ModelShapes shapes(model);
  double lowest = std::numeric_limits<double>::infinity();
  for (const model::Geometry& geometry : model.geometries) {
    if (geometry.body < 0 || (geometry.type == 0 && geometry.affinity == 0)) continue;
    const auto [shape, pose] = shapes.placed(geometry, at[std::size_t(geometry.body)]);
    if (shape.kind == ShapeKind::none || shape.kind == ShapeKind::half_space) continue;
    const Vec3 down = transposed_times(pose.rotation, Vec3(0, 0, -1));
    lowest = std::min(lowest, pose.to_world(support(shape, down)).z());
  }
  return std::isfinite(lowest) ? lowest : 0;
}

class Show {
 public:
  Recording recording;
  Table joints;  ///< q of hinges and slides, a row a step

  Show(const Model& model, const Machine& machine, const Pose& pose, bool has_ground) : model_(model), machine_(machine), pose_(pose) {
    recording.name = model.name;
    recording.caption = "Shapes as collisions see them.";
    inner::ModelShapes shapes(model);
    for (const model::Geometry& geometry : model.geometries) {
      const auto placed = shapes.placed(geometry, {});
      if (placed.shape.kind == ShapeKind::none) continue;
      const bool is_still = geometry.body < 0 || machine.parts[std::size_t(geometry.body)].is_world;
      recording.bodies.push_back(recorded_body(placed.shape, is_still));
      drawn_.push_back({geometry.body, placed.pose});
    }
    if (has_ground) recording.bodies.push_back(recorded_body(HalfSpace{}, true)), drawn_.push_back({-1, {pose.to_local(Pose{})}});
    joints = {.title = model.name, .columns = {"time (s)", "kinetic energy (J)", "contacts", "residual", "joint gap (m)", "penetration (m)"}};
    for (std::size_t j = 0; j < model.joints.size(); ++j)
      if (has_number(j)) joints.columns.push_back(model.joints[j].name + (model.joints[j].kind == model::JointKind::hinge ? " (rad)" : " (m)"));
  }

  void take(const auto& loop, const StepReport& report, double kinetic, double potential) {
    std::vector<Cell> row{Cell(loop.time(), 9), Cell(kinetic, 9), Index(loop.contacts().size()), Cell(report.residual, 3),
                          Cell(report.max_joint_violation, 3), Cell(report.max_penetration, 3)};
    for (std::size_t j = 0; j < model_.joints.size(); ++j)
      if (has_number(j)) row.push_back(Cell(position_of(loop.world(), machine_, Index(j)), 12));
    joints.add(std::move(row));
    recording.steps.time.push_back(loop.time());
    recording.steps.energy.push_back(kinetic + potential);
    recording.steps.residual.push_back(report.residual);
    recording.steps.sweeps.push_back(report.sweeps);
    if (recording.wants_frame(loop.time())) take_frame(loop);
  }

 private:
  struct Drawn {
    Index body;
    Pose pose;  ///< of the shape in the link
  };
  bool has_number(std::size_t j) const {
    return model_.joints[j].kind == model::JointKind::hinge || model_.joints[j].kind == model::JointKind::slide;
  }

  void take_frame(const auto& loop) {
    RecordedFrame frame;
    frame.time = loop.time();
    const auto& set = bodies<RigidBodies>(loop.world());
    for (const Drawn& drawn : drawn_) {
      const Pose link = drawn.body < 0 ? pose_ : pose_of(set, machine_, drawn.body);
      frame.poses.push_back({link.to_world(drawn.pose.position), Quat(Mat3(link.rotation * drawn.pose.rotation))});
    }
    for (const auto& c : loop.contacts())
      if (c.impulse.dot(c.record.normal) > 0)
        frame.contacts.push_back({c.record.point(), c.impulse, c.is_sliding ? RecordedState::sliding : RecordedState::sticking});
    loop.each_joint([&](const Anchor& a, const Anchor& b) { frame.lines.push_back({loop.world().point(a), loop.world().point(b)}); });
    recording.frames.push_back(std::move(frame));
  }

  const Model& model_;
  const Machine& machine_;
  const Pose pose_;  ///< of the model's frame in the world
  std::vector<Drawn> drawn_;
};

}  // namespace delassus_run
