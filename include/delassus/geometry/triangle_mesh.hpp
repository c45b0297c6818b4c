/// A surface of triangles: its vertices, who neighbours whom, and the tree in which they are found.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/geometry/inner/flat_tree.hpp>
#include <delassus/geometry/inner/surface_topology.hpp>
#include <delassus/geometry/triangle.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <vector>

namespace delassus {

/// Triangles over shared vertices, in its own frame, m. Each is counter-clockwise seen from outside, and the
/// solid is behind it; the surface may be open. Refused, by the number of the element: vertices that are not
/// finite, indices out of range, triangles flatter than 1e-6 of their longest edge, edges that more than two
/// triangles share or that two run through in one direction.
class TriangleMesh {
 public:
  TriangleMesh() = default;  ///< no triangle, until `memory` reads one
  TriangleMesh(std::span<const Vec3> vertices, std::span<const std::array<Index, 3>> triangles)
      : vertices_(vertices.begin(), vertices.end()), corners_(triangles.begin(), triangles.end()) {
    DELASSUS_EXPECT(!corners_.empty(), "a triangle mesh needs at least one triangle");
    check_vertices(vertices_);
    for (Index t = 0; t < triangle_count(); ++t)
      for (const Index v : corners_[t])
        DELASSUS_EXPECT(v >= 0 && v < Index(vertices_.size()),
                        "mesh triangle #" + std::to_string(t) + ": vertex index " + std::to_string(v) +
                            " must be in [0, " + std::to_string(vertices_.size()) + ")");
    normals_.resize(corners_.size());
    find_normals(vertices_, normals_);
    topology_ = inner::SurfaceTopology(corners_, Index(vertices_.size()));
    check_edges();
    tree_.build(triangle_count(), [&](Index t) { return bounds_of(t); });
  }

  Index triangle_count() const { return Index(corners_.size()); }
  std::span<const Vec3> vertices() const { return vertices_; }
  std::span<const std::array<Index, 3>> triangles() const { return corners_; }
  inner::Bounds bounds() const { return tree_.bounds(); }

  Triangle triangle(Index t) const {
    Triangle out;
    out.corner = corners_[t];
    out.normal = normals_[t];
    for (int k = 0; k < 3; ++k) out.point[k] = vertices_[corners_[t][k]];
    for (int k = 0; k < 3; ++k) {
      const Index other = neighbour(t, k);
      out.lean[k] = other < 0 ? 1 : inner::lean_towards(out.normal, normals_[other], out.outward(k));
    }
    return out;
  }

  // --- what another surface asks: its tree and its features ------------------------------------------------

  static constexpr Index triangles_per_item = 1;
  const inner::FlatTree& tree() const { return tree_; }
  const Vec3& vertex(Index v) const { return vertices_[v]; }
  std::array<Vec3, 3> points_of(Index t) const {
    const auto& [a, b, c] = corners_[t];
    return {vertices_[a], vertices_[b], vertices_[c]};
  }
  const Vec3& normal(Index t) const { return normals_[t]; }
  /// The triangle across edge k, −1 at the border.
  Index neighbour(Index t, int k) const { return topology_.neighbour(t, k); }
  /// Whether it has no border; asks all its edges.
  bool is_closed() const { return topology_.is_closed(); }
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

  /// Moves all vertices and fits the tree to them; the triangles stay. What cannot be is refused, and then
  /// nothing moves.
  void move_vertices(std::span<const Vec3> vertices) {
    DELASSUS_EXPECT(vertices.size() == vertices_.size(), "a mesh of " + std::to_string(vertices_.size()) +
                                                             " vertices cannot move to " +
                                                             std::to_string(vertices.size()));
    check_vertices(vertices);
    moved_normals_.resize(normals_.size());
    find_normals(vertices, moved_normals_);
    std::copy(vertices.begin(), vertices.end(), vertices_.begin());
    normals_.swap(moved_normals_);
    refit();
  }
  /// Fits the boxes bottom-up, in time proportional to the triangles.
  void refit() {
    tree_.fit([&](Index t) { return bounds_of(t); });
  }

  void memory(auto& archive) { archive(vertices_, normals_, corners_, topology_, tree_); }

 private:
  static void check_vertices(std::span<const Vec3> vertices) {
    for (std::size_t v = 0; v < vertices.size(); ++v)
      DELASSUS_EXPECT(is_finite(vertices[v]), "mesh vertex #" + std::to_string(v) + " is not finite");
  }

  inner::Bounds bounds_of(Index t) const {
    inner::Bounds b;
    for (const Index v : corners_[t]) b.add(vertices_[v]);
    return b;
  }

  void find_normals(std::span<const Vec3> vertices, std::vector<Vec3>& normals) const {
    for (Index t = 0; t < triangle_count(); ++t) {
      const auto& [a, b, c] = corners_[t];
      normals[t] = inner::triangle_normal(vertices[a], vertices[b], vertices[c]);
      DELASSUS_EXPECT(normals[t].squaredNorm() > 0.5,
                      "mesh triangle #" + std::to_string(t) +
                          " is flat (height <= 1e-6 of its longest edge); drop it or join its vertices");
    }
  }

  void check_edges() const {
    topology_.each_fault([](const inner::SharedEdge& e, bool is_crowded) {
      const std::string which = "mesh edge (" + std::to_string(e.low) + ", " + std::to_string(e.high) +
                                "): triangles #" + std::to_string(e.first) + " and #" +
                                std::to_string(e.second);
      DELASSUS_EXPECT(!is_crowded,
                      which + " share it with #" + std::to_string(e.third) + "; at most two may");
      inner::refuse(which + " run through it in one direction; both must be counter-clockwise from outside");
    });
  }

  std::vector<Vec3> vertices_, normals_, moved_normals_;
  std::vector<std::array<Index, 3>> corners_;
  inner::SurfaceTopology topology_;
  inner::FlatTree tree_;
};

}  // namespace delassus
