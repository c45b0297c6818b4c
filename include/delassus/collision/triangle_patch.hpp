/// One triangle of a surface against one convex shape: distance, a normal that the surface allows, and the
/// patch.
#pragma once

#include <delassus/collision/gjk_epa.hpp>
#include <delassus/collision/manifold.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/fixed_array.hpp>
#include <delassus/geometry/inner/flat_tree.hpp>
#include <delassus/geometry/triangle.hpp>

#include <cstdint>
#include <limits>

namespace delassus {
namespace inner {

/// The box of a posed shape, wider by as much on each side.
inline Bounds bounds_around(const Shape& s, const Pose& pose, double more) {
  const Aabb tight = tight_box(s, pose);
  return Bounds{tight.min(), tight.max()}.grown(more);
}

/// The corners of the triangle that lie farthest along n: three of a face, two of an edge, one of a corner.
struct Rim {
  FixedArray<int, 3> corner{};
  FixedArray<bool, 3> has{};
  int count = 0;

  Rim(const Triangle& t, const Vec3& n) {
    FixedArray<double, 3> reach;
    double farthest = -std::numeric_limits<double>::infinity(), longest = 0;
    for (int k = 0; k < 3; ++k) {
      reach[k] = dot(n, t.point[k] - t.point[0]);
      farthest = std::max(farthest, reach[k]);
      longest = std::max(longest, squared_norm(t.point[(k + 1) % 3] - t.point[k]));
    }
    const double slack = 1e-6 * std::sqrt(longest);
    for (int k = 0; k < 3; ++k)
      if (reach[k] >= farthest - slack) corner[count++] = k, has[k] = true;
  }
};

/// The internal edges of a surface are no edges to touch. A normal may lean out over an edge as far as the surface bends away
/// there, and not at all where it is flat or hollow.
inline bool is_allowed(const Triangle& t, const Rim& rim, const Vec3& n) {
  if (dot(n, t.normal) < -1e-6) return false;
  if (rim.count == 3) return true;
  for (int k = 0; k < 3; ++k) {
    const bool from = rim.has[k], to = rim.has[(k + 1) % 3];
    const bool touches = rim.count == 2 ? from && to : from || to;
    if (touches && dot(n, t.outward(k)) > t.lean[k] + 1e-9) return false;
  }
  return true;
}

/// A sphere's distance is that of its centre from the triangle. Pre: the centre is not behind the triangle.
inline SignedPair triangle_and_sphere(const Triangle& t, double radius, const Vec3& centre) {
  const Vec3 on = nearest_on(t, centre), apart = centre - on;
  const double length = norm(apart);
  SignedPair r{.status = PairStatus::near, .distance = length - radius};
  r.normal = length > 1e-12 * radius ? Vec3(apart / length) : t.normal;
  r.point_a = on;
  r.point_b = centre - radius * r.normal;
  return r;
}

/// Replaces the distance by what the normal proves, as heights along it.
inline bool prove(const Triangle& t, const Shape& s, const Pose& pose, SignedPair& r) {
  if (r.status != PairStatus::near || !is_finite(r.normal) || !(std::abs(squared_norm(r.normal) - 1) < 1e-9))
    return false;
  const Vec3 on_a = core_support(t, r.normal);
  const Vec3 on_b = pose.to_world(support(s, Vec3(-transposed_times(pose.rotation, r.normal))));
  r.distance = dot(r.normal, on_b - on_a);
  put_witnesses(dot(r.normal, on_a), dot(r.normal, on_b), r);
  return is_finite(r.point_a) && is_finite(r.point_b);
}

inline Face face_of(const Triangle& t, const Rim& rim) {
  Face face;
  for (int i = 0; i < rim.count; ++i) face.add(t.point[rim.corner[i]], t.corner[rim.corner[i]] & 0x7fff);
  if (rim.count == 3) face.normal = t.normal;
  return face;
}

}  // namespace inner

/// Whether a triangle has contacts, and whether they hold without a look at its neighbours.
enum class PatchTrust : std::uint8_t { none, sure, doubtful };

/// Contacts of the shape, posed in the frame of the triangle (A), up to the gap `margin` (m), in `patch`. Their `normal` is
/// one for all, unit, from the triangle to the shape. A shape whose middle is behind the triangle does not meet it.
///
///   1. The shape's lowest point over the triangle and above it. The normal is the triangle's.
///   2. Else the shortest way apart, by GJK and EPA of the cores, a closed form for spheres.
///   3. A normal within 0.02 rad and 1e-5 L as good, or one that the rim does not allow, becomes the triangle's. In the
///      latter case the answer is `doubtful`: It holds on a plain and not at the rim of a cliff.
inline PatchTrust triangle_patch(const Triangle& t, const Shape& s, const Pose& pose, double margin,
                                 double scale, Patch& patch, Vec3& normal) {
  patch.clear();
  const Vec3 centre = pose.to_world(middle(s));
  if (!(t.height(centre) >= 0)) return PatchTrust::none;
  const Vec3 lowest = pose.to_world(support(s, Vec3(-transposed_times(pose.rotation, t.normal))));
  const double height = t.height(lowest), slack = 1e-7 * scale;
  if (!(height <= margin)) return PatchTrust::none;
  const bool is_over = inner::is_over(t, lowest, slack);

  SignedPair r{.status = PairStatus::near,
               .distance = height,
               .normal = t.normal,
               .point_a = lowest - height * t.normal,
               .point_b = lowest};
  bool is_flat = is_over && height >= 0, is_doubtful = false;
  SignedPair shortest = r;
  if (!is_flat) {
    shortest = s.kind == ShapeKind::sphere ? inner::triangle_and_sphere(t, s.size[0], centre)
                                           : GjkEpa::convex(t, s, pose, margin, t.normal);
    if (shortest.status == PairStatus::far ||
        (shortest.status == PairStatus::near && shortest.distance > margin))
      return PatchTrust::none;
    const bool is_proven = inner::prove(t, s, pose, shortest);
    is_doubtful = !is_proven || !inner::is_allowed(t, inner::Rim(t, shortest.normal), shortest.normal);
    is_flat =
        is_doubtful || (dot(shortest.normal, t.normal) > 0.9998 && height >= shortest.distance - 1e-5 * scale);
    if (!is_flat) r = shortest;
  }
  if (r.distance > margin) return PatchTrust::none;
  normal = r.normal;
  const Vec3& n = normal;

  Face face = inner::posed(face_towards(s, Vec3(-transposed_times(pose.rotation, n))), pose);
  if (face.count >= 3) inner::reverse(face);
  if (is_flat) {
    const Face whole = inner::face_of(t, inner::Rim(t, t.normal));
    if (face.count >= 2) inner::overlap_of_faces(face, whole, n, false, margin, slack, patch);
  } else {
    const Face rim = inner::face_of(t, inner::Rim(t, n));
    if (rim.count == 2 && face.count == 2)
      inner::overlap_of_lines(rim, face, n, margin, scale, patch, true);
    else if (rim.count == 2 && face.count >= 3 && -dot(face.normal, n) > 0.2)
      inner::overlap_of_faces(rim, face, n, true, margin, slack, patch);
  }
  if (face.count == 2) inner::lay_on_side(s, pose, n, false, r.distance - inner::face_slack * scale, patch);
  inner::drop_twins(scale, patch);
  if (is_flat && face.count >= 3) patch.corners = patch.count;
  // A round shape over an edge that is nearly flat is beside both its triangles: the shortest way is its
  // contact.
  if (is_flat && !is_over && !is_doubtful && patch.count == 0)
    r = shortest, normal = r.normal, is_flat = false;
  if (!is_flat || is_over)
    inner::add_witness({r.point_a, r.point_b, r.distance, Patch::witness}, scale, inner::face_slack * scale, patch);
  if (patch.count == 0) return PatchTrust::none;
  return is_doubtful ? PatchTrust::doubtful : PatchTrust::sure;
}

}  // namespace delassus
