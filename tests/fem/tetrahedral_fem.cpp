#include <delassus/fem/tetrahedral_fem.hpp>

#include <array>
#include <limits>
#include <string>

#include "catch.hpp"
#include "fem_tests.hpp"

namespace tetrahedral_fem_tests {

using namespace delassus;
using namespace fem_tests;

TEMPLATE_TEST_CASE("patch test: inside a cube whose surface is deformed affinely the nodes follow", "",
                   Linear, Corotational, StableNeoHookean, StVenantKirchhoff) {
  check_patch<TetrahedralFem<TestType>, TestType>(cube(4, 0.2), 27);
}

TEMPLATE_TEST_CASE("a body turned and moved as a whole has no elastic force and no energy", "", Corotational,
                   StableNeoHookean, StVenantKirchhoff) {
  check_rigid_motion<TetrahedralFem<TestType>>(cube(2, 0.2));
}

TEMPLATE_TEST_CASE("elastic forces sum to nothing, and their moments too", "", Corotational, StableNeoHookean,
                   StVenantKirchhoff) {
  TetrahedralFem<TestType> set;
  set.add({.mesh = cube(2), .elasticity = {.young = 1}});
  scatter(set, 0.3, 2);
  check_balance(set, 1);
}

TEMPLATE_TEST_CASE("A = M + h^2 K of the nodes is the derivative of their forces", "", Linear, Corotational,
                   StableNeoHookean, StVenantKirchhoff) {
  TetrahedralFem<TestType> set;
  set.gravity.setZero();
  const auto body = set.add({.mesh = cube(2, 0.2), .elasticity = {.young = 1e4}, .density = 800});
  stretch_all(set, body, 0.005);
  set.fix(body, [](const Vec3& x) { return x[0] < 0.1; });
  check_tangent(set, 1e-7);
}

TEMPLATE_TEST_CASE(
    "K is the same to the bit whatever it was before, and a shift of all nodes does not meet it", "", double,
    float) {
  using Set = TetrahedralFem<Corotational, TestType>;
  // 162 elements in any order: with four or eight at a time two are left over, and pairs of nodes are met
  // twice by those that are taken at once.
  TetrahedralMesh mesh = cube(3, 0.2);
  std::shuffle(mesh.tetrahedra.begin(), mesh.tetrahedra.end(), std::mt19937(4));
  const auto product = [&](Set& set, double bend, bool is_shift) {
    for (Index k = 0; k < set.blocks(); ++k) {
      const Vec3& X = mesh.points[k];
      set.place(set.handle(k), X + bend * Vec3(X[2] * X[2], X[0], X[1] * X[0]));
      const Vec3 v = is_shift ? Vec3(1, -2, 3) : Vec3(std::cos(3 * k), std::sin(5 * k), std::cos(7 * k));
      set.velocity()[k] = v.cast<TestType>();
    }
    set.assemble({.mass = 1, .stiffness = 1});
    std::vector<Vec<3, TestType>> y(set.blocks(), Vec<3, TestType>::Zero());
    set.add_stiffness_times_velocity(y, -1);
    return y;
  };
  Set first, second;
  for (Set* set : {&first, &second}) set->add({.mesh = mesh, .elasticity = {.young = 1}});
  product(second, 0.7, false);
  const auto y = product(first, 0.3, false), again = product(second, 0.3, false);
  double size = 0;
  for (Index k = 0; k < first.blocks(); ++k) {
    CHECK(y[k] == again[k]);
    size = std::fmax(size, y[k].norm());
  }
  CHECK(size > 0.1);
  // Some twenty blocks of size E times an edge sum to a few ε.
  const double epsilon = std::numeric_limits<TestType>::epsilon();
  for (const auto& f : product(first, 0.3, true)) CHECK(f.norm() < 100 * epsilon);
}

TEST_CASE(
    "tip deflection and first frequency of a cantilever of linear tetrahedra are the known, too stiff ones") {
  // Timoshenko's beam with κ = 5/6, and the known ratios of linear tetrahedra in Kuhn's order to four digits.
  const double P = 0.01, E = Cantilever<Linear>::E, G = E / 2.6, area = 0.01;
  const double deflection = P / (3 * E * Cantilever<Linear>::second_moment) + P / (5.0 / 6 * G * area);
  CHECK(std::abs(deflection - 4.0312e-4) < 1e-8);
  const double known[][3] = {{1, 0.2194, 0.9521}, {2, 0.5037, 0.6592}, {4, 0.7871, 0.5528}};
  for (const auto& [cells, ratio, hertz] : known) {
    Cantilever<Linear> beam{Index(cells)};
    auto& set = beam.set;
    set.factor({.mass = 0, .stiffness = 1});
    auto u = beam.end_load(P);
    set.solve(u);
    CHECK(std::abs(-beam.at_end(u)[1] / deflection - ratio) < 1e-4);
    // Once along each of the section's diagonals: the mesh is its own mirror image about both, so they are
    // apart, and their frequencies differ.
    double omega = 1e9;
    for (const double side : {1.0, -1.0}) {
      std::vector<Vec3> v = beam.end_load(1);
      for (Vec3& x : v) x[2] = side * x[1];
      omega = std::min(omega, lowest_frequency(set, v, 12));
    }
    CHECK(std::abs(omega / (2 * M_PI) - hertz) < 1e-4);
  }
}

TEST_CASE("a column under its own weight shortens by rho g L^2 / 2E") {
  TetrahedralFem<Linear> set;
  const auto column = set.add({.mesh = box_mesh({0.2, 0.2, 1}, {1, 1, 8}),
                               .elasticity = {.young = 1e6, .poisson = 0},
                               .density = 500});
  set.fix(column, [](const Vec3& x) { return x[2] < 1e-9; });
  settle(set, 1);
  double top = 0;
  int count = 0;
  for (Index k = 0; k < set.node_count(column); ++k)
    if (set.mesh(column).points[k][2] == 1) top += set.position(set.node(column, k))[2] - 1, ++count;
  // The elements sample the linear strain at their middles, the lumped masses carry half an element each:
  // exact at nodes for one dimension; the tetrahedra's unequal corner masses bend the cells a little, by
  // (1/8)² of it.
  CHECK(std::abs(top / count / (-500 * 9.81 / 2e6) - 1) < 1.0 / 64);
}

TEMPLATE_TEST_CASE("forces do not depend on the order in which a tetrahedron names its points", "",
                   Corotational, StableNeoHookean) {
  const std::vector<Vec3> rest{{0, 0, 0}, {1, 0.1, 0}, {0.2, 1, 0}, {0, 0.1, 1}};
  // Stretched, flat, and inside out.
  const std::vector<Vec3> places[3] = {{{0, 0, 0}, {1.5, 0, 0}, {0, 0.8, 0.1}, {0.1, 0, 1.2}},
                                       {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.4, 0.3, 0}},
                                       {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.3, -0.7}}};
  for (const auto& place : places) {
    std::vector<Vec3> first;
    std::array<Index, 4> order{0, 1, 2, 3};
    int bodies = 0;
    do {
      TetrahedralMesh mesh{rest, {order}};
      if (volume(mesh, 0) < 0) mesh = oriented(mesh);
      TetrahedralFem<TestType> set;
      const auto body = set.add({.mesh = mesh, .elasticity = {.young = 1}});
      for (Index k = 0; k < 4; ++k) set.place(set.node(body, k), place[k]);
      const auto f = elastic_forces(set);
      if (first.empty()) first = f;
      for (Index k = 0; k < 4; ++k) CHECK((f[k] - first[k]).norm() < 1e-14);
      ++bodies;
    } while (std::next_permutation(order.begin(), order.end()));
    CHECK(bodies == 24);
    CHECK(first[0].norm() > 1e-3);
  }
}

TEST_CASE("a body that cannot be one is refused, and says why") {
  TetrahedralFem<Corotational> set;
  using Body = SoftBody<Corotational>;
  const auto refusal = [&](const Body& body) -> std::string {
    try {
      set.add(body);
    } catch (const InvalidArgument& e) {
      return e.what();
    }
    return {};
  };
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK(refusal({.mesh = {}}).find("soft body #0: the mesh has no tetrahedron") != std::string::npos);
  CHECK(refusal({.mesh = cube(1), .density = 0}).find("density 0") != std::string::npos);
  CHECK(refusal({.mesh = cube(1), .elasticity = {.poisson = 0.5}}).find("Poisson's ratio 0.5") !=
        std::string::npos);
  CHECK(refusal({.mesh = cube(1), .position = {0, infinity, 0}}).find("not finite") != std::string::npos);
  CHECK(refusal({.mesh = cube(1), .orientation = Quat(2, 0, 0, 0)}).find("unit quaternion") !=
        std::string::npos);
  CHECK(refusal({.mesh = cube(1), .contact_radius = 0.1, .collides_with = ~0u})
            .find("collide with each other") != std::string::npos);
  CHECK(set.blocks() == 0);  // nothing of them is left
  // The numbers around 1e17 are 16 apart: all nodes of a unit cube would have one x.
  CHECK(refusal({.mesh = cube(1), .position = {1e17, 0, 0}}).find("no volume") != std::string::npos);
  CHECK(set.blocks() == 0);
  // 1e39 is finite in double, and no number in float.
  TetrahedralFem<Corotational, float> narrow;
  CHECK_THROWS_WITH(narrow.add({.mesh = cube(1), .velocity = {0, 1e39, 0}}),
                    Catch::Contains("soft body #0: velocity"));
  CHECK(narrow.blocks() == 0);

  const auto body = set.add({.mesh = cube(1), .contact_radius = 0.1});
  CHECK_THROWS_AS(set.node(body, 8), InvalidArgument);
  CHECK_THROWS_AS(set.anchor_at(body, {2, 0, 0}), InvalidArgument);
  const auto node = set.node(body, 3);
  set.fix(node);
  CHECK_THROWS_AS(set.set_velocity(node, {1, 0, 0}), InvalidArgument);
  set.remove(body);
  CHECK_THROWS_AS(set.node(body, 0), InvalidArgument);
  CHECK_THROWS_AS(set.position(node), InvalidArgument);
  // The places of its nodes are used again, and the new body is free.
  const auto second = set.add({.mesh = cube(1)});
  CHECK(set.blocks() == 8);
  for (Index k = 0; k < 8; ++k) CHECK(set.moves(k));
  CHECK(set.position(set.node(second, 7)) == Vec3(1, 1, 1));
}

TEST_CASE("an anchor in an element moves with the point of the body it was put on") {
  TetrahedralFem<Corotational> set;
  const auto body = set.add({.mesh = cube(2, 0.2), .position = {1, 0, 0}});
  check_anchor(set, body, 1e-15, 1e-15);
}

}  // namespace tetrahedral_fem_tests
