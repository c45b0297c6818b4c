// The contract of builders that keep an old factor of A.
#include <delassus/compliance/lazy.hpp>
#include <delassus/compliance/precomputed.hpp>

#include "catch.hpp"
#include "compliance/builder_scenes.hpp"

#include <cstdio>
#include <type_traits>

namespace turned_builders_tests {

using namespace builder_scenes;

// Turned as a whole, the factor of before is that of now: W̃ is W up to the rounding of the factor's scalar,
// ε cond A < 6e-8 · 1e4 in float, and to 1e-5 in double: rotations are found to 1e-6 tr S/(tr S − λ_max(S)).
TEMPLATE_TEST_CASE("an old factor is exact for a body that has turned as a whole", "",
                   BasicLazyCompliance<double>, PrecomputedCompliance) {
  const bool is_float = std::is_same_v<TestType, PrecomputedCompliance>;
  Scene scene;
  Built<TestType> built;
  built.build(scene, {});
  CHECK(built.error() < (is_float ? 6e-4 : 1e-10));
  auto& soft = bodies<Soft>(scene.world);
  const Mat3 R = Eigen::AngleAxisd(2.9, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  for (Index k = 0; k < soft.node_count(scene.beam); ++k)
    soft.place(soft.node(scene.beam, k), R * soft.mesh(scene.beam).points[k] + Vec3(1, 2, 3));
  built.build(scene, {});
  CHECK(built.W.report().factorizations == 0);
  CHECK(built.error() < (is_float ? 6e-4 : 1e-5));
  CHECK(built.W.report().iterations <= 2);
}

// Bent, it is near, and what it misses is what `H dv` shows: that is exact whatever the factor.
TEST_CASE("an old factor of a bent body is near, and the motion is that of the A of now") {
  Scene scene;
  Built<PrecomputedCompliance> built;
  const PrecomputedCompliance policy{.tolerance = 1e-9};
  built.build(scene, policy);
  scene.bend(1.5);
  built.build(scene, policy);
  CHECK(built.W.report().factorizations == 0);
  CHECK(built.error() > 1e-4);
  CHECK(built.error() < 0.2);
  CHECK(built.asymmetry() < 1e-6);
  // |p − A Δv| ≤ 1e-9 |p|, and cond A < 1e4.
  CHECK((built.change - built.exact * built.lambda).norm() < 1e-5 * built.change.norm());
}

// Another world's body has the same place and generation; its mesh has as many nodes, and they lie elsewhere.
TEMPLATE_TEST_CASE("a factor is not taken for that of a body that came in the place of its own", "",
                   BasicLazyCompliance<double>, PrecomputedCompliance) {
  Scene scene, other;
  auto& soft = bodies<Soft>(other.world);
  Soft longer;
  other.beam = longer.add({.mesh = box_mesh({0.8, 0.2, 0.1}, {5, 2, 2}), .elasticity = {.young = 2e4}});
  longer.fix(other.beam, [](const Vec3& x) { return x.x() < 1e-9; });
  soft = longer;
  Built<TestType> built;
  built.build(scene, {});
  built.build(other, {});
  CHECK(built.W.report().factorizations == 1);
  CHECK(built.error() < 6e-4);       // as above; that of the other body is off by 0.9
  other.world = other.world.clone();  // a copy is the same body
  built.build(other, {});
  CHECK(built.W.report().factorizations == 0);
}

TEST_CASE(
    "a precomputed compliance comes from its file to the bit, and a file of something else is refused by "
    "name") {
  const std::string path = "precomputed_compliance_of_a_test";
  std::remove(path.c_str());
  const PrecomputedCompliance policy{.file = path};
  Scene scene;
  Built<PrecomputedCompliance> first;
  first.build(scene, policy);
  const auto build = [&](auto&& change) {
    Scene other;
    Built<PrecomputedCompliance> built;
    change(other);
    built.build(other, policy);
    return built.made;
  };
  CHECK(build([](Scene&) {}) == first.made);

  using Catch::Contains;
  const auto name = Contains("PrecomputedCompliance: '" + path + "'");
  CHECK_THROWS_WITH(
      build([](Scene& s) { bodies<Soft>(s.world).fix(bodies<Soft>(s.world).node(s.beam, 53)); }),
      name && Contains("another choice of fixed nodes"));
  const auto other_body = [](double width, double young, double density) {
    return [=](Scene& s) {
      auto& soft = bodies<Soft>(s.world);
      soft.remove(s.beam);
      s.beam = soft.add({.mesh = box_mesh({0.4, width, 0.1}, {5, 2, 2}),
                         .elasticity = {.young = young},
                         .density = density});
      soft.fix(s.beam, [](const Vec3& x) { return x.x() < 1e-9; });
    };
  };
  CHECK_THROWS_WITH(build(other_body(0.11, 2e4, 1000)), name && Contains("another mesh"));
  CHECK_THROWS_WITH(build(other_body(0.1, 3e4, 1000)), name && Contains("another material or density"));
  CHECK_THROWS_WITH(build(other_body(0.1, 2e4, 900)), name && Contains("another material or density"));
  std::FILE* file = std::fopen(path.c_str(), "rb+");
  std::fseek(file, 400, SEEK_SET);
  std::fputc(77, file);
  std::fclose(file);
  CHECK_THROWS_WITH(build([](Scene&) {}), name && Contains("is damaged"));
  std::remove(path.c_str());
  Built<PrecomputedCompliance> elsewhere;
  CHECK_THROWS_WITH(elsewhere.build(scene, {.file = "no/such/folder/x"}),
                    Contains("'no/such/folder/x' cannot be written"));
}

}  // namespace turned_builders_tests
