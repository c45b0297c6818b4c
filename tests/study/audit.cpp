#include "catch.hpp"
#include "study/planted.hpp"

#include <cmath>

namespace audit_tests {

using namespace planted;

TEST_CASE("an audit finds friction, restitution, a joint and bodies that a scene pays for and never uses") {
  const AuditReport report = audit(scene(Restitution{Coulomb{.friction = 0.5}, 0.5}, true));
  CHECK(report.steps == 100);
  CHECK(find(report, Effect::contact).verdict == Verdict::acted);
  CHECK(find(report, Effect::contact).present == 100 * 8);
  CHECK(find(report, Effect::friction).verdict == Verdict::never);
  CHECK(find(report, Effect::restitution).verdict == Verdict::never);
  CHECK(report.predicted_saving(find(report, Effect::restitution)) == 0);  // it has no rows
  CHECK(find(report, Effect::joint, 0).verdict == Verdict::never);
  CHECK(find(report, Effect::joint, 0).place == 0);
  CHECK(find(report, Effect::joint, 1).verdict == Verdict::acted);
  CHECK(find(report, Effect::body, 0).verdict == Verdict::never);
  CHECK(find(report, Effect::body, 1).verdict == Verdict::never);
  CHECK(find(report, Effect::body, 2).verdict == Verdict::acted);
  CHECK(report.unused().size() == 5);
  // Two rows of three of every contact are friction's; nothing else has rows but the two joints.
  CHECK(find(report, Effect::friction).work == Approx(2. / 3 * find(report, Effect::contact).work));
  CHECK(find(report, Effect::contact).work + find(report, Effect::joint, 0).work +
            find(report, Effect::joint, 1).work ==
        Approx(report.work));
  const Table table = audit_table(report);
  CHECK(table.rows.size() == report.uses.size());
  CHECK(table.rows[0][2].text == "never");
}

TEST_CASE("an audit finds nothing in a scene that needs all of its effects") {
  auto loop = loop_with(Restitution{Coulomb{.friction = 0.05}, 0.7});
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  rigid.add(
      {.position = {0, 0, 1}, .velocity = {3, 0, 0}, .mass = 1.0, .shape = Sphere{0.2}});  // bounces, slips
  const auto bob = rigid.add({.position = {1, 5, 4}, .mass = 1.0, .shape = Sphere{0.1}});
  loop.add(DistanceJoint::Item{.a = anchor(rigid, bob), .b = world_anchor({0, 5, 4}), .length = 1});
  const AuditReport report = audit(run(std::move(loop), 100));
  CHECK(report.uses.size() == 6);
  for (const EffectUse& use : report.uses) CHECK(use.verdict == Verdict::acted);
}

TEST_CASE("friction that holds and never slips is told from friction that does neither") {
  auto loop = loop_with(Restitution{Coulomb{.friction = 0.9}, 0.0});
  auto& rigid = bodies<RigidBodies>(loop.world());
  const double slope = 0.3;
  rigid.add_fixed(HalfSpace{{std::sin(slope), 0, std::cos(slope)}, 0});
  rigid.add({.position = 0.1 * Vec3(std::sin(slope), 0, std::cos(slope)),
             .orientation = Quat(Eigen::AngleAxisd(slope, Vec3::UnitY())),
             .mass = 1.0,
             .shape = Box{1, 1, 0.2}});
  double work = 0;  // one island: its sweeps are the step's
  for (int i = 0; i < 50; ++i) {
    const StepReport step = loop.step(h);
    work += double(step.rows) * step.sweeps;
  }
  const AuditReport report = audit(loop);
  CHECK(report.work == work);
  CHECK(work > 12 * 50);  // some step takes more than one sweep
  CHECK(find(report, Effect::friction).verdict == Verdict::held);
  CHECK(find(report, Effect::body).verdict == Verdict::never);
}

TEST_CASE("contacts that are never made are found") {
  auto flying = loop_with(Restitution{Coulomb{}, 0.5});
  bodies<RigidBodies>(flying.world()).add_fixed(HalfSpace{});
  bodies<RigidBodies>(flying.world()).add({.position = {0, 0, 50}, .mass = 1.0, .shape = Sphere{0.1}});
  const AuditReport report = audit(run(std::move(flying), 20));
  CHECK(find(report, Effect::contact).verdict == Verdict::never);
  CHECK(find(report, Effect::friction).verdict == Verdict::never);
  CHECK(find(report, Effect::body).verdict == Verdict::acted);
  CHECK(report.work == 0);
  CHECK_THROWS_WITH(Audit{0.0}.check(), "delassus: Audit: least 0 must lie in (0, 1)");
}

}  // namespace audit_tests
