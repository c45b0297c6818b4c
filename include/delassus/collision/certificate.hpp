/// Two support calls that prove or refuse any kernel's answer.
#pragma once

#include <delassus/collision/inner/difference.hpp>
#include <delassus/collision/signed_pair.hpp>
#include <delassus/core/cmath.hpp>

#include <algorithm>
#include <concepts>

namespace delassus {

/// Accepts an answer whose normal n is a unit vector and whose distance is what n proves,
///
///   | h(n) + distance | ≤ 1e-3 max(|distance|, 1e-3 L),   h(n) = n · (s_A(n) − s_B(−n)).
///
/// Of `far` ones, it accepts those with −h(n) > margin. An upper bound of the depth is h, so an accepted normal always
/// separates. On acceptance the witnesses are rebuilt: Heights along n from the support points, so that b − a = −h(n) n
/// exactly.
template <std::same_as<SignedPair> Pair>
bool certify(const Shape& a, const Shape& b, const Pose& b_in_a, double margin, double scale, Pair& r) {
  if (r.status == PairStatus::failed || !is_finite(r.normal) || !std::isfinite(r.distance)) return false;
  const double excess = squared_norm(r.normal) - 1;
  if (!(std::abs(excess) < 1e-9)) return false;
  if (std::abs(excess) > 1e-15) r.normal *= 1 - 0.5 * excess;  // else heights of 1 m would be off by 5e-10 m
  const Vec3& n = r.normal;
  const double height_a = dot(n, support(a, n));
  const double height_b = dot(n, b_in_a.to_world(support(b, Vec3(-transposed_times(b_in_a.rotation, n)))));
  const double proven = height_b - height_a;
  if (r.status == PairStatus::far) return proven > (1 - 1e-3) * margin;
  const double tolerance = 1e-3 * std::max(std::abs(r.distance), 1e-3 * scale);
  if (!(std::abs(proven - r.distance) <= tolerance)) return false;
  if (!is_finite(r.point_a) || !is_finite(r.point_b)) return false;
  r.distance = proven;
  inner::put_witnesses(height_a, height_b, r);
  return true;
}

/// True when another direction, say last step's normal, proves a greater distance than the answer: then the
/// answer is not the shortest way out, though it is one.
template <std::same_as<SignedPair> Pair>
bool is_beaten(const Shape& a, const Shape& b, const Pose& b_in_a, const Vec3& other, double scale, const Pair& r) {
  if (r.status != PairStatus::near || !(squared_norm(other) > 0.5)) return false;
  const double tolerance = 1e-3 * std::max(std::abs(r.distance), 1e-3 * scale);
  return -inner::Difference{a, b, b_in_a}.reach(other) > r.distance + tolerance;
}

/// The answer of last resort: the least h(n) over the face normals of both bodies, the line of centres and
/// the guess. Always finite and always a valid separating translation, though not always the shortest.
template <std::same_as<SignedPair> Pair = SignedPair>
Pair coarse_pair(const Shape& a, const Shape& b, const Pose& b_in_a, const Vec3& guess) {
  const inner::Difference difference{a, b, b_in_a};
  const Mat3& R = b_in_a.rotation;
  Pair r{.status = PairStatus::near, .distance = -std::numeric_limits<double>::infinity()};
  const auto consider = [&](const Vec3& direction) {
    const double length = norm(direction);
    if (!(length > 0)) return;
    const Vec3 n = direction / length;
    const double distance = -difference.reach(n);
    if (distance > r.distance) r.distance = distance, r.normal = n;
  };
  const auto consider_faces = [&](const Shape& s, const Mat3& turn) {
    for (int k = 0; k < 3; ++k)
      for (const double sign : {1.0, -1.0}) consider(sign * column(turn, k));
    if (s.kind == ShapeKind::convex_hull)
      for (Index f = 0; f < s.hull->face_count(); ++f) consider(turn * s.hull->normal(f));
  };
  consider(guess);
  consider(b_in_a.to_world(middle(b)) - middle(a));
  consider_faces(a, identity<Mat3>());
  consider_faces(b, Mat3(-R));
  r.point_a = support(a, r.normal);
  r.point_b = r.point_a + r.distance * r.normal;
  return r;
}

}  // namespace delassus
