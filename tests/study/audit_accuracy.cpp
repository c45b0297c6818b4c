#include <delassus/delassus.hpp>
#include <delassus/schemes/error_controlled.hpp>
#include <delassus/schemes/substeps.hpp>
#include <delassus/study/audit.hpp>

#include "catch.hpp"

#include <algorithm>

namespace audit_accuracy_tests {

using namespace delassus;

namespace {

auto bouncing_ball(auto... policies) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Frictionless{}, 0.8}}}, ImplicitMidpoint{}, PositionProjection{},
                     AcceleratedGaussSeidel{.tolerance = 1e-9}, Audit{}, policies...};
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(HalfSpace{});
  set.add({.position = {0, 0, 1.1}, .mass = 1.0, .shape = Sphere{0.1}});
  return loop;
}

}  // namespace

TEST_CASE("an audit says what set the size of the steps under an accuracy") {
  auto loop = bouncing_ball(ErrorControlled{.accuracy = 1e-4});
  long steps = 0, rejections = 0;
  for (int n = 0; n < 8; ++n) {
    loop.step(0.25);
    steps += error_report(loop).steps;
    rejections += error_report(loop).rejections;
  }
  const AuditReport report = audit(loop);
  const auto cause = [&](ErrorEffect effect) {
    const auto found = std::find_if(report.causes.begin(), report.causes.end(), [&](const StepCause& c) { return c.effect == effect; });
    REQUIRE(found != report.causes.end());
    return *found;
  };
  const StepCause flight = cause(ErrorEffect::motion), impact = cause(ErrorEffect::impact);
  CHECK(flight.steps + impact.steps == steps);
  CHECK(flight.rejections + impact.rejections == rejections);
  CHECK(impact.rejections > 10);  // three impacts in 2 s, each looked for by halves
  CHECK(flight.rejections == 0);
  CHECK(impact.least_step < 1e-3);
  CHECK(flight.least_step > 0);
  CHECK(impact.error > 0);
  CHECK(impact.error <= 1e-4);
  CHECK(impact.body == "rigid body #1");
  CHECK(step_table(report).rows.size() == 2);
}

// The impacts are in the middle of the host's steps: at its ends the ball flies.
TEST_CASE("an audit sees what acts within a step that a scheme divides") {
  auto controlled = bouncing_ball(ErrorControlled{.accuracy = 1e-3});
  for (int n = 0; n < 8; ++n) controlled.step(0.25);
  for (const EffectUse& use : audit(controlled).uses) CHECK(use.verdict == Verdict::acted);
  auto divided = bouncing_ball(Substeps{25});
  for (int n = 0; n < 8; ++n) divided.step(0.25);
  for (const EffectUse& use : audit(divided).uses) CHECK(use.verdict == Verdict::acted);
  CHECK(audit(divided).causes.empty());
}

}  // namespace audit_accuracy_tests
