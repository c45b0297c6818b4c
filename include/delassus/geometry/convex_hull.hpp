/// The convex hull of a point cloud: its vertices, polygonal faces and moments of volume.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/bits.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/owning_array.hpp>
#include <delassus/core/slice.hpp>
#include <delassus/geometry/inner/hull_faces.hpp>
#include <delassus/geometry/inner/quickhull.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/math/two_lanes.hpp>

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>

namespace delassus {

/// A convex polytope in its own frame, m. Faces are polygons, counter-clockwise seen from outside: coplanar
/// triangles are merged, and points inside the hull, on a face or on an edge are dropped.
template <class Scalar>
class BasicConvexHull {
 public:
  using Vector = Vec<3, Scalar>;     ///< also of points, m
  using Matrix = Mat<3, 3, Scalar>;  ///< of second moments

  BasicConvexHull() = default;  ///< nothing yet: a checkpoint fills it
  /// Refuses less than four points, points that are not finite, and a cloud in one plane (thickness ≤ 1e-6 of its
  /// extent).
  explicit BasicConvexHull(std::span<const Vector> points) {
    const Scalar extent = check_points(points);
    OwningArray<inner::HullTriangle> triangles;
    DELASSUS_EXPECT(
        inner::quickhull(points, extent, triangles),
        "the points of a convex hull lie in one plane or on one line (thickness <= 1e-6 of the extent " +
            inner::text(extent) + " m); give points that span a volume, or use a thin Box");
    const inner::HullFaces merged = inner::merge_coplanar(points, triangles, 1e-7 * extent);
    vertices_ = merged.vertices;
    normals_ = merged.normals;
    face_start_ = merged.start;
    face_loop_ = merged.loop;
    find_neighbours();
    find_moments();
    find_fingerprint();
    put_in_blocks();
  }

  std::span<const Vector> vertices() const { return {vertices_.data(), vertices_.size()}; }  ///< the corners alone, m
  /// The vertices once more, as many at a time as there are lanes: their x, their y, their z; the last vertex
  /// fills its block.
  std::span<const Scalar> blocks() const { return {blocks_.data(), blocks_.size()}; }
  Index face_count() const { return Index(normals_.size()); }  ///< of polygons, not triangles
  /// Vertex indices of a face, counter-clockwise from outside.
  std::span<const Index> face(Index f) const { return slice(face_loop_, face_start_, f); }
  const Vector& normal(Index f) const { return normals_[f]; }  ///< of face f, unit, outward
  /// The faces that meet in a vertex, ascending.
  std::span<const Index> faces_around(Index v) const { return slice(around_, around_start_, v); }

  /// ∫ dV, m³.
  Scalar volume() const { return volume_; }
  const Vector& centroid() const { return centroid_; }  ///< the centre of volume c, m
  const Matrix& second_moment() const { return second_moment_; }  ///< ∫ (x − c)(x − c)ᵀ dV, m⁵
  /// Of the ball about c that touches the nearest face, m.
  Scalar inner_radius() const { return inner_radius_; }
  Scalar outer_radius() const { return outer_radius_; }  ///< of the ball about c that holds all vertices, m

  /// A number for all its vertices: another for every other hull, but for one chance in 2⁶⁴.
  std::uint64_t fingerprint() const { return fingerprint_; }

  /// The same hull with its centre of volume at the origin.
  BasicConvexHull centred() const {
    BasicConvexHull moved = *this;
    for (Vector& v : moved.vertices_) v -= centroid_;
    set_zero(moved.centroid_);
    moved.find_fingerprint();
    moved.put_in_blocks();
    return moved;
  }

  void memory(auto& archive) {
    archive(vertices_, normals_, face_start_, face_loop_, around_start_, around_, volume_, inner_radius_, outer_radius_, centroid_,
            second_moment_, fingerprint_);
    if (archive.reads) put_in_blocks();
  }

 private:
  static std::span<const Index> slice(const Array<Index>& items, const Array<Index>& start, Index i) {
    return {items.data() + start[i], std::size_t(start[i + 1] - start[i])};
  }
  static Scalar check_points(std::span<const Vector> points);
  void find_neighbours();
  void find_moments();
  void find_fingerprint() {
    fingerprint_ = vertices_.size();
    for (const Vector& v : vertices_)
      for (int k = 0; k < 3; ++k)
        fingerprint_ = ((fingerprint_ ^ inner::bits_as<std::uint64_t>(v[k])) * 0x9e3779b97f4a7c15ull) ^ fingerprint_ >> 29;
  }
  void put_in_blocks() {
    constexpr std::size_t lanes = 2;
    const std::size_t count = vertices_.size(), room = (count + lanes - 1) / lanes * lanes;
    blocks_.resize(3 * room);
    for (std::size_t i = 0; i < room; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        blocks_[(3 * (i / lanes) + k) * lanes + i % lanes] = vertices_[std::min(i, count - 1)][Index(k)];
  }

  Array<Vector> vertices_, normals_;
  Array<Scalar> blocks_;
  Array<Index> face_start_, face_loop_, around_start_, around_;
  Scalar volume_ = 0, inner_radius_ = 0, outer_radius_ = 0;
  Vector centroid_ = zero<Vector>();
  Matrix second_moment_ = zero<Matrix>();
  std::uint64_t fingerprint_ = 0;
};

using ConvexHull = BasicConvexHull<double>;  ///< in double

/// The longest edge of the cloud's box, m.
template <class Scalar>
Scalar BasicConvexHull<Scalar>::check_points(std::span<const Vector> points) {
  DELASSUS_EXPECT(points.size() >= 4,
                  "a convex hull needs at least 4 points, got " + std::to_string(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    DELASSUS_EXPECT(is_finite(points[i]), "convex hull point #" + std::to_string(i) + " is not finite");
  Scalar extent = 0;
  for (int k = 0; k < 3; ++k) {
    Scalar low = points[0][k], high = low;
    for (const Vector& p : points) {
      low = std::min(low, p[k]);
      high = std::max(high, p[k]);
    }
    extent = std::max(extent, high - low);
  }
  DELASSUS_EXPECT(
      std::isfinite(extent) && extent > 0,
      "the points of a convex hull span " + inner::text(extent) + " m; give points that span a volume");
  return extent;
}

template <class Scalar>
void BasicConvexHull<Scalar>::find_neighbours() {
  around_start_.assign(vertices_.size() + 1, 0);
  for (const Index v : face_loop_) ++around_start_[v + 1];
  for (std::size_t v = 0; v < vertices_.size(); ++v) around_start_[v + 1] += around_start_[v];
  around_.resize(face_loop_.size());
  Array<Index> next(around_start_.begin(), around_start_.end() - 1);
  for (Index f = 0; f < face_count(); ++f)
    for (const Index v : face(f)) around_[next[v]++] = f;
}

/// Sums tetrahedra from the mean vertex m to the triangles of each face. With edges a, b, c from m, s their sum and
/// y = x − m:
///
///   V = det(a, b, c)/6,   ∫ y = V s/4,   ∫ y yᵀ = V/20 (s sᵀ + a aᵀ + b bᵀ + c cᵀ).
template <class Scalar>
void BasicConvexHull<Scalar>::find_moments() {
  Vector mean = zero<Vector>(), first = zero<Vector>();
  for (const Vector& v : vertices_) mean += v / Scalar(vertices_.size());
  Matrix second = zero<Matrix>();
  for (Index f = 0; f < face_count(); ++f) {
    const inner::Slice<const Index> loop = face(f);
    for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
      const Vector a = vertices_[loop[0]] - mean, b = vertices_[loop[k]] - mean,
                 c = vertices_[loop[k + 1]] - mean;
      const Vector s = a + b + c;
      const Scalar volume = dot(a, cross(b, c)) / 6;
      volume_ += volume;
      first += volume / 4 * s;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          second(i, j) += volume / 20 * (s[i] * s[j] + a[i] * a[j] + b[i] * b[j] + c[i] * c[j]);
    }
  }
  const Vector shift = first / volume_;
  centroid_ = mean + shift;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) second_moment_(i, j) = second(i, j) - volume_ * shift[i] * shift[j];
  for (const Vector& v : vertices_) outer_radius_ = std::max(outer_radius_, norm(v - centroid_));
  inner_radius_ = outer_radius_;
  for (Index f = 0; f < face_count(); ++f)
    inner_radius_ = std::min(inner_radius_, dot(normals_[f], vertices_[face(f)[0]] - centroid_));
}

}  // namespace delassus
