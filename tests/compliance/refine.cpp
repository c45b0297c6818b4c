#include <delassus/compliance/lazy.hpp>
#include <delassus/delassus.hpp>
#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>

#include "catch.hpp"
#include "stages.hpp"

#include <algorithm>
#include <cmath>

namespace refine_tests {

using namespace delassus;

namespace {

using Soft = TetrahedralFem<Corotational>;
constexpr double h = 0.01;

/// A beam of 0.4 × 0.1 × 0.1 m, clamped at one end, falls on the ground; a ball of 0.2 kg hangs from a point
/// within.
auto scene(const LazyCompliance& compliance, double young = 2e4) {
  AnimationLoop loop{World{RigidBodies{}, Soft{}},
                     Constraints{Contact{Coulomb{.friction = 0.4}}, BallJoint{}},
                     ImplicitEuler{.rayleigh_stiffness = 0.02},
                     compliance,
                     NativeCollision{.margin = 0.01},
                     GaussSeidel{.tolerance = 1e-11, .max_iterations = 20000}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  auto& soft = bodies<Soft>(loop.world());
  rigid.add_fixed(HalfSpace{});
  const auto beam = soft.add({.mesh = box_mesh({0.4, 0.1, 0.1}, {6, 2, 2}),
                              .elasticity = {.young = young},
                              .position = {0, 0, 0.03},
                              .contact_radius = 0.01});
  soft.fix(beam, [](const Vec3& x) { return x.x() < 1e-9; });
  const Vec3 hook(0.31, 0.03, 0.07);
  const auto ball = rigid.add({.position = {0.31, 0.3, 0.07}, .mass = 0.2, .shape = Sphere{0.03}});
  loop.add(BallJoint::Item{soft.anchor_at(beam, hook), anchor_at(rigid, ball, hook)});
  return loop;
}

/// How far the velocities after the step are from holding the rows, as a displacement (m): joints u + bias =
/// 0, contacts u_n + bias ≥ 0, and = 0 where there is an impulse.
double violation_after(const auto& loop) {
  const auto problem = loop.problem();
  double worst = 0;
  const auto off = [&](const auto& pool, Index i) {
    Vec3 u = pool.bias[i];
    const auto add = [&](const auto& blocks, const auto& v) {
      for (Index e = blocks.offset[i]; e < blocks.offset[i + 1]; ++e) u += blocks.H[e] * v[blocks.block[e]];
    };
    add(inner::part<0>(pool.sets), bodies<RigidBodies>(loop.world()).v_next);
    add(inner::part<1>(pool.sets), bodies<Soft>(loop.world()).v_next);
    return Vec3(h * u);
  };
  const auto& contacts = problem.rows.template pool<0>();
  for (Index i = 0; i < contacts.items(); ++i) {
    const double normal = off(contacts, i)[0];
    worst = std::max(worst, contacts.lambda[i][0] > 0 ? std::abs(normal) : -normal);
  }
  const auto& joints = problem.rows.template pool<1>();
  for (Index i = 0; i < joints.items(); ++i) worst = std::max(worst, off(joints, i).cwiseAbs().maxCoeff());
  return worst;
}

}  // namespace

// What the solve leaves is below err_s = 1e-11 times velocities of some m/s, h 1e-10 m in all.
TEST_CASE("after a step with a lazy compliance the rows are violated by its tolerance at most") {
  int most_passes = 0;
  for (const double violation : {1e-5, 1e-8}) {
    auto loop = scene({.violation = violation});
    int passes = 0;
    double worst = 0;
    Index contacts = 0;
    for (int n = 0; n < 60; ++n) {
      solve_by_stages(loop, h);
      REQUIRE(loop.report().status == Status::converged);
      worst = std::max(worst, violation_after(loop));
      contacts = std::max(contacts, loop.report().contacts);
      passes += loop.get<LazyCompliance>().report.passes;
      stage::advance(loop.data());
    }
    CHECK(worst <= violation + 1e-10);
    CHECK(worst > 1e-3 * violation);  // else the tolerance says nothing
    CHECK(contacts >= 9);
    CHECK(passes > most_passes);  // nearer is dearer
    most_passes = passes;
  }
}

TEST_CASE("a factor is kept while it serves, and made anew when solves take too long") {
  const auto factorizations = [](const LazyCompliance& compliance, double young) {
    auto loop = scene(compliance, young);
    int count = 0;
    for (int n = 0; n < 40; ++n) {
      loop.step(h);
      count += loop.get<LazyCompliance>().report.factorizations;
    }
    return count;
  };
  CHECK(factorizations({}, 2e4) == 1);
  CHECK(factorizations({.max_iterations = 0}, 2e4) == 40);
  const int now_and_then = factorizations({.max_iterations = 2}, 2e4);
  CHECK(now_and_then > 1);
  CHECK(now_and_then < 40);
}

TEST_CASE("a lazy compliance refuses numbers that cannot be") {
  const auto refuses = [](const LazyCompliance& compliance, const char* what) {
    CHECK_THROWS_WITH(scene(compliance), Catch::Contains("LazyCompliance: ") && Catch::Contains(what));
  };
  refuses({.violation = 0}, "violation");
  refuses({.tolerance = 1}, "tolerance");
  refuses({.max_iterations = -1}, "max_iterations");
  refuses({.contraction = 1.5}, "contraction");
}

}  // namespace refine_tests
