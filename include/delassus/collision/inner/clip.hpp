/// Where two faces overlap, seen along the contact normal.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/fixed_array.hpp>
#include <delassus/geometry/face.hpp>

#include <algorithm>
#include <cstdint>

namespace delassus::inner {

/// A corner of the overlap: a point of the subject's plane, the name of what makes the corner, and the line
/// that leaves it.
struct ClipCorner {
  Vec3 point;
  std::uint32_t name;
  std::int8_t edge;  ///< the subject's edge k as k, the clip face's edge j as −1 − j
};

struct ClipPolygon {
  static constexpr int capacity = 2 * Face::capacity + 2;
  FixedArray<ClipCorner, capacity> corner;
  int count = 0;
  void add(const ClipCorner& c) {
    if (count < capacity) corner[count++] = c;
  }
};

/// Names, the same whichever face is the subject: a corner of A or B, or a crossing of an edge of each.
inline std::uint32_t corner_name(bool is_of_a, std::uint32_t corner) {
  return (is_of_a ? 1u : 2u) << 30 | corner;
}
inline bool is_lowest_of_rim(std::uint32_t name) { return (name & 0x3fffffffu) == Face::lowest_of_rim; }
inline std::uint32_t edge_name(const Face& f, int k) {
  const std::uint32_t u = f.corner[k], v = f.corner[(k + 1) % f.count];
  return (std::min(u, v) * 31u + std::max(u, v)) & 0x7fffu;
}
inline std::uint32_t crossing_name(std::uint32_t edge_a, std::uint32_t edge_b) {
  return 3u << 30 | edge_a << 15 | edge_b;
}

/// Cuts the face `subject` by the sides of the polygon `clip`, extruded along n (Sutherland and Hodgman).
/// Both are counter-clockwise about n. A corner within `slack` (m) of a side counts as inside. Source:
/// [SutherlandHodgman1974].
class FaceClipper {
 public:
  FaceClipper(const Face& subject, const Face& clip, const Vec3& n, bool subject_is_a, double slack)
      : subject_(subject), clip_(clip), n_(n), subject_is_a_(subject_is_a), slack_(slack) {
    for (int k = 0; k < subject.count; ++k)
      polygon_.add({subject.point[k], corner_name(subject_is_a, subject.corner[k]), std::int8_t(k)});
    for (int j = 0; j < clip.count && polygon_.count > 0; ++j) cut(j);
  }

  const ClipPolygon& polygon() const { return polygon_; }

 private:
  /// Height above side j, m: positive outside.
  void heights(int j, FixedArray<double, ClipPolygon::capacity>& height) const {
    const Vec3 along = clip_.point[(j + 1) % clip_.count] - clip_.point[j];
    const Vec3 out = cross(along, n_);
    const double length = norm(out);
    for (int i = 0; i < polygon_.count; ++i)
      height[i] = length > 0 ? dot(out, polygon_.corner[i].point - clip_.point[j]) / length : 0;
  }

  void cut(int j) {
    FixedArray<double, ClipPolygon::capacity> height;
    heights(j, height);
    ClipPolygon kept;
    const int count = polygon_.count, lines = count == 2 && subject_.count == 2 ? 1 : count;
    for (int i = 0; i < count; ++i) {
      const int next = (i + 1) % count;
      const ClipCorner& p = polygon_.corner[i];
      const bool is_inside = height[i] <= slack_;
      if (is_inside) kept.add(p);
      if (i >= lines || is_inside == (height[next] <= slack_)) continue;
      const double share = std::clamp(height[i] / (height[i] - height[next]), 0.0, 1.0);
      const Vec3 x = p.point + (polygon_.corner[next].point - p.point) * share;
      kept.add({x, meeting(p.edge, j), is_inside ? std::int8_t(-1 - j) : p.edge});
    }
    polygon_ = kept;
  }

  /// The name of the point where side j of the clip face cuts the line `edge`.
  std::uint32_t meeting(int edge, int j) const {
    if (edge >= 0) {
      const std::uint32_t of_subject = edge_name(subject_, edge), of_clip = edge_name(clip_, j);
      return subject_is_a_ ? crossing_name(of_subject, of_clip) : crossing_name(of_clip, of_subject);
    }
    const int i = -1 - edge, corner = j == (i + 1) % clip_.count ? j : i;
    return corner_name(!subject_is_a_, clip_.corner[corner]);
  }

  const Face &subject_, &clip_;
  const Vec3& n_;
  bool subject_is_a_;
  double slack_;
  ClipPolygon polygon_;
};

}  // namespace delassus::inner
