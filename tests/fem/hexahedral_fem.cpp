#include <delassus/fem/hexahedral_fem.hpp>

#include <array>

#include "catch.hpp"
#include "fem_tests.hpp"
#include "hexahedral_scenes.hpp"

namespace hexahedral_fem_tests {

using namespace delassus;
using namespace fem_tests;

TEMPLATE_TEST_CASE("patch test: inside distorted hexahedra the nodes follow what their surface does", "",
                   Linear, Corotational, StableNeoHookean) {
  check_patch<HexahedralFem<TestType>, TestType>(bricks(3, 0.25), 8);
}

TEMPLATE_TEST_CASE("hexahedra turned and moved as a whole have no elastic force and no energy", "",
                   Corotational, StableNeoHookean) {
  check_rigid_motion<HexahedralFem<TestType>>(bricks(2, 0.25));
}

TEST_CASE("forces of hexahedra are the derivative of their energy, their sum and their moment vanish") {
  for (const unsigned seed : {1u, 2u, 3u}) {
    HexahedralFem<Corotational> set;
    set.add({.mesh = crooked_brick(seed), .elasticity = {.young = 1, .poisson = 0.4}});
    const Quat turn = exponential(Vec3(2 * Vec3(1, 2, -2) / 3));
    for (Index b = 0; b < set.blocks(); ++b) set.place(set.handle(b), turn * set.position(set.handle(b)));
    scatter(set, 0.2, seed);  // bends and twists as much as it strains
    check_derivative(set, 1e-10);
    check_balance(set, 0.1);
  }
}

TEST_CASE("the stiffness of a hexahedron is symmetric and positive but for the six motions of a rigid body") {
  for (const unsigned seed : {0u, 3u, 4u})
    for (const double poisson : {0.3, 0.4999}) {
      HexahedralFem<Corotational> set;
      set.add({.mesh = seed == 0 ? hexahedral_box({2, 1, 1}, {1, 1, 1}) : crooked_brick(seed),
               .elasticity = {.young = 1, .poisson = poisson}});
      set.factor({.mass = 1, .stiffness = 1});
      double K[24][24], largest = 0, skewed = 0;
      for (int j = 0; j < 24; ++j) {
        for (Vec3& v : set.velocity()) v.setZero();
        set.velocity()[j / 3][j % 3] = 1;
        std::vector<Vec3> p(8, Vec3::Zero());
        set.add_stiffness_times_velocity(p, -1);
        for (int i = 0; i < 24; ++i) K[i][j] = p[i / 3][i % 3];
        largest = std::max(largest, K[j][j]);
      }
      for (int i = 0; i < 24; ++i)
        for (int j = 0; j < i; ++j) skewed = std::max(skewed, std::abs(K[i][j] - K[j][i]));
      CHECK(skewed < 1e-15 * largest);
      // Cholesky with the largest pivot first: as many pivots as K has rank, and what is left is zero.
      std::array<double, 24> pivots;
      std::array<bool, 24> is_done{};
      for (double& pivot : pivots) {
        int k = -1;
        for (int i = 0; i < 24; ++i)
          if (!is_done[i] && (k < 0 || K[i][i] > K[k][k])) k = i;
        pivot = K[k][k];
        is_done[k] = true;
        if (pivot > 1e-12 * largest)
          for (int i = 0; i < 24; ++i)
            for (int j = 0; j < 24; ++j)
              if (!is_done[i] && !is_done[j]) K[i][j] -= K[i][k] * K[k][j] / pivot;
      }
      CHECK(pivots[17] > 1e-6 * largest);  // 1/λ of the softest, and a margin
      CHECK(std::abs(pivots[18]) < 1e-13 * largest);
      CHECK(std::abs(pivots[23]) < 1e-13 * largest);
    }
}

TEMPLATE_TEST_CASE("A = M + h^2 K of hexahedra is the derivative of their forces where nothing is bent", "",
                   Linear, Corotational) {
  HexahedralFem<TestType> set;
  set.gravity.setZero();
  const auto body = set.add({.mesh = bricks(2, 0.25), .elasticity = {.young = 1e4}, .density = 800});
  stretch_all(set, body, 0);
  check_tangent(set, 1e-7);
}

TEST_CASE("a hexahedron that is bent resists no turn as a whole") {
  // The shapes of a box have a mean gradient of zero: bent by them the material is at rest, and all of K is
  // that of the modes.
  HexahedralFem<Corotational> set;
  set.add({.mesh = hexahedral_box({2, 1, 1}, {1, 1, 1}), .elasticity = {.young = 1}});
  const Quat turn = exponential(Vec3(1, 2, -1));
  for (Index b = 0; b < 8; ++b) {
    const Vec3 x = set.position(set.handle(b)),
               s(x[0] < 1 ? -1 : 1, x[1] < 0.5 ? -1 : 1, x[2] < 0.5 ? -1 : 1);
    set.place(set.handle(b), turn * (x + 0.1 * Vec3(s[0] * s[1], s[1] * s[2], s[0] * s[1] * s[2])));
  }
  set.factor({.mass = 1, .stiffness = 1});
  const auto resistance = [&](const Vec3& rate, const Vec3& bending) {
    for (Index b = 0; b < 8; ++b)
      set.velocity()[b] = rate.cross(set.position(set.handle(b))) + (b == 0 ? 1.0 : 0.0) * bending;
    std::vector<Vec3> p(8, Vec3::Zero());
    set.add_stiffness_times_velocity(p, 1);
    double size = 0;
    for (const Vec3& x : p) size += x.norm();
    return size;
  };
  CHECK(resistance(Vec3::Zero(), {1, 0, 0}) > 0.1);
  for (int k = 0; k < 3; ++k) CHECK(resistance(unit_axis(k), Vec3::Zero()) < 1e-14);
}

TEST_CASE("a body of hexahedra that cannot be one is refused, and says why") {
  HexahedralFem<Corotational> set;
  HexahedralMesh folded = hexahedral_box({1, 1, 1}, {2, 1, 1});
  folded.points[2] = {0.4, 0.5, 0.5};
  CHECK_THROWS_WITH(set.add({.mesh = folded}), Catch::Contains("soft body #0: hexahedron #1 is"));
  CHECK_THROWS_WITH(set.add({.mesh = bricks(1), .position = {1e17, 0, 0}}), Catch::Contains("no volume"));
  CHECK_THROWS_WITH(set.add({.mesh = bricks(1), .density = 1e-320}),
                    Catch::Contains("the mass of hexahedron #0"));
  CHECK(set.blocks() == 0);
  const auto body = set.add({.mesh = bricks(1)});
  CHECK_THROWS_WITH(set.anchor_at(body, {2, 0, 0}), Catch::Contains("is in no hexahedron of soft body #0"));
}

TEST_CASE("an anchor in a hexahedron moves with the point of the body it was put on") {
  HexahedralFem<Corotational> set;
  const auto body = set.add({.mesh = bricks(2, 0.25), .position = {1, 0, 0}});
  const Anchor a = set.anchor_at(body, {1.3, 0.6, 0.2});
  check_anchor(set, body, 1e-15, 1e-14);
  // The same point found again in the deformed body.
  CHECK((set.anchor_at(body, stretch * Vec3(1.3, 0.6, 0.2)).local - a.local).norm() < 1e-14);
}

}  // namespace hexahedral_fem_tests
