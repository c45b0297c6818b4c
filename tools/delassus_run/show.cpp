// A machine as a recording, and as rows of a table.
#include "show.hpp"

#include <delassus/io/csv.hpp>
#include <delassus/model/inner/add_shapes.hpp>

#include <cmath>
#include <numbers>

namespace delassus_run {

namespace {

Quat turn_of(const Pose& pose) { return unit(Quat(pose.rotation)); }

/// The triangles of a height field over its grid.
RecordedBody recorded_field(const model::HeightField& field) {
  std::vector<Vec3> points;
  std::vector<std::vector<Index>> faces;
  for (Index r = 0; r < field.rows; ++r)
    for (Index c = 0; c < field.columns; ++c) {
      const std::size_t at = std::size_t(r) * std::size_t(field.columns) + std::size_t(c);
      points.push_back({field.half_x * (2. * c / (field.columns - 1) - 1), field.half_y * (2. * r / (field.rows - 1) - 1), field.heights[at]});
      const Index p = Index(at);
      if (r > 0 && c > 0) faces.push_back({p - field.columns - 1, p - field.columns, p}), faces.push_back({p - field.columns - 1, p, p - 1});
    }
  return recorded_surface(std::move(points), std::move(faces), true);
}

}  // namespace

Show::Show(const Model& model, const Motion& motion, const Pose& pose, bool has_floor, double frames_per_second) : pose_(pose) {
  recording.name = model.name;
  recording.caption = "Shapes as collisions see them.";
  recording.frames_per_second = frames_per_second;
  inner::ModelShapes shapes(model);
  for (const model::Geometry& geometry : model.geometries) {
    const auto placed = shapes.placed(geometry, {});
    const bool is_still = geometry.body < 0 || motion.machine.parts[std::size_t(geometry.body)].is_world;
    if (placed.shape.kind != ShapeKind::none) {
      recording.bodies.push_back(recorded_body(placed.shape, is_still));
    } else if (const auto* field = std::get_if<model::FieldOf>(&geometry.shape)) {
      recording.bodies.push_back(recorded_field(model.height_fields[std::size_t(field->field)]));
    } else if (const auto* of = std::get_if<model::TrianglesOf>(&geometry.shape)) {
      const model::Mesh& mesh = model.meshes[std::size_t(of->mesh)];
      std::vector<std::vector<Index>> faces;
      for (const auto& t : mesh.triangles) faces.emplace_back(t.begin(), t.end());
      recording.bodies.push_back(recorded_surface(mesh.vertices, std::move(faces), is_still));
    } else {
      continue;
    }
    drawn_.push_back({geometry.body, placed.pose});
  }
  if (has_floor) recording.bodies.push_back(recorded_body(HalfSpace{}, true)), drawn_.push_back({-1, pose.to_local(Pose{})});
}

bool Show::take(const Motion& motion, const StepReport& report, double energy) {
  recording.steps.time.push_back(motion.time());
  recording.steps.energy.push_back(energy);
  recording.steps.residual.push_back(report.residual);
  recording.steps.sweeps.push_back(report.sweeps);
  if (!recording.wants_frame(motion.time())) return false;
  recording.frames.push_back(frame(motion));
  return true;
}

RecordedFrame Show::frame(const Motion& motion) const {
  RecordedFrame frame;
  frame.time = motion.time();
  for (const Drawn& drawn : drawn_) {
    const Pose link = drawn.link < 0 ? pose_ : pose_of(motion.set(), motion.machine, drawn.link);
    frame.poses.push_back({link.to_world(drawn.pose.position), turn_of({{}, Mat3(link.rotation * drawn.pose.rotation)})});
  }
  for (const ContactResult& c : motion.contacts())
    if (dot(c.impulse, c.record.normal) > 0)
      frame.contacts.push_back({c.record.point(), c.impulse, c.is_sliding ? RecordedState::sliding : RecordedState::sticking, c.record.normal});
  motion.each_joint([&](const Anchor& a, const Anchor& b) { frame.lines.push_back({motion.world().point(a), motion.world().point(b)}); });
  return frame;
}

Rows::Rows(std::string path, const Model& model, const Motion& motion) : path_(std::move(path)) {
  for (const char* name : {"time (s)", "kinetic energy (J)", "contacts", "residual", "joint gap (m)", "penetration (m)"}) column(name);
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const model::JointKind kind = model.joints[j].kind;
    const model::Axis& axis = motion.machine.axes[j];
    if ((kind != model::JointKind::hinge && kind != model::JointKind::slide) || (axis.a.is_world() && axis.b.is_world())) continue;
    joints_.push_back(Index(j)), is_turn_.push_back(kind == model::JointKind::hinge), last_.push_back(motion.joints[j]);
    column(model.joints[j].name + (kind == model::JointKind::hinge ? " (rad)" : " (m)"));
  }
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const model::Body& body = model.bodies[b];
    const bool is_free = body.joints.size() == 1 && model.joints[std::size_t(body.joints[0])].kind == model::JointKind::free;
    if (motion.machine.parts[b].is_world || body.is_kinematic || !(is_free || (body.parent < 0 && body.joints.empty()))) continue;
    roots_.push_back(Index(b));
    const char* const units[] = {" (m)", "", " (m/s)", " (rad/s)"};
    const std::vector<const char*> names[] = {{"x", "y", "z"}, {"qw", "qx", "qy", "qz"}, {"vx", "vy", "vz"}, {"wx", "wy", "wz"}};
    for (int k = 0; k < 4; ++k)
      for (const char* name : names[k]) column(body.name + "." + name + units[k]);
  }
  file_ = std::fopen(path_.c_str(), "wb");
  DELASSUS_EXPECT(file_ != nullptr, "cannot open '" + path_ + "' for writing; does its folder exist, and may you write there?");
  line_ += '\n';
}

Rows::~Rows() {
  if (file_) std::fclose(file_);
}

void Rows::column(const std::string& name) {
  if (!line_.empty()) line_ += ',';
  inner::append_field(line_, name);
}
void Rows::number(double value, int digits) {
  if (!line_.empty() && line_.back() != '\n') line_ += ',';
  line_ += inner::number_text(value, digits);
}

void Rows::take(const Motion& motion, const StepReport& report, double kinetic) {
  number(motion.time(), 9), number(kinetic, 9), number(double(motion.contacts().size()), 9);
  for (const double x : {report.residual, report.max_joint_violation, report.max_penetration}) number(x, 3);
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    double q = position_of(motion.world(), motion.machine, joints_[k]);
    // An angle goes on through π, as limits and springs count it.
    if (is_turn_[k]) q += 2 * std::numbers::pi * std::round((last_[k] - q) / (2 * std::numbers::pi));
    number(last_[k] = q, 12);
  }
  for (const Index b : roots_) {
    const Pose pose = pose_of(motion.set(), motion.machine, b);
    const auto body = motion.machine.parts[std::size_t(b)].body;
    const Quat turn = turn_of(pose);
    const Vec3 spin = motion.set().angular_velocity(body);
    const Vec3 velocity = motion.set().velocity(body) + cross(spin, Vec3(pose.position - motion.set().position(body)));
    const Vec3 own_spin = transposed_times(pose.rotation, spin);
    for (int k = 0; k < 3; ++k) number(pose.position[k], 12);
    for (const double x : {turn.w(), turn.x(), turn.y(), turn.z()}) number(x, 12);
    for (int k = 0; k < 3; ++k) number(velocity[k], 12);
    for (int k = 0; k < 3; ++k) number(own_spin[k], 12);
  }
  line_ += '\n';
  DELASSUS_EXPECT(std::fwrite(line_.data(), 1, line_.size(), file_) == line_.size(), "cannot write all of '" + path_ + "'; is the disk full?");
  line_.clear();
}

void Rows::close() {
  const bool is_closed = std::fclose(file_) == 0;
  file_ = nullptr;
  DELASSUS_EXPECT(is_closed, "cannot write all of '" + path_ + "'; is the disk full?");
}

}  // namespace delassus_run
