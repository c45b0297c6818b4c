/// Any shape against a half-space: each corner of its lowest face is a contact.
#pragma once

#include <delassus/collision/manifold.hpp>
#include <delassus/collision/plane.hpp>
#include <delassus/collision/signed_pair.hpp>

namespace delassus {

namespace inner {

/// A half-space and a shape over its plane, in the frame of A.
struct PlanePair {
  bool plane_is_a;
  Plane plane;
  const Shape& shape;
  Pose pose;  ///< of the shape
  Vec3 down;  ///< in the frame of the shape

  PlanePair(const Shape& a, const Shape& b, const Pose& b_in_a)
      : plane_is_a(a.kind == ShapeKind::half_space), plane(plane_is_a ? plane_of(a, Pose{}) : plane_of(b, b_in_a)), shape(plane_is_a ? b : a),
        pose(plane_is_a ? b_in_a : Pose{}), down(-transposed_times(pose.rotation, plane.normal)) {}

  PatchPoint contact(const Vec3& point, std::uint32_t name) const {
    const double gap = dot(plane.normal, point) - plane.offset;
    const Vec3 foot = point - gap * plane.normal;
    return plane_is_a ? PatchPoint{foot, point, gap, name} : PatchPoint{point, foot, gap, name};
  }
  Vec3 lowest() const { return pose.to_world(support(shape, down)); }
  SignedPair answer(const PatchPoint& lowest, double margin) const {
    return {.status = lowest.gap > margin ? PairStatus::far : PairStatus::near,
            .distance = lowest.gap,
            .normal = plane_is_a ? plane.normal : Vec3(-plane.normal),
            .point_a = lowest.a,
            .point_b = lowest.b};
  }
};

}  // namespace inner

/// One of the two is a half-space, the other a shape over its plane. Gives the deepest point and the corners with
/// a gap up to `margin`, in the frame of A.
inline SignedPair half_space_patch(const Shape& a, const Shape& b, const Pose& b_in_a, double margin, double scale,
                                   Patch& patch) {
  const inner::PlanePair pair(a, b, b_in_a);
  const Shape& s = pair.shape;
  const PatchPoint lowest = pair.contact(pair.lowest(), Patch::witness);
  const Face face = face_towards(s, pair.down);
  const bool is_line = face.count == 2;
  const double most = inner::patch_margin(margin, lowest.gap, scale);
  patch.clear();
  for (int k = 0; k < face.count; ++k) {
    Vec3 corner = face.point[k];
    double way = 0;
    if (is_line && inner::leave_side(s, corner, pair.down, way)) corner += way * pair.down;
    const PatchPoint p = pair.contact(pair.pose.to_world(corner), inner::corner_name(!pair.plane_is_a, face.corner[k]));
    if (p.gap <= most) patch.add(p);
  }
  inner::drop_twins(scale, patch);
  patch.area = inner::area_of_patch(patch, pair.plane.normal, inner::round_face(s, inner::posed(face, pair.pose), pair.pose.position));
  inner::add_witness(lowest, scale, inner::face_slack * scale, patch);
  return pair.answer(lowest, margin);
}

}  // namespace delassus
