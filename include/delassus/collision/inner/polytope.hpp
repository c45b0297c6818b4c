/// The growing polytope of EPA: triangles over points of A − B, in fixed storage.
#pragma once

#include <delassus/collision/inner/simplex.hpp>
#include <delassus/core/fixed_array.hpp>

#include <cstdint>
#include <limits>

namespace delassus::inner {

/// A convex polytope inside A − B. A face whose plane is useless has the offset +∞ and goes with the next
/// point.
template <class Scalar>
class BasicPolytope {
 public:
  using Vec3 = Vec<3, Scalar>;

  static constexpr int max_points = 240, max_faces = 2 * max_points;
  struct Face {
    FixedArray<std::uint8_t, 3> v;
    Vec3 normal;
    Scalar offset;
  };

  /// Pre: four points that span a volume.
  explicit BasicPolytope(const FixedArray<DifferencePoint, 4>& corner) : points_count_(4) {
    for (int i = 0; i < 4; ++i) points_[i] = corner[i];
    const Vec3 normal = cross(corner[1].w - corner[0].w, corner[2].w - corner[0].w);
    if (dot(normal, corner[3].w - corner[0].w) > 0) std::swap(points_[1], points_[2]);
    add_face(0, 1, 2), add_face(0, 3, 1), add_face(0, 2, 3), add_face(1, 3, 2);
  }

  const Face& face(int f) const { return faces_[f]; }
  int face_count() const { return faces_count_; }
  FixedArray<DifferencePoint, 3> corners(int f) const {
    const auto& v = faces_[f].v;
    return {points_[v[0]], points_[v[1]], points_[v[2]]};
  }
  bool is_full() const { return points_count_ == max_points || faces_count_ + 64 > max_faces; }
  void retire(int f) { faces_[f].offset = std::numeric_limits<double>::infinity(); }

  /// The face whose plane is nearest to the origin, the one with the origin outside first; −1 when none is
  /// left.
  int nearest_face() const {
    int best = -1;
    for (int f = 0; f < faces_count_; ++f)
      if (faces_[f].offset < std::numeric_limits<double>::infinity())
        if (best < 0 || faces_[f].offset < faces_[best].offset) best = f;
    return best;
  }

  /// Replaces what `q` sees, from `tolerance` above a plane on, by a fan to its horizon. False when it sees
  /// nothing.
  bool extend(const DifferencePoint& q, Scalar tolerance) {
    int kept = 0, edges = 0;
    for (int f = 0; f < faces_count_; ++f) {
      const Face& face = faces_[f];
      const bool is_seen = face.offset == std::numeric_limits<double>::infinity() ||
                           dot(face.normal, q.w) - face.offset > tolerance;
      if (!is_seen) {
        if (kept != f) faces_[kept] = face;
        ++kept;
        continue;
      }
      for (int k = 0; k < 3; ++k) edges = toggle(face.v[k], face.v[(k + 1) % 3], edges);
    }
    if (kept == faces_count_) return false;
    faces_count_ = kept;
    const int apex = points_count_++;
    points_[apex] = q;
    for (int e = 0; e < edges && faces_count_ < max_faces; ++e) add_face(edges_[e][0], edges_[e][1], apex);
    return true;
  }

 private:
  void add_face(int i, int j, int k) {
    Face& face = faces_[faces_count_++];
    face.v = {std::uint8_t(i), std::uint8_t(j), std::uint8_t(k)};
    const Vec3 &a = points_[i].w, &b = points_[j].w, &c = points_[k].w;
    face.normal = cross(b - a, c - a);
    const Scalar area2 = norm(face.normal);
    // The normal of a sliver holds no digits below this: its height is lost in the rounding of its edges.
    const Scalar edge2 = std::max(squared_norm(b - a), squared_norm(c - a));
    if (!(area2 > 1e-12 * edge2)) {
      face.offset = std::numeric_limits<double>::infinity();
      return;
    }
    face.normal /= area2;
    face.offset = dot(face.normal, a);
  }

  /// Keeps the edges that only one of the removed faces has: an edge meets its reverse and both go.
  int toggle(std::uint8_t i, std::uint8_t j, int count) {
    for (int e = 0; e < count; ++e) {
      if (edges_[e][0] != j || edges_[e][1] != i) continue;
      edges_[e] = edges_[count - 1];
      return count - 1;
    }
    if (count < int(edges_.size())) edges_[count++] = {i, j};
    return count;
  }

  FixedArray<DifferencePoint, max_points> points_;
  FixedArray<Face, max_faces> faces_;
  FixedArray<FixedArray<std::uint8_t, 2>, 3 * max_faces / 2> edges_;
  int points_count_ = 0, faces_count_ = 0;
};

using Polytope = BasicPolytope<double>;

}  // namespace delassus::inner
