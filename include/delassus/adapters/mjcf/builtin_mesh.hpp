/// Meshes that MJCF makes by itself: spheres, half-spheres, cones, superspheres, supertori.
#pragma once

#include <delassus/adapters/mjcf/mesh_mass.hpp>
#include <delassus/adapters/mjcf/source.hpp>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace delassus::inner::mjcf {

struct RawMesh {
  std::vector<Vec3> vertices;
  Triangles triangles;  ///< none: the hull of the vertices
};

/// sign(x) |x|^m.
inline double signed_power(double x, double m) { return std::copysign(std::pow(std::abs(x), m), x); }

/// Rings of `around` points each, every one joined to the next.
inline void join_rings(Triangles& to, Index first, Index rings, Index around, bool is_closed) {
  for (Index i = 0; i + (is_closed ? 0 : 1) < rings; ++i)
    for (Index j = 0; j < around; ++j) {
      const Index next = (i + 1) % rings, a = first + i * around + j,
                  b = first + i * around + (j + 1) % around, c = first + next * around + (j + 1) % around,
                  d = first + next * around + j;
      to.push_back({a, b, d});
      to.push_back({b, c, d});
    }
}

/// x = cⁿ(v) cᵉ(u), y = cⁿ(v) sᵉ(u), z = sⁿ(v), with c and s the signed powers of cos and sin.
inline RawMesh supersphere(Index n, double e, double m) {
  RawMesh mesh;
  mesh.vertices.push_back({0, 0, -1});
  for (Index i = 1; i < n; ++i)
    for (Index j = 0; j < n; ++j) {
      const double v = -pi / 2 + i * pi / n, u = -pi + j * 2 * pi / n, c = signed_power(std::cos(v), m);
      mesh.vertices.push_back(
          {c * signed_power(std::cos(u), e), c * signed_power(std::sin(u), e), signed_power(std::sin(v), m)});
    }
  mesh.vertices.push_back({0, 0, 1});
  const Index top = Index(mesh.vertices.size()) - 1, last = 1 + (n - 2) * n;
  for (Index j = 0; j < n; ++j) mesh.triangles.push_back({0, 1 + (j + 1) % n, 1 + j});
  join_rings(mesh.triangles, 1, n - 1, n, false);
  for (Index j = 0; j < n; ++j) mesh.triangles.push_back({last + j, last + (j + 1) % n, top});
  return mesh;
}

inline RawMesh supertorus(Index n, double radius, double s, double t) {
  RawMesh mesh;
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) {
      const double u = 2 * pi * i / n, v = 2 * pi * j / n, r = 1 + radius * signed_power(std::cos(v), s);
      mesh.vertices.push_back({r * signed_power(std::cos(u), t), r * signed_power(std::sin(u), t),
                               radius * signed_power(std::sin(v), s)});
    }
  join_rings(mesh.triangles, 0, n, n, true);
  for (auto& face : mesh.triangles)
    std::swap(face[1], face[2]);  // u runs across the rings, so that they face outwards
  return mesh;
}

/// An icosahedron whose faces are parted `times` times into four.
inline RawMesh icosphere(int times) {
  const double phi = (1 + std::sqrt(5.0)) / 2;
  RawMesh mesh;
  for (const auto& [x, y, z] : {std::array{-1., phi, 0.},
                                {1., phi, 0.},
                                {-1., -phi, 0.},
                                {1., -phi, 0.},
                                {0., -1., phi},
                                {0., 1., phi},
                                {0., -1., -phi},
                                {0., 1., -phi},
                                {phi, 0., -1.},
                                {phi, 0., 1.},
                                {-phi, 0., -1.},
                                {-phi, 0., 1.}})
    mesh.vertices.push_back(direction_of(Vec3(x, y, z)));
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int k = 0; k < times; ++k) {
    std::map<std::pair<Index, Index>, Index> middles;
    const auto middle = [&](Index a, Index b) {
      const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), Index(mesh.vertices.size()));
      if (is_new)
        mesh.vertices.push_back(
            direction_of(Vec3(mesh.vertices[std::size_t(a)] + mesh.vertices[std::size_t(b)])));
      return at->second;
    };
    Triangles finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  return mesh;
}

/// The upper half: arcs between the pole and four points of the equator, n + 1 rows. Its hull is it.
inline RawMesh hemisphere(int n) {
  RawMesh mesh;
  const Vec3 pole(0, 0, 1), equator[] = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
  mesh.vertices.push_back(pole);
  for (int row = 1; row <= n + 1; ++row)
    for (int side = 0; side < 4; ++side)
      for (int i = 0; i < row; ++i) {
        const double down = double(row) / (n + 1), along = double(i) / row;
        const Vec3 ground = (1 - along) * equator[side] + along * equator[(side + 1) % 4];
        mesh.vertices.push_back(direction_of(Vec3((1 - down) * pole + down * ground)));
      }
  return mesh;
}

/// A prism that narrows to `top` of its width, or to a point.
inline RawMesh cone(Index edges, double top) {
  RawMesh mesh;
  for (const double z : {-1., 1.})
    for (Index i = 0; i < edges; ++i) {
      const double r = z < 0 ? 1 : top;
      if (r > 0)
        mesh.vertices.push_back({r * std::cos(2 * i * pi / edges), r * std::sin(2 * i * pi / edges), z});
    }
  if (!(top > 0)) mesh.vertices.push_back({0, 0, 1});
  return mesh;
}

/// What the attribute `builtin` of a mesh asks for with `params`.
inline RawMesh builtin_mesh(const Element& e, Budget& budget) {
  const std::vector<double> p = e.numbers("params");
  const int kind = e.choice(
      "builtin", {"sphere", "hemisphere", "cone", "supersphere", "supertorus", "wedge", "plate", "none"});
  if (kind > 4) e.refuse("a mesh builtin='" + e.text("builtin") + "' has no volume and is not read");
  constexpr std::size_t counts[] = {1, 1, 2, 3, 4};
  const auto demand = [&](bool holds, const char* rule) {
    if (!holds) e.refuse("params of a builtin " + e.text("builtin") + ": " + rule);
  };
  demand(p.size() == counts[kind], "sphere and hemisphere have 1, cone 2, supersphere 3, supertorus 4");
  demand(p[0] == std::floor(p[0]) && p[0] >= 0 && p[0] <= 1e6, "the first is a whole number from 0 to 1e6");
  const Index n = Index(p[0]);
  budget.take_points(e, kind < 2 ? 1 : double(n) * n);
  if (kind == 0) demand(n <= 4, "at most 4 divisions");
  if (kind == 1) demand(n <= 10, "at most 10 divisions");
  if (kind == 0) return icosphere(n);
  if (kind == 1) return hemisphere(n);
  demand(n >= 3, "the first is at least 3");
  if (kind == 2) demand(p[1] >= 0, "the upper radius is at least 0");
  if (kind == 2) return cone(n, p[1]);
  if (kind == 3) demand(p[1] >= 0 && p[2] >= 0, "e and n are at least 0");
  if (kind == 3) return supersphere(n, p[1], p[2]);
  demand(p[1] > 0 && p[1] <= 1 && p[2] > 0 && p[3] > 0, "the radius lies in (0, 1], s and t are above 0");
  return supertorus(n, p[1], p[2], p[3]);
}

}  // namespace delassus::inner::mjcf
