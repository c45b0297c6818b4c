/// The signed distance of two boxes by their fifteen axes.
#pragma once

#include <delassus/collision/signed_pair.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/geometry/support.hpp>

#include <algorithm>
#include <concepts>
#include <limits>

namespace delassus::inner {

/// The axis along which two boxes are apart most, or overlap least: a face's normal, or across an edge of
/// each. In the frame of A.
struct BoxAxis {
  double distance = -std::numeric_limits<double>::infinity();  ///< along the axis, m
  int face = -1;  ///< of A: 0 … 2, of B: 3 … 5; −1 where edges have it
  int edge_a = 0, edge_b = 0;
  double length = 1;  ///< of the product of the edges

  /// Source: [Ericson2005], §4.4.1. Of edges at an angle θ the rounding of R makes 1 / θ as much of the sizes
  /// across them: they count where they beat others by more than that.
  [[gnu::always_inline]] BoxAxis(const Shape& a, const Shape& b, const Pose& b_in_a) {
    const Mat3& R = b_in_a.rotation;
    const Vec3& c = b_in_a.position;
    double size[3][3];  // |R|
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) size[i][k] = std::abs(R(i, k));
    for (int i = 0; i < 3; ++i) {
      take_face(i, std::abs(c[i]) - a.size[i] - size[i][0] * b.size[0] - size[i][1] * b.size[1] -
                       size[i][2] * b.size[2]);
      take_face(i + 3, std::abs(R(0, i) * c[0] + R(1, i) * c[1] + R(2, i) * c[2]) - b.size[i] -
                           size[0][i] * a.size[0] - size[1][i] * a.size[1] - size[2][i] * a.size[2]);
    }
    for (int i = 0; i < 3; ++i) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
      for (int k = 0; k < 3; ++k) {
        const int k1 = (k + 1) % 3, k2 = (k + 2) % 3;
        const double apart = std::abs(c[i2] * R(i1, k) - c[i1] * R(i2, k)) - a.size[i1] * size[i2][k] -
                             a.size[i2] * size[i1][k] - b.size[k1] * size[i][k2] - b.size[k2] * size[i][k1];
        if (apart <= distance && apart <= 0) continue;
        const double by = std::sqrt(R(i1, k) * R(i1, k) + R(i2, k) * R(i2, k));
        const double sizes =
            a.size[i1] + a.size[i2] + b.size[k1] + b.size[k2] + std::abs(c[i1]) + std::abs(c[i2]);
        if (apart - 4e-15 * sizes > distance * by)
          distance = apart / by, face = -1, edge_a = i, edge_b = k, length = by;
      }
    }
  }

  /// Unit, from A to B.
  [[gnu::always_inline]] Vec3 normal(const Pose& b_in_a) const {
    Vec3 n;
    if (face >= 0)
      n = face < 3 ? unit_axis(face) : Vec3(column(b_in_a.rotation, face - 3));
    else
      n = cross(unit_axis(edge_a), Vec3(column(b_in_a.rotation, edge_b))) / length;
    return dot(n, b_in_a.position) < 0 ? Vec3(-n) : n;
  }

 private:
  [[gnu::always_inline]] void take_face(int which, double apart) {
    if (apart > distance) distance = apart, face = which;
  }
};

/// Moves p to the nearest point over the face of `box` with the normal of axis k; false where it was there.
[[gnu::always_inline]] inline bool move_over_face(const Shape& box, int k, Vec3& p) {
  bool is_moved = false;
  for (int i = 0; i < 3; ++i) {
    if (i == k || std::abs(p[i]) <= box.size[i]) continue;
    p[i] = with_sign(box.size[i], p[i]);
    is_moved = true;
  }
  return is_moved;
}
/// Whether p is in `box`, or out of it by no more than `slack`, m.
[[gnu::always_inline]] inline bool is_in_box(const Shape& box, const Vec3& p, double slack) {
  bool is_in = true;
  for (int i = 0; i < 3; ++i) is_in = is_in && std::abs(p[i]) <= box.size[i] + slack;
  return is_in;
}

/// Pre: `axis` is an edge's. Nearest points of the two edges that face each other along n; false when they
/// are beyond an end, or the edges are parallel to 1e-3. Source: [Ericson2005], §5.1.9.
[[gnu::always_inline]] inline bool meet_edges(const Shape& a, const Shape& b, const Pose& b_in_a,
                                              const BoxAxis& axis, const Vec3& n, SignedPair& r) {
  Vec3 on_a = core_support(a, n), on_b = core_support(b, Vec3(-transposed_times(b_in_a.rotation, n)));
  on_a[axis.edge_a] = on_b[axis.edge_b] = 0;
  r.point_b = b_in_a.to_world(on_b);
  const Vec3 v = column(b_in_a.rotation, axis.edge_b), x = r.point_b - on_a;
  const double uv = v[axis.edge_a], ux = x[axis.edge_a], vx = dot(v, x), square = axis.length * axis.length;
  const double size_a = a.size[axis.edge_a], size_b = b.size[axis.edge_b], s = (ux - vx * uv) / square;
  const double t = std::clamp(s, -size_a, size_a) * uv - vx, t_b = std::clamp(t, -size_b, size_b);
  r.point_a = on_a, r.point_b += t_b * v;
  r.point_a[axis.edge_a] = std::clamp(t_b * uv + ux, -size_a, size_a);
  return square > 1e-6 && std::abs(s) <= size_a && std::abs(t) <= size_b;
}

/// Moves p, over the face k of `box`, to where the other box is as well: to the nearest point of the one,
/// then of the other, until that is 1e-6 of the size at most. False where that takes more than a few rounds.
inline bool move_into_both(const Shape& box, int k, const Shape& other, const Pose& other_in_box, Vec3& p) {
  const double size = std::min(length_scale(box), length_scale(other));
  for (int round = 0; round < 16; ++round) {
    Vec3 q = other_in_box.to_local(p);
    if (!move_over_face(other, -1, q)) return true;
    const Vec3 before = p;
    p = other_in_box.to_world(q);
    const double way = squared_norm(p - before);
    move_over_face(box, k, p);
    if (way < 1e-12 * size * size) return true;
  }
  return false;
}

/// Whether the columns are unit vectors but for rounding. Those of single precision are not: what edges say
/// that are parallel to θ would be wrong by 1e-7 / θ of the size.
[[gnu::always_inline]] inline bool is_exact(const Mat3& R) {
  bool is = true;
  for (int k = 0; k < 3; ++k)
    is = is && std::abs(R(0, k) * R(0, k) + R(1, k) * R(1, k) + R(2, k) * R(2, k) - 1) < 1e-14;
  return is;
}

/// The signed distance of two boxes up to `margin`, in the frame of A, with what a certificate would prove of
/// it. An overlap is the least over all axes. Boxes that are apart are as far as the axis says where a corner
/// is over a face, two faces or a face and an edge are parallel, or two edges cross; of others,
/// where the distance is one to a corner or along no axis, this tells nothing and returns false. So it does
/// of a rotation in single precision.
template <std::same_as<SignedPair> Pair>
bool two_boxes(const Shape& a, const Shape& b, const Pose& b_in_a, double margin, Pair& r) {
  if (!is_exact(b_in_a.rotation)) return false;
  const BoxAxis axis(a, b, b_in_a);
  if (!(std::abs(axis.distance) < std::numeric_limits<double>::infinity())) return false;
  Vec3 n = axis.normal(b_in_a);
  n *= 1.5 - 0.5 * squared_norm(n);
  const Vec3 top = core_support(a, n), bottom = core_support(b, Vec3(-transposed_times(b_in_a.rotation, n)));
  const Vec3 bottom_in_a = b_in_a.to_world(bottom);
  const double height_a = dot(n, top), height_b = dot(n, bottom_in_a);
  r.normal = n;
  r.distance = height_b - height_a;
  r.status = r.distance > margin ? PairStatus::far : PairStatus::near;
  if (r.status == PairStatus::far) return true;
  const double rounding = 4e-15 * (std::abs(height_a) + std::abs(height_b));
  const double slack = 1e-9 * std::max(r.distance, 0.0) + rounding;
  const bool is_deep = r.distance < -rounding;
  bool is_there = true;
  if (axis.face < 0) {
    is_there = meet_edges(a, b, b_in_a, axis, n, r) || is_deep;
  } else if (axis.face < 3) {
    r.point_a = bottom_in_a;
    if (move_over_face(a, axis.face, r.point_a)) {
      const Vec3 on_b = r.point_a + (height_b - dot(n, r.point_a)) * n;
      is_there = is_deep ? move_into_both(a, axis.face, b, b_in_a, r.point_a)
                         : is_in_box(b, b_in_a.to_local(on_b), slack);
    }
    r.point_b = r.point_a;
  } else {
    Vec3 p = b_in_a.to_local(top);
    r.point_a = r.point_b = top;
    if (move_over_face(b, axis.face - 3, p)) {
      if (is_deep) is_there = move_into_both(b, axis.face - 3, a, b_in_a.to_local(Pose{}), p);
      r.point_a = r.point_b = b_in_a.to_world(p);
      if (!is_deep) is_there = is_in_box(a, Vec3(r.point_b + (height_a - dot(n, r.point_b)) * n), slack);
    }
  }
  if (!is_there) return false;
  put_witnesses(height_a, height_b, r);
  return is_finite(r.point_a) && is_finite(r.point_b);
}

}  // namespace delassus::inner
