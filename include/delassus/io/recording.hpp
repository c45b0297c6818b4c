/// What a replay holds: the bodies of one scene, frames of their motion, and a sample of every series per
/// step.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/core/index.hpp>
#include <delassus/geometry/convex_hull.hpp>
#include <delassus/geometry/shape.hpp>
#include <delassus/math/linear.hpp>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace delassus {

/// How one body looks, or one part of it. Made by `recorded_body`, `recorded_surface` or `recorded_particle`,
/// so that a hull is copied and not pointed at.
struct RecordedBody {
  Shape shape;  ///< without its hull, which `vertices` and `faces` are
  std::vector<Vec3> vertices{};             ///< of a convex hull or a surface, m
  std::vector<std::vector<Index>> faces{};  ///< of the same, counter-clockwise from outside
  bool is_static = false;                 ///< drawn where the first frame has it
  bool is_particle = false;               ///< its rotation is not kept
  int colour = -1;  ///< place in the page's palette (0 … 7), −1: one after the other
};

/// A mesh and a compound, which only their backend knows, have no look of their own: `Recorder` asks it.
inline RecordedBody recorded_body(const Shape& shape, bool is_static = false) {
  RecordedBody body{.shape = shape.is_kept() ? Shape{} : shape, .is_static = is_static};
  if (shape.kind != ShapeKind::convex_hull) return body;
  body.vertices.assign(shape.hull->vertices().begin(), shape.hull->vertices().end());
  for (Index f = 0; f < shape.hull->face_count(); ++f)
    body.faces.emplace_back(shape.hull->face(f).begin(), shape.hull->face(f).end());
  body.shape.hull = nullptr;
  return body;
}

/// Polygons over vertices, in the place of a hull: they need not be convex together.
inline RecordedBody recorded_surface(std::vector<Vec3> vertices, std::vector<std::vector<Index>> faces, bool is_static = false) {
  RecordedBody body{.shape = {}, .vertices = std::move(vertices), .faces = std::move(faces), .is_static = is_static};
  body.shape.kind = ShapeKind::convex_hull;
  return body;
}

/// A point drawn as a ball. `radius` in m.
inline RecordedBody recorded_particle(double radius) {
  return {.shape = Sphere{radius}, .is_particle = true};
}

/// Of one body in one frame.
struct RecordedPose {
  Vec3 position = Vec3::Zero();  ///< m, world
  Quat rotation = Quat::Identity();  ///< from the axes of the body to the world's
};

/// What a contact does.
enum class RecordedState : std::uint8_t { open /**< it has no impulse */, sliding /**< λ is on the cone */, sticking /**< λ is within the cone */ };

/// One contact. `impulse` is the one on the body that is to be drawn pushed, N·s over the step of the frame.
struct RecordedContact {
  Vec3 point = Vec3::Zero();  ///< m, world
  Vec3 impulse = Vec3::Zero();  ///< world axes
  RecordedState state = RecordedState::sticking;  ///< drawn in its own way
  Vec3 normal = Vec3::Zero();  ///< unit, from A to B; the replay page does without
};

/// A joint: a line between two points, a dot where they coincide.
struct RecordedLine {
  /// One end, m, world.
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();  ///< the other, m, world
};

/// One picture. `poses` has one entry per body, in the order of `Recording::bodies`.
struct RecordedFrame {
  double time = 0;  ///< s, simulated
  std::vector<RecordedPose> poses;  ///< by body
  std::vector<RecordedContact> contacts;  ///< those that shall be drawn
  std::vector<RecordedLine> lines;  ///< joints, and edges of soft bodies
};

/// Milliseconds of one stage, one per step.
struct RecordedStage {
  std::string name;  ///< for the legend
  std::vector<double> milliseconds;  ///< by step
};

/// The series, one entry per step each. A series that nobody measured stays empty and is not drawn.
struct RecordedSteps {
  std::vector<double> time;      ///< s, ascending
  std::vector<double> energy;    ///< J
  std::vector<double> residual;  ///< relative, ≥ 0, drawn on a logarithmic axis
  std::vector<double> sweeps;    ///< iterations of the solver
  std::vector<RecordedStage> stages;  ///< drawn one above the other
  double tolerance = 0;  ///< drawn as a line across the residual; 0: none

  /// Throws InvalidArgument when a series is neither empty nor as long as `time`.
  void check(const std::string& where) const {
    check_length(energy, "energy", where);
    check_length(residual, "residual", where);
    check_length(sweeps, "sweeps", where);
    for (const RecordedStage& stage : stages) check_length(stage.milliseconds, stage.name, where);
  }

 private:
  void check_length(const std::vector<double>& series, const std::string& name,
                    const std::string& where) const {
    DELASSUS_EXPECT(series.empty() || series.size() == time.size(),
                    where + ": series '" + name + "' has " + std::to_string(series.size()) + " samples for " +
                        std::to_string(time.size()) + " steps");
  }
};

/// One scene of the replay.
struct Recording {
  std::string name;  ///< of the scene
  std::string caption;  ///< one sentence under the name
  std::vector<RecordedBody> bodies;  ///< in the order of the poses of a frame
  std::vector<RecordedFrame> frames;  ///< ascending in time
  RecordedSteps steps;  ///< the series
  Vec3 up = Vec3::UnitZ();        ///< against gravity, for the camera
  double frames_per_second = 30;  ///< at most

  /// True when the next picture is due at `time` (s): ask before gathering one.
  bool wants_frame(double time) const {
    return frames.empty() || (time - frames.front().time) * frames_per_second > double(frames.size()) - 1e-6;
  }
};

namespace inner {

/// Throws InvalidArgument when a frame has not one pose per body or a series has not one sample per step.
inline void check_recording(const Recording& recording) {
  const std::string who = "recording '" + recording.name + "'";
  DELASSUS_EXPECT(!recording.frames.empty(), who + " has no frame");
  DELASSUS_EXPECT(recording.frames_per_second > 0, who + ": frames_per_second must be > 0");
  for (std::size_t f = 0; f < recording.frames.size(); ++f)
    DELASSUS_EXPECT(recording.frames[f].poses.size() == recording.bodies.size(),
                    who + ": frame #" + std::to_string(f) + " has " +
                        std::to_string(recording.frames[f].poses.size()) + " poses for " +
                        std::to_string(recording.bodies.size()) + " bodies");
  for (std::size_t b = 0; b < recording.bodies.size(); ++b) {
    const RecordedBody& body = recording.bodies[b];
    DELASSUS_EXPECT(
        body.shape.kind != ShapeKind::convex_hull || !body.faces.empty(),
        who + ": the hull of body #" + std::to_string(b) + " has no faces; make it by recorded_body(shape)");
  }
  recording.steps.check(who);
}

}  // namespace inner
}  // namespace delassus
