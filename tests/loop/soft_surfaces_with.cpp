// Surfaces of deformable bodies together with filters and checkpoints.
#include <delassus/bodies/world.hpp>
#include <delassus/collision/native.hpp>
#include <delassus/collision/with_filter.hpp>
#include <delassus/collision/with_surfaces.hpp>
#include <delassus/constraints/contact/frictionless.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/io/checkpoint.hpp>
#include <delassus/loop/animation_loop.hpp>
#include <delassus/solvers/gauss_seidel.hpp>

#include "catch.hpp"
#include "soft_scenes.hpp"

namespace soft_surfaces_with_tests {

using namespace delassus;

namespace {

using Soft = TetrahedralFem<Corotational>;
using Filter = WithFilter<WithSurfaces<NativeCollision>>;
constexpr double h = 0.01, radius = 0.01;

auto fresh() {
  return AnimationLoop{World{RigidBodies{}, Soft{}}, Constraints{Contact{Frictionless{}}},
                       ImplicitEuler{.rayleigh_stiffness = 0.02},
                       Filter{WithSurfaces{NativeCollision{.margin = 0.02}}},
                       GaussSeidel{.tolerance = 1e-8, .max_iterations = 2000}};
}
using Loop = decltype(fresh());

RigidBodies& rigid(Loop& loop) { return bodies<RigidBodies>(loop.world()); }
Soft& soft(Loop& loop) { return bodies<Soft>(loop.world()); }

/// A block of 1 × 1 × 0.4 m whose foot is held, and a box between its nodes over it.
struct Bed {
  Soft::BodyHandle bed;
  RigidBodies::Handle box;

  explicit Bed(Loop& loop) {
    bed = soft(loop).add(
        {.mesh = box_mesh({1, 1, 0.4}, {2, 2, 1}), .elasticity = {.young = 1e5}, .contact_radius = radius});
    soft(loop).fix(bed, [](const Vec3& x) { return x.z() < 1e-9; });
    box = rigid(loop).add({.position = {0.3, 0.2, 0.52}, .mass = 5., .shape = Box{0.2, 0.2, 0.2}});
  }
};

}  // namespace

TEST_CASE(
    "a body that is to pass through the nodes of a soft one passes through its faces too, until it is "
    "heeded") {
  auto loop = fresh();
  Bed scene(loop);
  auto& filter = loop.get<Filter>();
  const auto with_each_node = [&](const auto& f) {
    for (Index k = 0; k < soft(loop).node_count(scene.bed); ++k)
      f(anchor(rigid(loop), scene.box), anchor(soft(loop), soft(loop).node(scene.bed, k)));
  };
  with_each_node([&](Anchor a, Anchor b) { filter.ignore(loop.world(), a, b); });
  StepReport report;
  for (int n = 0; n < 20; ++n) {
    report = loop.step(h);
    CHECK(report.contacts == 0);
  }
  CHECK(rigid(loop).position(scene.box).z() == Approx(0.52 - 0.5 * 9.81 * h * h * 20 * 21).epsilon(1e-9));
  with_each_node([&](Anchor a, Anchor b) { filter.heed(loop.world(), a, b); });
  rigid(loop).place(scene.box, {0.3, 0.2, 0.52}, Quat::Identity());
  for (int n = 0; n < 200; ++n) loop.step(h);
  CHECK(rigid(loop).position(scene.box).z() > 0.45);
}

TEST_CASE("restored, a box on a soft bed goes on bit for bit") {
  auto loop = fresh();
  Bed scene(loop);
  for (int n = 0; n < 60; ++n) loop.step(h);
  REQUIRE(loop.report().contacts > 0);
  const auto bytes = checkpoint(loop);
  auto other = fresh();
  restore(other, bytes);
  for (int n = 0; n < 100; ++n) {
    const StepReport a = loop.step(h), b = other.step(h);
    REQUIRE(a.contacts == b.contacts);
    REQUIRE(a.sweeps == b.sweeps);
    REQUIRE(rigid(loop).position(scene.box) == rigid(other).position(rigid(other).handle(scene.box.index)));
    for (Index k = 0; k < soft(loop).node_count(scene.bed); ++k) {
      const auto node = soft(loop).node(scene.bed, k);
      REQUIRE(soft(loop).position(node) == soft(other).position(soft(other).handle(node.index)));
    }
  }
}

}  // namespace soft_surfaces_with_tests
