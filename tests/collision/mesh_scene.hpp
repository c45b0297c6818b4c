/// Surfaces of triangles for tests: flat grids, a box, and scenes of bodies on them.
#pragma once

#include "collision/scene.hpp"

#include <delassus/collision/with_meshes.hpp>

#include <array>
#include <random>
#include <vector>

namespace scenes {

using MeshScene = SceneOf<WithMeshes<NativeCollision>>;
using Corners = std::array<Index, 3>;

/// The square [−half, half]² at z = 0 in cells × cells squares of two triangles; inner points are moved by up
/// to `jitter` of a cell within the plane.
inline TriangleMesh flat_grid(double half, int cells, double jitter = 0, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-jitter, jitter);
  std::vector<Vec3> vertices;
  std::vector<Corners> triangles;
  const double edge = 2 * half / cells;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) {
      const bool is_inner = i > 0 && j > 0 && i < cells && j < cells;
      const double dx = is_inner ? uniform(random) : 0, dy = is_inner ? uniform(random) : 0;
      vertices.push_back({(i + dx) * edge - half, (j + dy) * edge - half, 0});
    }
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const Index v = j * (cells + 1) + i, up = v + cells + 1;
      triangles.push_back({v, v + 1, up + 1});
      triangles.push_back({v, up + 1, up});
    }
  return TriangleMesh(vertices, triangles);
}

/// The surface of a box with full edges x, y, z, each side in cells × cells squares of two triangles.
inline TriangleMesh fine_box(double x, double y, double z, int cells) {
  std::vector<Vec3> vertices;
  std::vector<Corners> triangles;
  const auto place = [&](int i, int j, int k) {
    const Vec3 p(x * (double(i) / cells - 0.5), y * (double(j) / cells - 0.5), z * (double(k) / cells - 0.5));
    for (Index v = 0; v < Index(vertices.size()); ++v)
      if (vertices[v] == p) return v;
    vertices.push_back(p);
    return Index(vertices.size()) - 1;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (int end = 0; end < 2; ++end)
      for (int j = 0; j < cells; ++j)
        for (int i = 0; i < cells; ++i) {
          const auto at = [&](int u, int v) {
            std::array<int, 3> node{};
            node[axis] = end * cells;
            node[(axis + 1) % 3] = u;
            node[(axis + 2) % 3] = v;
            return place(node[0], node[1], node[2]);
          };
          const Index a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
          triangles.push_back(end == 1 ? Corners{a, b, c} : Corners{a, c, b});
          triangles.push_back(end == 1 ? Corners{a, c, d} : Corners{a, d, c});
        }
  return TriangleMesh(vertices, triangles);
}

/// The surface of a box with full edges x, y, z.
inline TriangleMesh box_mesh(double x, double y, double z) {
  std::vector<Vec3> v;
  for (int i = 0; i < 8; ++i)
    v.push_back({i & 1 ? x / 2 : -x / 2, i & 2 ? y / 2 : -y / 2, i & 4 ? z / 2 : -z / 2});
  const std::vector<Corners> t{{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                               {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return TriangleMesh(v, t);
}

}  // namespace scenes
