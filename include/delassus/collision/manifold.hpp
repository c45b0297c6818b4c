/// The contact patch of two bodies: where their faces overlap along the contact normal.
#pragma once

#include <delassus/collision/inner/clip.hpp>
#include <delassus/collision/inner/round_side.hpp>
#include <delassus/collision/patch.hpp>
#include <delassus/collision/signed_pair.hpp>
#include <delassus/core/cmath.hpp>

#include <algorithm>
#include <limits>
#include <utility>

namespace delassus {

namespace inner {

inline Face posed(Face face, const Pose& pose) {
  for (int k = 0; k < face.count; ++k) face.point[k] = pose.to_world(face.point[k]);
  face.normal = pose.rotation * face.normal;
  return face;
}

/// The other order of corners, so that both faces run counter-clockwise about the normal from A to B.
inline void reverse(Face& face) {
  for (int i = 0, k = face.count - 1; i < k; ++i, --k) {
    std::swap(face.point[i], face.point[k]);
    std::swap(face.corner[i], face.corner[k]);
  }
}

inline bool is_cap(const Shape& s, const Face& face) {
  return (s.kind == ShapeKind::cylinder || s.kind == ShapeKind::cone) && face.count >= 8;
}

/// The cap that the face is, with a point of its axis; else none.
inline RoundFace round_face(const Shape& s, const Face& face, const Vec3& on_axis) {
  if (!is_cap(s, face)) return {};
  return {on_axis + face.normal * dot(face.normal, face.point[0] - on_axis), s.size[0]};
}

/// Of two round caps, gives the other one corners where the first has its own. The caps have none, and equal caps one on the
/// other shall overlap in all of them, however they are turned.
inline void align_octagons(const Face& cap, const Vec3& origin, Face& other, const Vec3& other_origin) {
  const auto centre = [](const Face& f, const Vec3& on_axis) {
    return Vec3(on_axis + f.normal * dot(f.normal, f.point[0] - on_axis));
  };
  const Vec3 from = centre(cap, origin), to = centre(other, other_origin);
  const double radius = norm(other.point[0] - to);
  for (int k = 0; k < cap.count; ++k) {
    const Vec3 spoke = cap.point[k] - from;
    other.point[k] = to + radius * normalized(spoke - other.normal * dot(other.normal, spoke));
    other.corner[k] = cap.corner[k];
  }
  other.count = cap.count;
}

/// The corners of the overlap, lifted along n from the subject to the plane of the polygon `clip`.
inline void overlap_of_faces(const Face& subject, const Face& clip, const Vec3& n, bool subject_is_a,
                             double margin, double slack, Patch& patch) {
  const FaceClipper clipper(subject, clip, n, subject_is_a, slack);
  const double slope = dot(clip.normal, n);
  for (int i = 0; i < clipper.polygon().count; ++i) {
    const ClipCorner& corner = clipper.polygon().corner[i];
    const double lift = dot(clip.normal, corner.point - clip.point[0]) / slope;
    const double gap = subject_is_a ? -lift : lift;
    if (gap > margin) continue;
    const Vec3 foot = corner.point - lift * n;
    patch.add(subject_is_a ? PatchPoint{corner.point, foot, gap, corner.name}
                           : PatchPoint{foot, corner.point, gap, corner.name});
  }
}

/// Two nearly parallel lines overlap in a stretch, whose ends are the contacts. Where they are beside each other
/// a contact is on the line that ends there, or on a where that is an edge and `is_sharp`.
inline void overlap_of_lines(const Face& a, const Face& b, const Vec3& n, double margin, double scale,
                             Patch& patch, bool is_sharp = false) {
  const Vec3 u = a.point[1] - a.point[0], v = b.point[1] - b.point[0];
  const double length = norm(u);
  if (std::abs(dot(cross(u, v), n)) > line_slope * length * norm(v)) return;
  const Vec3 e = u / length;
  const double b0 = dot(e, b.point[0] - a.point[0]), b1 = dot(e, b.point[1] - a.point[0]);
  const double low = std::max(0.0, std::min(b0, b1)), high = std::min(length, std::max(b0, b1));
  if (!(high - low > 1e-3 * scale)) return;
  for (const double s : {low, high}) {
    const Vec3 on_a = a.point[0] + s * e, on_b = b.point[0] + v * ((s - b0) / (b1 - b0));
    const double gap = dot(n, on_b - on_a);
    if (gap > margin) continue;
    const Vec3 beside = on_b - on_a - gap * n;
    const bool is_end_of_a = s == 0.0 || s == length;
    const std::uint32_t name = is_end_of_a ? corner_name(true, a.corner[s == 0.0 ? 0 : 1])
                                           : corner_name(false, b.corner[s == b0 ? 0 : 1]);
    const bool is_on_a = is_end_of_a || is_sharp;
    patch.add({is_on_a ? on_a : Vec3(on_a + beside), is_on_a ? Vec3(on_b - beside) : on_b, gap, name});
  }
}

/// Drops corners that coincide with an earlier one, to 1e-3 of the scale: crossings of edges that nearly
/// meet.
inline void drop_twins(double scale, Patch& patch) {
  int kept = 0;
  for (int i = 0; i < patch.count; ++i) {
    int k = 0;
    while (k < kept && squared_norm(patch.point[k].a - patch.point[i].a) >= 1e-6 * scale * scale) ++k;
    if (k == kept) patch.point[kept++] = patch.point[i];
  }
  patch.count = kept;
}

/// By how much (of the scale) the corners of a patch may miss the depth: those of faces, so that none comes and goes on what
/// rests, and of lines.
inline constexpr double face_slack = 5e-5, line_slack = 1e-10;

/// Up to which gap the corners of a patch at this distance count, m: a face that lies level is in the margin with all its corners.
inline double patch_margin(double margin, double distance, double scale) { return std::max(margin, distance + face_slack * scale); }

/// Adds the witness when the corners miss its depth by more than `slack` (m); a corner it coincides with goes.
inline void add_witness(const PatchPoint& witness, double scale, double slack, Patch& patch) {
  int twin = -1;
  double deepest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < patch.count; ++i) {
    deepest = std::min(deepest, patch.point[i].gap);
    if (squared_norm(patch.point[i].a - witness.a) < 1e-6 * scale * scale) twin = i;
  }
  if (deepest <= witness.gap + slack) return;
  if (twin >= 0)
    patch.point[twin] = witness;
  else
    patch.add(witness);
}

}  // namespace inner

/// The patch in the frame of A, for the certified answer `r`. It has all corners with a gap up to `margin`, and the witness
/// when they miss its depth by more than 5e-5 of the scale, of two lines 1e-10. (They do for a round rim between two corners,
/// a vertex, lines that cross.)
inline void contact_patch(const Shape& a, const Shape& b, const Pose& b_in_a, const SignedPair& r,
                          double margin, double scale, Patch& patch) {
  const Vec3& n = r.normal;
  margin = inner::patch_margin(margin, r.distance, scale);
  patch.clear();
  Face face_a = face_towards(a, n);
  Face face_b = inner::posed(face_towards(b, Vec3(-transposed_times(b_in_a.rotation, n))), b_in_a);
  if (face_b.count >= 3) inner::reverse(face_b);
  const double slope_a = dot(face_a.normal, n), slope_b = -dot(face_b.normal, n), steepest = 0.2;
  const double slack = 1e-10 * scale;
  const bool are_lines = face_a.count == 2 && face_b.count == 2;
  if (are_lines) {
    inner::overlap_of_lines(face_a, face_b, n, margin, scale, patch);
  } else if (face_a.count >= 2 && face_b.count >= 2 && std::max(slope_a, slope_b) > steepest) {
    const bool clip_is_a = slope_a >= slope_b;
    if (inner::is_cap(a, face_a) && inner::is_cap(b, face_b))
      clip_is_a ? inner::align_octagons(face_b, b_in_a.position, face_a, zero<Vec3>())
                : inner::align_octagons(face_a, zero<Vec3>(), face_b, b_in_a.position);
    inner::overlap_of_faces(clip_is_a ? face_b : face_a, clip_is_a ? face_a : face_b, n, !clip_is_a, margin,
                            slack, patch);
  }
  const double least = r.distance - inner::face_slack * scale;
  if (face_a.count == 2) inner::lay_on_side(a, Pose{}, n, true, least, patch);
  if (face_b.count == 2) inner::lay_on_side(b, b_in_a, n, false, least, patch);
  inner::drop_twins(scale, patch);
  patch.area = inner::area_of_patch(patch, n, inner::round_face(a, face_a, zero<Vec3>()), inner::round_face(b, face_b, b_in_a.position));
  inner::add_witness({r.point_a, r.point_b, r.distance, Patch::witness}, scale,
                     (are_lines ? inner::line_slack : inner::face_slack) * scale, patch);
}

}  // namespace delassus
