/// What touches the surface of a deformable body between its nodes: convex shapes, meshes, surfaces.
#pragma once

#include <delassus/collision/collider.hpp>
#include <delassus/collision/inner/margins.hpp>
#include <delassus/collision/inner/patch_doubts.hpp>
#include <delassus/collision/inner/soft_surface.hpp>
#include <delassus/collision/inner/surface_crossing.hpp>
#include <delassus/collision/triangle_patch.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/sort.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace delassus::inner {

/// Fills `found` with features in touch, in the world, distances without any thickness; a on the soft
/// surface.
class SoftPairs {
 public:
  std::vector<FeatureContact> found;

  /// A convex shape on the triangles. Points at nodes are left out: nodes are spheres to the backend.
  Index collide(const SoftSurface& soft, const Shape& shape, const Pose& pose, double reach, double scale) {
    found.clear();
    found_on_.clear();
    const auto add_to_found = [&](Index t, const Patch& patch, const Vec3& n) {
      for (int i = 0; i < patch.count; ++i) add(soft, t, patch.point[i], n);
    };
    const Index queries = doubts_.collect(soft, shape, pose, reach, scale, add_to_found, [](const Triangle&, Index) {});
    for (std::size_t i = 0; i < found.size(); ++i) found[i].is_dropped = doubts_.is_false(found_on_[i]);
    drop();
    drop_twins_of_edges(scale);
    return queries;
  }

  /// A mesh or a height field. Soft nodes on its triangles are left out: the backend has them.
  template <class Surface>
  Index cross(const SoftSurface& soft, const Surface& mesh, const Pose& pose, const TouchRange& range) {
    const Index queries =
        cross_all(PosedSurface<SoftSurface>{soft}, PosedSurface<Surface>{mesh, pose}, range);
    for (FeatureContact& c : found) c.is_dropped = is_vertex_of_a(c.point.name);
    drop();
    return queries;
  }
  /// Another soft surface, or the same one.
  Index cross(const SoftSurface& a, const SoftSurface& b, const TouchRange& range) {
    return cross_all(PosedSurface<SoftSurface>{a}, PosedSurface<SoftSurface>{b}, range, &a == &b);
  }

  /// Makes the names of the contacts differ, in their order.
  void name_apart() {
    inner::sort(found, goes_before);
    for (std::size_t i = 1; i < found.size(); ++i)
      if (found[i].point.name <= found[i - 1].point.name) found[i].point.name = found[i - 1].point.name + 1;
  }

 private:
  template <class A, class B>
  Index cross_all(const PosedSurface<A>& a, const PosedSurface<B>& b, const TouchRange& range,
                  bool is_self = false) {
    found.clear();
    return SurfaceCrossing<A, B>(a, b, range, found, is_self).collect();
  }

  /// A point on an edge gets the triangle that owns the edge, whichever of its two triangles found it.
  void add(const SoftSurface& soft, Index t, const PatchPoint& p, const Vec3& n) {
    const Vec3 w = soft.shares(t, p.a);
    const int zeros = (w[0] == 0) + (w[1] == 0) + (w[2] == 0);
    if (zeros == 2) return;
    FeatureContact c{p, n, t, -1};
    std::uint32_t name = 4u * std::uint32_t(t) * 0x9e3779b9u + p.name * 0x85ebca6bu;
    if (zeros == 1) {
      int k = w[2] == 0 ? 0 : w[0] == 0 ? 1 : 2;
      const Index other = soft.neighbour(t, k);
      if (other >= 0 && !soft.owns_edge(t, k)) {
        for (int j = 0; j < 3; ++j)
          if (soft.neighbour(other, j) == t) k = j;
        c.triangle_a = other;
      }
      c.edge_a = k;
      name = (4u * std::uint32_t(c.triangle_a) + std::uint32_t(k) + 1u) * 0x9e3779b9u;
    }
    c.point.name = 3u << 30 | (name & 0x3fffffffu);
    found.push_back(c);
    found_on_.push_back(t);
  }

  void drop() {
    std::erase_if(found, [](const FeatureContact& c) { return c.is_dropped; });
  }

  /// Both triangles of an edge find what touches it: of points nearer than 1e-3 L with normals within 5° the
  /// first stays.
  void drop_twins_of_edges(double scale) {
    inner::sort(found, goes_before);
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (found[i].edge_a < 0) continue;
      for (std::size_t j = i; j-- > 0 && found[j].point.name == found[i].point.name;)
        if (!found[j].is_dropped && found[j].edge_a >= 0 && dot(found[j].normal, found[i].normal) > 0.9962 &&
            squared_norm(found[j].point.a - found[i].point.a) < 1e-6 * scale * scale)
          found[i].is_dropped = true;
    }
    drop();
  }

  PatchDoubts doubts_;
  Array<Index> found_on_;  ///< the triangle of each in `found`
};

}  // namespace delassus::inner
