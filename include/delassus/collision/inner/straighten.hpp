/// The last digits of a normal, whichever kernel it came from.
#pragma once

#include <delassus/collision/certificate.hpp>
#include <delassus/collision/gjk.hpp>
#include <delassus/collision/inner/newton_normal.hpp>
#include <delassus/geometry/face.hpp>

#include <algorithm>
#include <limits>

namespace delassus::inner {

/// Turns a certified normal to the minimum of h next to it: exactly where a face meets a point, to 1e-7 rad
/// where there is a gap, else as Newton's method says. A distance cannot say as much: a normal that leans by
/// θ proves only R θ²/2 less, R being the radius of A − B there.
template <class Scalar>
struct BasicStraighten {
  using Vec3 = Vec<3, Scalar>;

  const Shape &a, &b;
  const Pose& b_in_a;
  Scalar scale;

  /// `is_sharp`: beyond a gap of 5e-4 of the scale the normal is a minimum to that accuracy already.
  void operator()(SignedPair& r, bool is_sharp) const {
    const Face face_a = face_towards(a, r.normal), face_b = face_towards(b, to_b(Vec3(-r.normal)));
    if (is_face(face_a, r.normal) || is_face(face_b, to_b(Vec3(-r.normal)))) return;
    const Vec3 before = r.normal;
    if (!meets_point(face_a, face_b, r)) {
      if (!is_sharp && r.distance > 0) measure(r);
      if (r.distance < 5e-4 * scale) part(r);
      if (r.distance < 1e-2 * scale && !(is_polytope(a) && is_polytope(b)))
        take(NewtonNormal{Difference{a, b, b_in_a}}(r.normal), r);
      // As far as rounding shows, a face's own normal is as good.
      if (face_a.count >= 3) take(face_a.normal, r);
      if (face_b.count >= 3) take(Vec3(-(b_in_a.rotation * face_b.normal)), r);
    }
    if (r.normal != before) certify(a, b, b_in_a, std::numeric_limits<Scalar>::infinity(), scale, r);
  }

 private:
  static constexpr Scalar nearby = 0.9998;

  Vec3 to_b(const Vec3& d) const { return transposed_times(b_in_a.rotation, d); }

  /// −h(n), the distance that the unit vector n proves.
  Scalar proven(const Vec3& n) const { return -Difference{a, b, b_in_a}.reach(n); }

  /// Takes a normal that is near and, but for rounding, proves as much.
  bool take(const Vec3& n, SignedPair& r) const {
    if (!(dot(n, r.normal) > nearby)) return false;
    const Scalar distance = proven(n),
                 rounding = 1e-15 * (norm(r.point_a) + norm(r.point_b) + norm(b_in_a.position));
    if (!(distance >= r.distance - rounding)) return false;
    r.normal = n;
    r.distance = distance;
    return true;
  }

  /// A − B of two has faces only, no normal of which GJK leaves open.
  static bool is_polytope(const Shape& s) {
    return s.kind == ShapeKind::box || s.kind == ShapeKind::convex_hull;
  }

  /// Of flat bodies the kernel found the face itself.
  static bool is_face(const Face& face, const Vec3& n) {
    return face.count >= 3 && squared_norm(face.normal - n) < 1e-30;
  }

  /// Where the one body's lowest point is over a face of the other, both bounds meet: no normal nearby is
  /// better.
  bool meets_point(const Face& face_a, const Face& face_b, SignedPair& r) const {
    if (face_a.count >= 3) {
      const Vec3 n = face_a.normal;
      if (is_over(face_a, b_in_a.to_world(support(b, to_b(Vec3(-n))))) && take(n, r)) return true;
    }
    if (face_b.count < 3) return false;
    const Vec3 n = -(b_in_a.rotation * face_b.normal);
    return is_over(face_b, b_in_a.to_local(support(a, n))) && take(n, r);
  }

  static bool is_over(const Face& face, const Vec3& p) {
    for (int i = 0; i < face.count; ++i) {
      const Vec3& from = face.point[i];
      if (dot(cross(face.point[(i + 1) % face.count] - from, p - from), face.normal) < 0) return false;
    }
    return true;
  }

  /// The normal of both moved apart by `way` along n.
  GjkResult apart(const Vec3& n, Scalar way) const {
    const Pose parted{.position = b_in_a.position + way * n, .rotation = b_in_a.rotation};
    return gjk(Difference{a, b, parted}, n, std::numeric_limits<Scalar>::infinity());
  }

  void measure(SignedPair& r) const {
    const GjkResult q = apart(r.normal, 0);
    if (q.is_apart) take(q.normal, r);
  }

  /// Bodies that overlap or nearly touch are parted along n to a gap g and measured there. Of a depth d the
  /// normal is then wrong by (d + g) / (R + g) < 1 of what it was, and across an edge by nothing.
  void part(SignedPair& r) const {
    Vec3 n = r.normal;
    for (int round = 0; round < 2; ++round) {
      const GjkResult q = apart(n, 1e-2 * scale - proven(n));
      if (!q.is_apart || !(dot(q.normal, r.normal) > nearby)) break;
      const Scalar turn2 = squared_norm(q.normal - n);
      n = q.normal;
      if (turn2 < 1e-14) break;
    }
    take(n, r);
  }
};

using Straighten = BasicStraighten<double>;

}  // namespace delassus::inner
