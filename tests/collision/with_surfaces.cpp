#include "catch.hpp"
#include "collision/mesh_scene.hpp"

#include <delassus/collision/with_surfaces.hpp>
#include <delassus/geometry/box_mesh.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <vector>

namespace with_surfaces_tests {

using namespace delassus;
using namespace scenes;
using inner::SoftPairs, inner::SoftSurface, inner::FeatureContact;

namespace {

/// Nodes that are where they are put, in place of a deformable body.
struct Nodes {
  TetrahedralMesh mesh;
  std::vector<Vec3> x = mesh.points, v = std::vector<Vec3>(mesh.points.size(), Vec3::Zero());
  double radius = 0.01;

  Shape shape(Index) const { return Sphere{radius}; }
  Pose pose(Index b) const { return {.position = x[b]}; }
  const std::vector<Vec3>& velocity() const { return v; }
  bool moves(Index) const { return true; }

  SoftSurface surface() const {
    std::vector<Index> blocks(x.size());
    std::iota(blocks.begin(), blocks.end(), 0);
    SoftSurface out(0, 0, 0, mesh, blocks);
    out.follow(*this);
    return out;
  }
};

/// A cloth of 2 × 2 m and 1 cm in n × n cells, laid over the ball of radius 0.7 m around the origin, `above`
/// it: a cap, a cylinder down from it at the angle 1; all nodes moved by up to 1e-3 m.
Nodes cloth_over_ball(Index n, double above) {
  Nodes nodes{box_mesh({2, 2, 0.01}, {n, n, 1})};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1e-3, 1e-3);
  for (Vec3& p : nodes.x) {
    const double dx = p[0] - 1, dy = p[1] - 1, way = std::hypot(dx, dy), r = 0.7 + above + p[2];
    const double angle = std::min(way / 0.7, 1.0), down = std::max(way - 0.7, 0.0);
    const Vec3 out = way > 0 ? Vec3(dx / way, dy / way, 0) : unit_axis(0);
    const double jx = uniform(random), jy = uniform(random), jz = uniform(random);
    p = r * (std::sin(angle) * out + std::cos(angle) * unit_axis(2)) - down * unit_axis(2) + Vec3(jx, jy, jz);
  }
  return nodes;
}

}  // namespace

TEST_CASE(
    "a cloth of ten thousand triangles over a ball: every triangle and edge that is near has its contact") {
  Nodes flat{box_mesh({2, 2, 0.01}, {50, 50, 1})};
  SoftSurface cloth = flat.surface();
  REQUIRE(cloth.tree().bounds().high[2] < 0.011);
  const Nodes draped = cloth_over_ball(50, 2e-3);
  cloth.follow(draped);  // the tree was built flat and is fitted

  const double R = 0.7, reach = 0.02;
  SoftPairs pairs;
  pairs.collide(cloth, Sphere{R}, Pose{}, reach, R);
  // The truth, triangle by triangle: nearest points of the ball's centre inside a triangle, or inside an edge
  // that is nearest of both its triangles.
  const auto faces = surface(draped.mesh);
  REQUIRE(faces.size() > 10000);
  std::size_t inside = 0;
  double least = std::numeric_limits<double>::infinity();
  std::map<std::pair<Index, Index>, int> edges;
  for (Index t = 0; t < Index(faces.size()); ++t) {
    const Triangle T = cloth.triangle(t);
    if (T.height(Vec3::Zero()) < 0) continue;
    const Vec3 q = inner::nearest_on(T, Vec3::Zero());
    if (q.norm() - R > reach) continue;
    least = std::min(least, q.norm() - R);
    const Vec3 w = cloth.shares(t, q);
    const int zeros = (w[0] == 0) + (w[1] == 0) + (w[2] == 0);
    inside += zeros == 0 ? 1 : 0;
    if (zeros != 1) continue;
    const int k = w[2] == 0 ? 0 : w[0] == 0 ? 1 : 2;
    ++edges[std::minmax(T.corner[k], T.corner[(k + 1) % 3])];
  }
  const auto on_edges =
      std::count_if(edges.begin(), edges.end(), [](const auto& e) { return e.second == 2; });
  std::size_t found_inside = 0;
  double found_least = std::numeric_limits<double>::infinity();
  for (const FeatureContact& c : pairs.found) {
    if (c.edge_a < 0) {
      ++found_inside;
    } else {
      const Triangle T = cloth.triangle(c.triangle_a);
      edges.erase(std::minmax(T.corner[c.edge_a], T.corner[(c.edge_a + 1) % 3]));
    }
    found_least = std::min(found_least, c.point.gap);
    // On the triangle it names, and at its distance: coordinates of 1 m, a few roundings.
    const Vec3 q = inner::nearest_on(cloth.triangle(c.triangle_a), Vec3::Zero());
    CHECK(std::abs(c.point.gap - (q.norm() - R)) <
          1e-5 * R);  // a triangle's normal may stand for one within that
    CHECK(std::abs(c.normal.norm() - 1) < 1e-12);
  }
  const auto missed = std::count_if(edges.begin(), edges.end(), [](const auto& e) { return e.second == 2; });
  CHECK(inside > 500);
  CHECK(on_edges > 50);
  CHECK(missed == 0);
  CHECK(found_inside == inside);
  CHECK(found_least >= least - 1e-5 * R);
}

TEST_CASE("a cloth over a meshed ball: vertices on triangles and crossing edges are those of all pairs") {
  const Nodes draped = cloth_over_ball(50, 5e-3);
  const SoftSurface cloth = draped.surface();
  // An octahedron, divided three times and put on the ball: 512 triangles.
  std::vector<Vec3> v{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::vector<Corners> t{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                         {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < 3; ++level) {
    std::map<std::pair<Index, Index>, Index> middle;
    const auto between = [&](Index a, Index b) {
      const auto [at, is_new] = middle.try_emplace(std::minmax(a, b), Index(v.size()));
      if (is_new) v.push_back((v[a] + v[b]).normalized());
      return at->second;
    };
    std::vector<Corners> finer;
    for (const auto& [a, b, c] : t) {
      const Index ab = between(a, b), bc = between(b, c), ca = between(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    t = finer;
  }
  for (Vec3& p : v) p *= 0.7;
  const TriangleMesh ball(v, t);
  const TouchRange range{0.02, 0.02, 0.7};
  SoftPairs pairs;
  pairs.cross(cloth, ball, Pose{}, range);

  const inner::PosedSurface<SoftSurface> a{cloth};
  const inner::PosedSurface<TriangleMesh> b{ball};
  std::size_t vertices = 0, crossings = 0;
  double sum = 0;
  PointTouch point;
  EdgeTouch edge;
  std::vector<Triangle> facets;
  for (Index j = 0; j < ball.triangle_count(); ++j) facets.push_back(ball.triangle(j));
  const Index faces = Index(surface(draped.mesh).size());
  for (Index i = 0; i < faces; ++i) {
    const Triangle T = cloth.triangle(i);
    for (Index j = 0; j < ball.triangle_count(); ++j) {
      const Triangle& S = facets[j];
      if ((T.point[0] - S.point[0]).norm() > 0.3) continue;  // no triangle here is as long as 0.15 m
      for (int k = 0; k < 3; ++k)
        if (ball.owns_corner(j, k) && touches(T, S.point[k], range, point) && point.gap >= 0 &&
            point.edge < 0 && point.corner < 0 && b.is_farthest(S.corner[k], -point.normal))
          ++vertices, sum += point.gap;
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l)
          if (cloth.owns_edge(i, k) && ball.owns_edge(j, l) && T.lean[k] >= cone_slack &&
              S.lean[l] >= cone_slack && touches(a.edge(i, T, k), b.edge(j, S, l), range, edge) &&
              edge.gap >= 0)
            ++crossings, sum += edge.gap;
    }
  }
  std::size_t found_vertices = 0, found_crossings = 0;
  for (const FeatureContact& c : pairs.found) {
    if (c.point.gap < 0) continue;
    PointTouch at;
    if (c.edge_a < 0 && touches(cloth.triangle(c.triangle_a), c.point.b, range, at) &&
        (at.edge >= 0 || at.corner >= 0))
      continue;
    (c.edge_a < 0 ? found_vertices : found_crossings) += 1;
    sum -= c.point.gap;
  }
  CHECK(vertices > 20);
  CHECK(crossings > 30);
  CHECK(found_vertices == vertices);
  CHECK(found_crossings == crossings);
  CHECK(std::abs(sum) < 1e-12);
}

TEST_CASE("a point of a triangle is the same point of the element behind it") {
  // Corners 0 to 3 each take their turn as the one that the face has not.
  TetrahedralMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}};
  const Nodes nodes{mesh};
  const SoftSurface skin = nodes.surface();
  for (Index t = 0; t < 4; ++t) {
    const Vec3 w(0.2, 0.3, 0.5);
    const auto p = skin.points_of(t);
    const Vec3 x = w[0] * p[0] + w[1] * p[1] + w[2] * p[2];
    CHECK((skin.shares(t, x) - w).norm() < 1e-15);
    const Anchor at = skin.anchor(t, skin.shares(t, x));
    const double first = 1 - at.local[0] - at.local[1] - at.local[2];
    CHECK((at.local[0] * mesh.points[1] + at.local[1] * mesh.points[2] + at.local[2] * mesh.points[3] - x)
              .norm() < 1e-15);
    CHECK((first == 0 || at.local[0] == 0 || at.local[1] == 0 || at.local[2] == 0));
    CHECK(skin.anchor(t, unit_axis(1)).element == -1);
  }
}

TEST_CASE(
    "a point of a triangle of a hexahedron is the same point of the hexahedron, and no corner off its face "
    "counts") {
  const HexahedralMesh mesh = hexahedral_box({1, 2, 3}, {1, 1, 1});
  std::vector<Index> blocks{0, 1, 2, 3, 4, 5, 6, 7};
  const SoftSurface skin(0, 0, 0, mesh, blocks);
  int on_edges = 0;
  for (Index t = 0; t < 12; ++t)
    for (const Vec3& w : {Vec3(0.2, 0.3, 0.5), Vec3(0.4, 0.6, 0), Vec3(0, 0.3, 0.7), Vec3(0.1, 0, 0.9)}) {
      const auto p = skin.points_of(t);
      const Vec3 x = w[0] * p[0] + w[1] * p[1] + w[2] * p[2];
      const Anchor at = skin.anchor(t, skin.shares(t, x));
      REQUIRE(at.element == 0);
      Vec3 sum = Vec3::Zero();
      int counted = 0;
      for (int k = 0; k < 8; ++k) {
        const double share = inner::trilinear(k, at.local);
        sum += share * mesh.points[mesh.hexahedra[0][k]];
        counted += share != 0 ? 1 : 0;
      }
      CHECK((sum - x).norm() < 1e-15 * 8);  // eight terms of up to 3
      CHECK(counted <= 4);
      on_edges += counted == 2 ? 1 : 0;
    }
  CHECK(on_edges == 24);  // two sides of each triangle; the third is a diagonal of a face
  CHECK(skin.anchor(3, unit_axis(1)).element == -1);
}

TEST_CASE("neighbours on one surface do not meet, though they face each other") {
  // An L of three cubes of 1 m: its hollow faces are 1 m long, and all their corners are joined by an edge.
  TetrahedralMesh mesh = delassus::box_mesh({2, 1, 2}, {2, 1, 2});
  std::erase_if(mesh.tetrahedra, [&](const auto& t) {
    Vec3 middle = Vec3::Zero();
    for (const Index i : t) middle += 0.25 * mesh.points[i];
    return middle[0] > 1 && middle[2] > 1;
  });
  const SoftSurface one = Nodes{mesh}.surface(), other = Nodes{mesh}.surface();
  SoftPairs pairs;
  pairs.cross(one, one, {1.2, 1.2, 1});
  CHECK(pairs.found.empty());
  pairs.cross(one, other, {1.2, 1.2, 1});  // of two surfaces they do
  CHECK(!pairs.found.empty());
}

TEST_CASE("surfaces that lose their shape give finite unit normals or nothing") {
  // Points, lines, flat and inside-out bodies against a mesh and a box.
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-0.2, 0.2);
  const TriangleMesh box = box_mesh(0.3, 0.3, 0.3);
  std::size_t contacts = 0;
  for (int kind = 0; kind < 4; ++kind)
    for (int k = 0; k < 20; ++k) {
      Nodes nodes{box_mesh({1, 1, 1}, {2, 2, 2})};
      const double x = uniform(random), y = uniform(random), z = uniform(random);
      for (Vec3& p : nodes.x) {
        p = 0.4 * (p - Vec3(0.5, 0.5, 0.5)) + Vec3(x, y, z);
        if (kind < 3) p[2] = z;
        if (kind < 2) p[1] = y;
        if (kind < 1) p[0] = x;
        if (kind == 3) p[0] = 2 * x - p[0];
      }
      const SoftSurface soft = nodes.surface();
      SoftPairs pairs;
      const auto check = [&] {
        for (const FeatureContact& c : pairs.found) {
          CHECK(std::abs(c.normal.norm() - 1) < 1e-9);
          CHECK(std::isfinite(c.point.gap));
          CHECK(is_finite(soft.shares(c.triangle_a, c.point.a)));
        }
        contacts += pairs.found.size();
      };
      pairs.cross(soft, box, Pose{}, {0.05, 0.05, 0.15});
      check();
      pairs.collide(soft, Box{0.3, 0.3, 0.3}, Pose{}, 0.05, 0.15);
      check();
      pairs.cross(soft, soft, {0.05, 0.05, 0.15});
      check();
    }
  CHECK(contacts > 100);
}

}  // namespace with_surfaces_tests
