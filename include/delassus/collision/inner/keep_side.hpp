/// The way out of an overlap of bodies that go so far in a step that they come to lie through each other.
#pragma once

#include <delassus/collision/signed_pair.hpp>
#include <delassus/geometry/face.hpp>
#include <delassus/geometry/support.hpp>

#include <concepts>

namespace delassus::inner {

/// The shortest way out of a thin plate may be through it. Where that is against the last normal, and the
/// middle of one of the two is still beyond the other along the last normal, the way out is along that
/// normal, or along a face's within 60° of it, whichever is shortest. In the frame of A; `last` is a unit
/// vector, or zero where there is none.
inline void keep_side(const std::same_as<Shape> auto& a, const Shape& b, const Pose& b_in_a, const Vec3& last,
                      SignedPair& r) {
  if (!(r.distance < 0) || !(dot(r.normal, last) < 0)) return;
  bool is_any = false;
  SignedPair best = r;
  const auto consider = [&](const Vec3& n) {
    if (!(dot(n, last) > 0.5)) return;
    const Vec3 reach_a = support(a, n),
               reach_b = b_in_a.to_world(support(b, Vec3(-transposed_times(b_in_a.rotation, n))));
    const double distance = dot(n, reach_b - reach_a);
    if (is_any && !(distance > best.distance)) return;
    is_any = true;
    best.normal = n;
    best.distance = distance;
    best.point_a = reach_a, best.point_b = reach_b;
    put_witnesses(dot(n, reach_a), dot(n, reach_b), best);
  };
  const Vec3 reach_a = support(a, last),
             reach_b = b_in_a.to_world(support(b, Vec3(-transposed_times(b_in_a.rotation, last))));
  if (!(dot(last, b_in_a.position - reach_a) >= 0 || dot(last, reach_b) >= 0)) return;
  consider(last);
  const Face face_a = face_towards(a, last);
  if (face_a.count >= 3) consider(face_a.normal);
  const Face face_b = face_towards(b, Vec3(-transposed_times(b_in_a.rotation, last)));
  if (face_b.count >= 3) consider(Vec3(-(b_in_a.rotation * face_b.normal)));
  r = best;
}

}  // namespace delassus::inner
