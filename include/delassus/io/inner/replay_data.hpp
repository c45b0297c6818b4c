/// A recording as the JSON that the page reads: words in base64, everything else in plain numbers.
#pragma once

#include <delassus/io/inner/quantised.hpp>
#include <delassus/io/inner/replay_plan.hpp>
#include <delassus/io/recording.hpp>

#include <map>
#include <span>
#include <string>
#include <vector>

namespace delassus::inner {

template <class Numbers>
void append_numbers(std::string& out, const Numbers& numbers) {
  out += '[';
  bool first = true;
  for (const auto x : numbers) {
    if (!first) out += ',';
    first = false;
    append_number(out, double(x));
  }
  out += ']';
}

/// {"kind":…, "size":[…]}: full edge lengths; radius and height; semi-axes; unit normal and offset; or
/// vertices and faces.
inline std::string shape_json(const RecordedBody& body) {
  static constexpr const char* kinds[] = {"none",       "sphere", "box",  "capsule",  "cylinder",
                                          "half_space", "hull",   "cone", "ellipsoid"};
  const auto& s = body.shape.size;
  std::string out =
      std::string("{\"kind\":\"") + (body.is_particle ? "particle" : kinds[int(body.shape.kind)]) + '"';
  out += ",\"size\":";
  switch (body.shape.kind) {
    case ShapeKind::box:
      append_numbers(out, std::array{2 * s[0], 2 * s[1], 2 * s[2]});
      break;
    case ShapeKind::capsule:
    case ShapeKind::cylinder:
    case ShapeKind::cone:
      append_numbers(out, std::array{s[0], 2 * s[1]});
      break;
    case ShapeKind::ellipsoid:
      append_numbers(out, std::array{s[0], s[1], s[2]});
      break;
    case ShapeKind::half_space:
      append_numbers(out, s);
      break;
    default:
      append_numbers(out, std::array{s[0]});
  }
  if (body.shape.kind == ShapeKind::convex_hull) {
    std::vector<double> flat;
    for (const Vec3& v : body.vertices) flat.insert(flat.end(), v.begin(), v.end());
    append_numbers(out += ",\"vertices\":", flat);
    out += ",\"faces\":[";
    for (std::size_t f = 0; f < body.faces.size(); ++f)
      append_numbers(out += f > 0 ? "," : "", body.faces[f]);
    out += ']';
  }
  return out + '}';
}

/// Equal shapes are written once: "shapes":[…], then "bodies":[[shape, colour, position and rotation if
/// static], …].
inline void append_bodies(std::string& out, const Recording& recording) {
  std::map<std::string, std::size_t> place;
  std::string shapes, bodies;
  for (std::size_t b = 0; b < recording.bodies.size(); ++b) {
    const RecordedBody& body = recording.bodies[b];
    const auto [shape, is_new] = place.try_emplace(shape_json(body), place.size());
    if (is_new) (shapes += shapes.empty() ? "" : ",") += shape->first;
    (bodies += b > 0 ? ",[" : "[") += std::to_string(shape->second) + ',' + std::to_string(body.colour);
    if (body.is_static) {
      const RecordedPose& pose = recording.frames.front().poses[b];
      for (const double x : pose.position) append_number(bodies += ',', x);
      for (const double x : pose.rotation.coeffs()) append_number(bodies += ',', x);
    }
    bodies += ']';
  }
  out += "\"shapes\":[" + shapes + "],\"bodies\":[" + bodies + ']';
}

/// The kept frames, in the order in which the page reads them.
class FrameWriter {
 public:
  FrameWriter(const Recording& recording, const ReplayPlan& plan)
      : recording_(recording), kept_(kept_frames(recording, plan.frames_per_second)), most_(plan.contacts) {
    for (const std::size_t f : kept_) bound(recording_.frames[f]);
    poses_.resize(recording.bodies.size());
    for (const std::size_t f : kept_) write(recording_.frames[f]);
  }

  void append_to(std::string& out) const {
    std::vector<double> times;
    for (const std::size_t f : kept_) times.push_back(recording_.frames[f].time);
    append_numbers(out += "\"times\":", times);
    append_numbers(out += ",\"low\":", std::array{box_[0].low, box_[1].low, box_[2].low});
    append_numbers(out += ",\"high\":", std::array{box_[0].high, box_[1].high, box_[2].high});
    append_number(out += ",\"impulse\":", impulse_.high);
    positions_.append_to(out += ",\"positions\":");
    rotations_.append_to(out += ",\"rotations\":");
    contact_counts_.append_to(out += ",\"contactCounts\":");
    contacts_.append_to(out += ",\"contacts\":");
    append_base64(out += ",\"contactStates\":\"", states_);
    line_counts_.append_to(out += "\",\"lineCounts\":");
    lines_.append_to(out += ",\"lines\":");
  }

 private:
  void bound(const RecordedFrame& frame) {
    for (std::size_t b = 0; b < frame.poses.size(); ++b)
      if (!recording_.bodies[b].is_static) include(frame.poses[b].position);
    for (const RecordedLine& line : frame.lines) include(line.from), include(line.to);
    for (const RecordedContact& contact : frame.contacts) {
      include(contact.point);
      for (const double x : contact.impulse) impulse_.include(std::abs(x));
    }
  }
  void include(const Vec3& p) {
    for (int k = 0; k < 3; ++k) box_[k].include(p[k]);
  }

  void write(const RecordedFrame& frame) {
    for (std::size_t b = 0; b < frame.poses.size(); ++b)
      if (!recording_.bodies[b].is_static)
        write_pose(frame.poses[b], recording_.bodies[b].is_particle, poses_[b]);
    write_contacts(frame);
    line_counts_.push(std::uint16_t(std::min<std::size_t>(frame.lines.size(), 65535)));
    for (std::size_t i = 0; i < frame.lines.size() && i < 65535; ++i) {
      push_point(lines_, frame.lines[i].from);
      push_point(lines_, frame.lines[i].to);
    }
  }

  /// A pose that is not finite repeats the last one that was.
  void write_pose(const RecordedPose& pose, bool is_particle, RecordedPose& last) {
    if (is_finite(pose.position) && is_finite(pose.rotation.coeffs())) last = pose;
    push_point(positions_, last.position);
    if (is_particle) return;
    for (const std::uint16_t word : turn_code(last.rotation)) rotations_.push(word);
  }

  void write_contacts(const RecordedFrame& frame) {
    const std::vector<std::size_t> kept = kept_contacts(frame, most_);
    contact_counts_.push(std::uint16_t(kept.size()));
    contact_counts_.push(std::uint16_t(std::min<std::size_t>(frame.contacts.size(), 65535)));
    for (const std::size_t c : kept) {
      const RecordedContact& contact = frame.contacts[c];
      push_point(contacts_, contact.point);
      // A sign and 15 bits of the largest component, 32768 meaning zero.
      const double scale = impulse_.high > 0 ? 32767 / impulse_.high : 0;
      for (const double x : contact.impulse) contacts_.push(std::uint16_t(32768 + std::lround(x * scale)));
      states_ += char(contact.state);
    }
  }

  void push_point(Words& words, const Vec3& p) {
    for (int k = 0; k < 3; ++k) words.push(box_[k].code(p[k]));
  }

  const Recording& recording_;
  std::vector<std::size_t> kept_;
  std::size_t most_;
  Interval box_[3], impulse_{0, 0};
  std::vector<RecordedPose> poses_;
  Words positions_, rotations_, contact_counts_, contacts_, line_counts_, lines_;
  std::string states_;
};

/// [low, high, words]: the interval in 65533 parts; the last two words mean minus infinity and no number.
/// A logarithmic series holds log₁₀.
inline void append_series(std::string& out, std::vector<double> values, bool is_logarithmic = false) {
  if (is_logarithmic)
    for (double& x : values) x = x >= 0 ? std::log10(x) : std::nan("");
  Interval range;
  for (const double x : values) range.include(x);
  if (range.is_empty()) range = {0, 0};
  Words words;
  for (const double x : values) {
    const bool is_lowest = is_logarithmic && x < 0 && std::isinf(x);
    words.push(is_lowest ? 65534 : std::isfinite(x) ? range.code(x, 65533) : 65535);
  }
  append_number(out += '[', range.low, 12);
  append_number(out += ',', range.high, 12);
  words.append_to(out += ',');
  out += ']';
}

inline void append_steps(std::string& out, const RecordedSteps& steps) {
  const std::size_t width = steps_per_sample(steps.time.size());
  out += "\"series\":{\"width\":" + std::to_string(width);
  append_number(out += ",\"tolerance\":", steps.tolerance);
  append_series(out += ",\"time\":", reduced(steps.time, width, Keep::last));
  append_series(out += ",\"energy\":", reduced(steps.energy, width, Keep::last));
  append_series(out += ",\"residual\":", reduced(steps.residual, width, Keep::largest), true);
  append_series(out += ",\"sweeps\":", reduced(steps.sweeps, width, Keep::largest));
  out += ",\"stages\":[";
  for (std::size_t s = 0; s < steps.stages.size(); ++s) {
    append_string(out += s > 0 ? ",[" : "[", steps.stages[s].name);
    append_series(out += ',', reduced(steps.stages[s].milliseconds, width, Keep::mean));
    out += ']';
  }
  out += "]}";
}

inline void append_recording(std::string& out, const Recording& recording, const ReplayPlan& plan) {
  append_string(out += "{\"name\":", recording.name);
  append_string(out += ",\"caption\":", recording.caption);
  append_numbers(out += ",\"up\":", recording.up.normalized().eval());
  append_bodies(out += ',', recording);
  FrameWriter(recording, plan).append_to(out += ',');
  append_steps(out += ',', recording.steps);
  out += '}';
}

}  // namespace delassus::inner
