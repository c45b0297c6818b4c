/// Pairs whose distance has a formula: a sphere with any shape but a hull, and two capsules.
#pragma once

#include <delassus/collision/inner/nearest.hpp>
#include <delassus/collision/signed_pair.hpp>

#include <concepts>

namespace delassus {
namespace inner {

/// Sphere B against shape A; `center` is the sphere's, in the frame of A.
SignedPair sphere_against(const std::same_as<Shape> auto& a, double radius, const Vec3& center, const Vec3& wish) {
  const NearestSurface s = nearest_surface(a, center, wish);
  SignedPair r{.status = PairStatus::near, .distance = s.distance - radius, .normal = s.normal};
  r.point_a = center - s.distance * s.normal;
  r.point_b = center - radius * s.normal;
  return r;
}

/// Parameters s, t ∈ [−1, 1] of the nearest points s·u and x + t·v of two segments with the half vectors u,
/// v. Source: [Ericson2005], §5.1.9; parallel ones meet in the middle of their overlap.
template <class T>
void nearest_on_segments(const Vec<3, T>& u, const Vec<3, T>& v, const Vec<3, T>& x, double& s, double& t) {
  const double uu = squared_norm(u), vv = squared_norm(v), uv = dot(u, v), ux = dot(u, x), vx = dot(v, x);
  const double determinant = squared_norm(cross(u, v));
  if (determinant > 1e-12 * uu * vv) {
    s = std::clamp((ux * vv - vx * uv) / determinant, -1.0, 1.0);
  } else {
    const double middle = ux / uu, half = std::abs(uv) / uu;
    const double low = std::max(-1.0, middle - half), high = std::min(1.0, middle + half);
    s = std::clamp(0.5 * (low + high), -1.0, 1.0);
  }
  t = std::clamp((s * uv - vx) / vv, -1.0, 1.0);
  s = std::clamp((t * uv + ux) / uu, -1.0, 1.0);
}

template <std::same_as<Shape> S>
SignedPair two_capsules(const S& a, const S& b, const Pose& b_in_a, const Vec3& wish) {
  const Vec3 u = a.size[1] * unit_axis(2), v = b.size[1] * column(b_in_a.rotation, 2);
  double s = 0, t = 0;
  nearest_on_segments(u, v, b_in_a.position, s, t);
  const Vec3 on_a = s * u, on_b = b_in_a.position + t * v, apart = on_b - on_a;
  const double length = norm(apart);
  SignedPair r{.status = PairStatus::near, .distance = length - a.size[0] - b.size[0]};
  if (length > 1e-14 * (a.size[1] + b.size[1])) {
    r.normal = apart / length;
  } else {
    // The axes cross: out of their common plane, or across them when they are one line.
    const Vec3 out = cross(u, v);
    const bool is_plane = squared_norm(out) > 1e-12 * squared_norm(u) * squared_norm(v);
    r.normal =
        is_plane ? Vec3(with_sign(1, dot(out, wish)) * normalized(out)) : perpendicular(unit_axis(2), wish);
  }
  r.point_a = on_a + a.size[0] * r.normal;
  r.point_b = on_b - b.size[0] * r.normal;
  return r;
}

inline bool is_simple(const Shape& s) {
  return s.kind != ShapeKind::none && s.kind != ShapeKind::half_space && s.kind != ShapeKind::convex_hull;
}

/// Turns an answer for (B, A) in the frame of B into one for (A, B) in the frame of A.
inline SignedPair swapped(const SignedPair& r, const Pose& b_in_a) {
  SignedPair s = r;
  // The rotation may come from single precision, and is orthogonal to that only.
  s.normal = -normalized(b_in_a.rotation * r.normal);
  s.point_a = b_in_a.to_world(r.point_b);
  s.point_b = b_in_a.to_world(r.point_a);
  return s;
}

}  // namespace inner

/// True when the distance of such shapes is a formula, exact to rounding.
inline bool has_closed_form(const Shape& a, const Shape& b) {
  return (b.kind == ShapeKind::sphere && inner::is_simple(a)) ||
         (a.kind == ShapeKind::sphere && inner::is_simple(b)) ||
         (a.kind == ShapeKind::capsule && b.kind == ShapeKind::capsule);
}

/// True when the pair has a formula, whose answer is then in `r`. Exact, in the frame of A.
template <std::same_as<SignedPair> Pair>
bool closed_form(const Shape& a, const Shape& b, const Pose& b_in_a, const Vec3& guess, Pair& r) {
  if (!has_closed_form(a, b)) return false;
  const Vec3 wish = squared_norm(guess) > 0 ? guess : b_in_a.position;
  if (b.kind == ShapeKind::sphere) {
    r = inner::sphere_against(a, b.size[0], b_in_a.position, wish);
  } else if (a.kind == ShapeKind::sphere) {
    const Vec3 center = -transposed_times(b_in_a.rotation, b_in_a.position);
    r = inner::swapped(inner::sphere_against(b, a.size[0], center, -transposed_times(b_in_a.rotation, wish)),
                       b_in_a);
  } else {
    r = inner::two_capsules(a, b, b_in_a, wish);
  }
  return true;
}

}  // namespace delassus
