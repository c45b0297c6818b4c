// Physical errors of a study against closed forms: the orders that the integrators promise.
#include "catch.hpp"
#include "convergence_order.hpp"

#include <delassus/delassus.hpp>
#include <delassus/study/sweep.hpp>

#include <cmath>

namespace convergence_slide_tests {

using namespace delassus;

namespace {

constexpr double g = 9.81;

}  // namespace

TEST_CASE(
    "a sliding box stops where Coulomb says: symplectic Euler in first order, to its discrete closed form") {
  const double v0 = 5, mu = 0.3;
  const auto scene = [&](auto... policies) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = mu}}}, policies...};
    auto& rigid = bodies<RigidBodies>(loop.world());
    rigid.add_fixed(HalfSpace{});
    rigid.add({.position = {0, 0, 0.1}, .velocity = {v0, 0, 0}, .mass = 1.0, .shape = Box{1, 1, 0.2}});
    return loop;
  };
  const auto place = [](const auto& loop) { return loop.world().template set<0>().pose(1).position.x(); };
  const auto exact = [&](double t) {
    const double end = v0 / (mu * g), s = std::min(t, end);
    return v0 * s - 0.5 * mu * g * s * s;
  };
  const StudyPlan plan{.name = "sliding box",
                       .duration = 1,
                       .steps = {1. / 50, 1. / 100, 1. / 200},
                       .tolerances = {1e-10},
                       .outputs = 5,
                       .repeats = 1,
                       .is_quiet = true};
  const Study study = sweep(scene, Combinations{Choices{AcceleratedGaussSeidel{}}}, plan,
                            Measures{Compared{"place", "m", place, exact}, penetration()});
  for (const StudyRun& run : study.runs) {
    CHECK(run.outcome == Outcome::sound);
    // v after n steps is v0 − n μ g h, so x lags by ½ μ g h t. The solve is good to 1e-10 of g h, 1/h times
    // over.
    CHECK(run.errors[0] == Approx(0.5 * mu * g * run.h).epsilon(1e-6));
    // Nothing pushes the box in but the residual of the solve, 1e-10 of v0, for 1 s.
    CHECK(run.errors[1] < 1e-9 * v0);
  }
  // The error is linear in h to 1e-6, so the order is 1 to twice that over ln 2.
  CHECK(convergence_order(study, 0) == Approx(1).margin(3e-6));
  CHECK(convergence_order(study, 1) == Approx(1).margin(3e-6));
}

}  // namespace convergence_slide_tests
