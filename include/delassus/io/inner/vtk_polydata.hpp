/// A recorded frame as the XML of VTK's polygons.
#pragma once

#include <delassus/io/inner/drawn_polygons.hpp>
#include <delassus/io/inner/text.hpp>
#include <delassus/io/recording.hpp>
#include <delassus/math/pose.hpp>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

namespace delassus::inner {

/// Points with what they carry, and cells over them by kind.
class VtkPolyData {
 public:
  struct Cells {
    std::vector<std::int32_t> corners, ends, body;
    void add(std::span<const Index> points, Index first, Index of) {
      for (const Index p : points) corners.push_back(first + p);
      ends.push_back(std::int32_t(corners.size()));
      body.push_back(of);
    }
  };
  Cells vertices, lines, polygons;

  Index add(const Vec3& at, const Vec3& normal = zero<Vec3>(), const Vec3& impulse = zero<Vec3>()) {
    for (int k = 0; k < 3; ++k) points_.push_back(float(at[k])), normals_.push_back(float(normal[k])), impulses_.push_back(float(impulse[k]));
    return Index(points_.size() / 3) - 1;
  }

  std::string text() const {
    std::string out = "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"";
    out += std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
    out += "\" header_type=\"UInt64\">\n<PolyData>\n<Piece NumberOfPoints=\"" + std::to_string(points_.size() / 3) + "\" NumberOfVerts=\"" + count(vertices) + "\" NumberOfLines=\"" +
           count(lines) + "\" NumberOfStrips=\"0\" NumberOfPolys=\"" + count(polygons) + "\">\n<PointData Vectors=\"impulse\">\n";
    array(out, "normal", 3, normals_), array(out, "impulse", 3, impulses_);
    out += "</PointData>\n<CellData Scalars=\"body\">\n";
    std::vector<std::int32_t> body = vertices.body;
    body.insert(body.end(), lines.body.begin(), lines.body.end());
    body.insert(body.end(), polygons.body.begin(), polygons.body.end());
    array(out, "body", 1, body);
    out += "</CellData>\n<Points>\n";
    array(out, "points", 3, points_);
    out += "</Points>\n";
    cells(out, "Verts", vertices), cells(out, "Lines", lines), cells(out, "Polys", polygons);
    return out + "</Piece>\n</PolyData>\n</VTKFile>\n";
  }

 private:
  static std::string count(const Cells& cells) { return std::to_string(cells.ends.size()); }
  static void cells(std::string& out, const std::string& kind, const Cells& cells) {
    out += "<" + kind + ">\n";
    array(out, "connectivity", 1, cells.corners), array(out, "offsets", 1, cells.ends);
    out += "</" + kind + ">\n";
  }
  /// The bytes behind their number, in base64.
  template <class T>
  static void array(std::string& out, const char* name, int width, const std::vector<T>& values) {
    const std::uint64_t size = values.size() * sizeof(T);
    std::string bytes(sizeof size + std::size_t(size), '\0');
    std::memcpy(bytes.data(), &size, sizeof size);
    if (size > 0) std::memcpy(bytes.data() + sizeof size, values.data(), std::size_t(size));
    out += std::string("<DataArray type=\"") + (std::is_same_v<T, float> ? "Float32" : "Int32") + "\" Name=\"" + name + "\" NumberOfComponents=\"" + std::to_string(width) + "\" format=\"binary\">";
    append_base64(out, bytes);
    out += "</DataArray>\n";
  }

  std::vector<float> points_, normals_, impulses_;
};

/// The middle of the bodies of a frame, and how far the farthest is from it, m.
struct FrameBall {
  Vec3 middle = zero<Vec3>();
  double reach = 1;

  FrameBall(std::span<const RecordedBody> bodies, const RecordedFrame& frame) {
    Vec3 low = zero<Vec3>(), high = zero<Vec3>();
    bool is_first = true;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const Vec3& at = frame.poses[b].position;
      if (bodies[b].is_static || !is_finite(at)) continue;
      for (int k = 0; k < 3; ++k) low[k] = is_first ? at[k] : std::min(low[k], at[k]), high[k] = is_first ? at[k] : std::max(high[k], at[k]);
      is_first = false;
    }
    middle = 0.5 * (low + high);
    reach = std::max(1., norm(Vec3(high - low)));
  }
};

/// What is not finite is left out.
inline std::string vtp_text(std::span<const RecordedBody> bodies, const RecordedFrame& frame) {
  VtkPolyData data;
  const FrameBall ball(bodies, frame);
  for (const RecordedContact& contact : frame.contacts) {
    if (!is_finite(contact.point) || !is_finite(contact.impulse) || !is_finite(contact.normal)) continue;
    const Index at = data.add(contact.point, contact.normal, contact.impulse);
    data.vertices.add(std::span(&at, 1), 0, -1);
  }
  for (const RecordedLine& line : frame.lines) {
    if (!is_finite(line.from) || !is_finite(line.to)) continue;
    const Index ends[] = {data.add(line.from), data.add(line.to)};
    data.lines.add(ends, 0, -1);
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Vec3& at = frame.poses[b].position;
    if (!is_finite(at) || !is_finite(frame.poses[b].rotation.coeffs())) continue;
    const Pose pose{at, frame.poses[b].rotation.toRotationMatrix()};
    const Polygons own = polygons_of(bodies[b], pose.to_local(ball.middle), 3 * ball.reach);
    Index first = 0;
    for (std::size_t p = 0; p < own.points.size(); ++p) {
      const Index place = data.add(pose.to_world(own.points[p]));
      if (p == 0) first = place;
    }
    for (const auto& face : own.faces) data.polygons.add(face, first, Index(b));
  }
  return data.text();
}

}  // namespace delassus::inner
