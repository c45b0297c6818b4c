/// Triangles over shared vertices: what shapes and other surfaces ask of them.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/geometry/inner/flat_tree.hpp>
#include <delassus/geometry/inner/surface_topology.hpp>
#include <delassus/geometry/triangle.hpp>

#include <array>
#include <span>
#include <vector>

namespace delassus::inner {

/// Who derives from it fills in vertices, corners and normals, and makes topology and tree of them.
class TriangleSurface {
 public:
  Index triangle_count() const { return Index(corners_.size()); }
  std::span<const Vec3> vertices() const { return vertices_; }
  std::span<const std::array<Index, 3>> triangles() const { return corners_; }
  Bounds bounds() const { return tree_.bounds(); }

  Triangle triangle(Index t) const {
    Triangle out{.point = points_of(t), .corner = corners_[t], .normal = normals_[t]};
    find_leans(*this, t, out);
    return out;
  }

  static constexpr Index triangles_per_item = 1;
  const FlatTree& tree() const { return tree_; }
  const Vec3& vertex(Index v) const { return vertices_[v]; }
  std::array<Vec3, 3> points_of(Index t) const {
    const auto& [a, b, c] = corners_[t];
    return {vertices_[a], vertices_[b], vertices_[c]};
  }
  const Vec3& normal(Index t) const { return normals_[t]; }
  /// The triangle across edge k, −1 at the border.
  Index neighbour(Index t, int k) const { return topology_.neighbour(t, k); }
  bool owns_corner(Index t, int k) const { return topology_.owns_corner(t, k); }
  bool owns_edge(Index t, int k) const { return topology_.owns_edge(t, k); }
  template <class F>
  void each_around(Index v, const F& f) const {
    topology_.each_around(v, f);
  }

  /// Calls visit(t) for the triangles in every leaf of the tree whose box passes `meets(bounds)`.
  template <class Meets, class Visit>
  void visit(const Meets& meets, const Visit& visit) const {
    tree_.visit(meets, visit);
  }

  /// Fits the boxes bottom-up, in time proportional to the triangles.
  void refit() {
    tree_.fit([&](Index t) { return bounds_of(t); });
  }

 protected:
  Bounds bounds_of(Index t) const {
    Bounds b;
    for (const Index v : corners_[t]) b.add(vertices_[v]);
    return b;
  }

  std::vector<Vec3> vertices_, normals_;
  std::vector<std::array<Index, 3>> corners_;  ///< vertices of each triangle
  SurfaceTopology topology_;
  FlatTree tree_;
};

}  // namespace delassus::inner
