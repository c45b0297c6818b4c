#include <delassus/fem/quadratic_tetrahedral_fem.hpp>

#include <utility>

#include "catch.hpp"
#include "fem_tests.hpp"

namespace quadratic_tetrahedral_fem_tests {

using namespace delassus;
using namespace fem_tests;

namespace {

/// The unit cube, its inner points moved, and inner edges bent by up to `bend` of a cell.
QuadraticTetrahedralMesh bent_cube(Index n, double bend) {
  QuadraticTetrahedralMesh mesh = quadratic(cube(n, 0.15));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> draw(-bend / double(n), bend / double(n));
  for (std::size_t i = std::size_t((n + 1) * (n + 1) * (n + 1)); i < mesh.points.size(); ++i)
    if (mesh.points[i].minCoeff() > 1e-9 && mesh.points[i].maxCoeff() < 1 - 1e-9)
      for (int k = 0; k < 3; ++k) mesh.points[i][k] += draw(random);
  return mesh;
}

}  // namespace

TEMPLATE_TEST_CASE("patch test: inside ten-node tetrahedra with bent edges the nodes follow their surface",
                   "", Linear, Corotational, StableNeoHookean, StVenantKirchhoff) {
  const QuadraticTetrahedralMesh mesh = bent_cube(2, 0.08);
  check_patch<QuadraticTetrahedralFem<TestType>, TestType>(mesh, 27);  // 125 nodes less the 98 of the surface
  double V = 0;  // bent edges inside give to one element what they take from others
  for (Index e = 0; e < Index(mesh.tetrahedra.size()); ++e) V += volume(mesh, e);
  CHECK(std::abs(V - 1) < 1e-14);
}

TEMPLATE_TEST_CASE("ten-node tetrahedra turned and moved as a whole have no elastic force and no energy", "",
                   Corotational, StableNeoHookean, StVenantKirchhoff) {
  check_rigid_motion<QuadraticTetrahedralFem<TestType>>(bent_cube(2, 0.08));
}

TEMPLATE_TEST_CASE("forces of ten-node tetrahedra are the derivative of their energy, and balance", "",
                   Corotational, StableNeoHookean) {
  QuadraticTetrahedralFem<TestType> set;
  set.add({.mesh = bent_cube(1, 0), .elasticity = {.young = 1, .poisson = 0.4}});
  scatter(set, 0.06, 3);
  check_derivative(set, 1e-10);
  check_balance(set, 0.1);
}

TEMPLATE_TEST_CASE("A = M + h^2 K of ten-node tetrahedra is the derivative of their forces", "", Linear,
                   Corotational, StableNeoHookean, StVenantKirchhoff) {
  QuadraticTetrahedralFem<TestType> set;
  set.gravity.setZero();
  const auto body = set.add({.mesh = bent_cube(2, 0.08), .elasticity = {.young = 1e4}, .density = 800});
  stretch_all(set, body, 0.003);
  set.fix(body, [](const Vec3& x) { return x[0] < 0.1; });
  check_tangent(set, 1e-6);  // gradients are four times those of a linear element's
}

TEST_CASE("no node has a negative mass, and all have that of the body") {
  QuadraticTetrahedralFem<Linear> set;
  set.add({.mesh = quadratic(box_mesh({1, 2, 3}, {2, 2, 2})), .density = 100});
  double sum = 0;
  for (Index b = 0; b < set.blocks(); ++b) {
    CHECK(set.mass(b) > 0);
    sum += set.mass(b);
  }
  CHECK(std::abs(sum - 600) < 1e-11);
}

TEST_CASE("a cantilever of ten-node tetrahedra with 270 unknowns bends as Timoshenko's") {
  // 1 m × 0.1 m × 0.1 m, E = 1e6 Pa: 5 × 1 × 1 cells have the nodes of 10 × 2 × 2. Ratios that are known of
  // this element to three digits: 0.955, and 0.740 at ν = 0.49.
  const double P = 0.01, E = 1e6, I = 1e-4 / 12;
  for (const auto& [poisson, known] : {std::pair{0.3, 0.955}, {0.49, 0.740}}) {
    QuadraticTetrahedralFem<Linear> set;
    set.gravity.setZero();
    const auto beam = set.add({.mesh = quadratic(box_mesh({1, 0.1, 0.1}, {5, 1, 1})),
                               .elasticity = {.young = E, .poisson = poisson}});
    CHECK(set.fix(beam, [](const Vec3& x) { return x[0] < 1e-9; }) == 9);
    CHECK(3 * (set.blocks() - 9) == 270);
    // Spread evenly over the end's two triangles: a third to each node on an edge, nothing to the corners.
    std::vector<Vec3> u(set.blocks(), Vec3::Zero());
    const auto& points = set.mesh(beam).points;
    double count = 0, sum = 0;
    for (const auto& t : set.mesh(beam).tetrahedra)
      for (const auto& face : inner::quadratic_face) {
        bool is_end = true;
        for (const int k : face) is_end = is_end && points[t[k]][0] > 1 - 1e-9;
        for (int k = 3; is_end && k < 6; ++k) u[t[face[k]]][1] -= P / 6;
      }
    set.factor({.mass = 0, .stiffness = 1});
    set.solve(u);
    for (std::size_t i = 0; i < points.size(); ++i)
      if (points[i][0] > 1 - 1e-9) sum -= u[i][1], ++count;
    const double G = E / 2 / (1 + poisson),
                 ratio = sum / count / (P / (3 * E * I) + P / (5.0 / 6 * G * 0.01));
    CAPTURE(poisson, ratio);
    if (poisson < 0.4) CHECK(ratio >= 0.95);
    CHECK(std::abs(ratio - known) < 2e-3);
  }
}

TEST_CASE("a bar of ten-node tetrahedra hangs by rho g L^2/2E where its weight pulls") {
  QuadraticTetrahedralFem<Linear> set;
  const auto bar = set.add({.mesh = quadratic(box_mesh({0.2, 0.2, 1}, {1, 1, 4})),
                            .elasticity = {.young = 1e6, .poisson = 0},
                            .density = 500});
  set.fix(bar, [](const Vec3& x) { return x[2] > 1 - 1e-9; });
  settle(set, 1);
  double low = 0;
  int count = 0;
  for (Index k = 0; k < set.node_count(bar); ++k)
    if (set.mesh(bar).points[k][2] == 0) low -= set.position(set.node(bar, k))[2], ++count;
  // Lumped weight is off within an element: by (1/4)² of the whole at most.
  CHECK(std::abs(low / count / (500 * 9.81 / 2e6) - 1) < 1.0 / 16);
}

TEST_CASE("a point of a ten-node tetrahedron is found by its place, and moves with its nodes") {
  QuadraticTetrahedralFem<Corotational> set;
  const auto body = set.add({.mesh = bent_cube(2, 0.08), .position = {1, 0, 0}});
  check_anchor(set, body, 1e-14, 1e-14);
  CHECK_THROWS_AS(set.anchor_at(body, {9, 0, 0}), InvalidArgument);
}

}  // namespace quadratic_tetrahedral_fem_tests
