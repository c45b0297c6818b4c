// The soft scenes of the demonstration at steps of theirs: one matrix couples all nodes of a body, and the reference takes
// the whole of W.
#include "reference_tests.hpp"

#include "../examples/demonstration/needle.hpp"
#include "../examples/demonstration/soft_beam.hpp"
#include "../examples/demonstration/soft_grip.hpp"

#include <delassus/compliance/lazy.hpp>


namespace reference_soft_tests {

using namespace reference_tests;

namespace {

constexpr double h = 0.01;
using demonstration::SoftBodies;

/// A scene that is driven, at `steps`, ascending.
template <class Loop, class Scene>
void compare_driven(Loop& loop, Scene& scene, std::initializer_list<int> steps) {
  int done = 0;
  for (const int step : steps) {
    for (; done < step; ++done) {
      scene.drive(h * done);
      loop.step(h);
    }
    CAPTURE(step);
    compare(loop);
  }
}

}  // namespace

TEST_CASE("a ball on a soft beam agrees with the reference, when it lands and when it lies") {
  AnimationLoop loop{World{RigidBodies{}, SoftBodies{}}, Constraints{Contact{Coulomb{.friction = 0.8}}},
                     ImplicitEuler{.rayleigh_stiffness = 0.005}, LazyCompliance{},
                     NativeCollision{.margin = 0.05}};
  demonstration::add_soft_beam(loop);
  for (const int steps : {40, 20, 60}) compare(loop, h, steps);
}

TEST_CASE("fingers that lift soft cubes agree with the reference, while one holds and one slips") {
  AnimationLoop loop{World{RigidBodies{}, SoftBodies{}}, Constraints{Contact{Coulomb{}}, Slider{}},
                     ImplicitEuler{.rayleigh_stiffness = 0.01}};
  demonstration::SoftGrip grip(loop);
  compare_driven(loop, grip, {1, 2, 30, 75, 120});
}

// A cube that has slipped out may move in more than one way: Newton's steps on the law itself find another, 0.04 m/s off.
TEST_CASE("of two motions of a cube that slipped the reference finds the one it was asked about") {
  AnimationLoop loop{World{RigidBodies{}, SoftBodies{}}, Constraints{Contact{Coulomb{}}, Slider{}},
                     ImplicitEuler{.rayleigh_stiffness = 0.01}};
  demonstration::SoftGrip grip(loop);
  int swept = 0;
  for (int n = 0; n < 287; ++n) {
    grip.drive(h * n);
    loop.step(h);
    if (n < 275) continue;
    auto problem = loop.problem();
    if (solve(problem, AcceleratedGaussSeidel{.tolerance = 1e-10, .max_iterations = 20000}).status != Status::converged) continue;
    ++swept;
    const ReferenceCheck check = check_against_reference(problem);
    CAPTURE(n, check.text());
    CHECK(check.reached);
    CHECK(check.velocity <= 1e-6);
  }
  CHECK(swept >= 6);
}

TEST_CASE("a needle in soft tissue agrees with the reference") {
  AnimationLoop loop{World{RigidBodies{}, SoftBodies{}}, Constraints{PointOnLine{}},
                     ImplicitEuler{.rayleigh_stiffness = 0.01}};
  demonstration::NeedleInTissue needle(loop);
  compare_driven(loop, needle, {50, 200, 400});
}

TEST_CASE("one wrong impulse between a finger and a soft cube is found and named") {
  AnimationLoop loop{World{RigidBodies{}, SoftBodies{}}, Constraints{Contact{Coulomb{}}, Slider{}},
                     ImplicitEuler{.rayleigh_stiffness = 0.01}};
  demonstration::SoftGrip grip(loop);
  for (int n = 0; n < 30; ++n) {
    grip.drive(h * n);
    loop.step(h);
  }
  auto problem = loop.problem();
  REQUIRE(solve(problem, AcceleratedGaussSeidel{.tolerance = 1e-10}).status == Status::converged);
  const Vec3 error(0.01, 0, 0);
  problem.rows.pool<0>().lambda[3] += error;
  const ReferenceCheck check = check_against_reference(problem);
  CHECK(check.reached);
  CHECK(check.residual > 1e-3);
  CHECK(check.constraints.front().pool == 0);
  CHECK(check.constraints.front().item == 3);
  CHECK(check.constraints.front().velocity == Approx((problem.W.diagonal<0>(3) * error).norm()).epsilon(1e-6));
}

}  // namespace reference_soft_tests
