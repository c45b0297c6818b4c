/// A surface of triangles: its vertices, who neighbours whom, and the tree in which they are found.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/geometry/inner/triangle_surface.hpp>

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace delassus {

/// Triangles over shared vertices, in its own frame, m. Each is counter-clockwise seen from outside, and the
/// solid is behind it; the surface may be open.
class TriangleMesh : public inner::TriangleSurface {
 public:
  TriangleMesh() = default;  ///< no triangle, until `memory` reads one
  /// Refuses, by the number of the element: vertices that are not finite, indices out of range, triangles flatter than
  /// 1e-6 of their longest edge. Refuses edges that more than two triangles share or that two run through in one
  /// direction, and no triangle at all.
  TriangleMesh(std::span<const Vec3> vertices, std::span<const std::array<Index, 3>> triangles) {
    vertices_.assign(vertices.begin(), vertices.end());
    corners_.assign(triangles.begin(), triangles.end());
    DELASSUS_EXPECT(!corners_.empty(), "a triangle mesh needs at least one triangle");
    for (std::size_t v = 0; v < vertices_.size(); ++v)
      DELASSUS_EXPECT(is_finite(vertices_[v]), "mesh vertex #" + std::to_string(v) + " is not finite");
    for (Index t = 0; t < triangle_count(); ++t)
      for (const Index v : corners_[t])
        DELASSUS_EXPECT(v >= 0 && v < Index(vertices_.size()),
                        "mesh triangle #" + std::to_string(t) + ": vertex index " + std::to_string(v) +
                            " must be in [0, " + std::to_string(vertices_.size()) + ")");
    for (Index t = 0; t < triangle_count(); ++t) {
      const auto [a, b, c] = points_of(t);
      normals_.push_back(inner::triangle_normal(a, b, c));
      DELASSUS_EXPECT(squared_norm(normals_[t]) > 0.5,
                      "mesh triangle #" + std::to_string(t) +
                          " is flat (height <= 1e-6 of its longest edge); drop it or join its vertices");
    }
    topology_ = inner::SurfaceTopology(corners_, Index(vertices_.size()));
    check_edges();
    tree_.build(triangle_count(), [&](Index t) { return bounds_of(t); });
  }

  /// Whether it has no border; asks all its edges.
  bool is_closed() const { return topology_.is_closed(); }

  void memory(auto& archive) { archive(vertices_, normals_, corners_, topology_, tree_); }

 private:
  void check_edges() const {
    for (const inner::SharedEdge& e : topology_.faults()) {
      const std::string which = "mesh edge (" + std::to_string(e.low) + ", " + std::to_string(e.high) +
                                "): triangles #" + std::to_string(e.first) + " and #" +
                                std::to_string(e.second);
      DELASSUS_EXPECT(e.third < 0,
                      which + " share it with #" + std::to_string(e.third) + "; at most two may");
      inner::refuse(which + " run through it in one direction; both must be counter-clockwise from outside");
    }
  }
};

}  // namespace delassus
