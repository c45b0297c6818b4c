#include "catch.hpp"
#include "study/planted.hpp"

namespace audit_savings_tests {

using namespace planted;

namespace {

/// Four doors swing on their hinges, each with a limit out of reach; beside them pairs of balls fall side by
/// side, a rod between them.
struct Planted {
  bool limits = true, rods = true;
};
auto doors(Planted with) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, Limit<Turn>{}, DistanceJoint{}},
                     AcceleratedGaussSeidel{.tolerance = 1e-8}, Audit{}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const Quat level = frame_along({0, 1, 0});
  for (int k = 0; k < 4; ++k) {
    const Vec3 at(0, 2. * k, 0), away(5, 2. * k, 0);
    const auto door = rigid.add({.position = at + Vec3(0.5, 0, 0), .mass = 1.0, .shape = Box{1, 0.4, 0.1}});
    const Anchor post = world_anchor(at, level), leaf = anchor(rigid, door, {-0.5, 0, 0}, level);
    loop.add(Hinge::Item{post, leaf});
    if (with.limits) loop.add(Limit<Turn>::Item{.a = post, .b = leaf, .lower = -3, .upper = 3});
    const auto a = rigid.add({.position = away, .mass = 1.0, .shape = Sphere{0.1}});
    const auto b = rigid.add({.position = away + Vec3(1, 0, 0), .mass = 2.0, .shape = Sphere{0.1}});
    if (with.rods) loop.add(DistanceJoint::Item{.a = anchor(rigid, a), .b = anchor(rigid, b), .length = 1});
  }
  return run(std::move(loop), 60);
}

}  // namespace

// A row that carries nothing changes no sweep's answer: what is saved is its share of the rows, but for
// sweeps that the rows left need fewer of.
TEST_CASE(
    "limits and joints that nothing needs are found, and their saving is what a run without them measures") {
  const AuditReport report = audit(doors({}));
  double limits = 0, rods = 0;
  int found = 0;
  for (const EffectUse& use : report.uses) {
    if (use.effect != Effect::joint) continue;
    const bool is_limit = use.name.find("Limit") != std::string::npos;
    const bool is_rod = use.name.find("DistanceJoint") != std::string::npos;
    CAPTURE(use.name);
    CHECK(use.verdict == (is_limit || is_rod ? Verdict::never : Verdict::acted));
    limits += is_limit * report.predicted_saving(use);
    rods += is_rod * report.predicted_saving(use);
    ++found;
  }
  CHECK(found == 12);
  const Without no_limit = without(report, [] { return doors({.limits = false}); });
  const Without no_rod = without(report, [] { return doors({.rods = false}); });
  CHECK(no_limit.saving == Approx(limits).epsilon(0.2));
  CHECK(no_rod.saving == Approx(rods).epsilon(0.2));
  // Solves to 1e-8 of h g, for 0.6 s, in each of two runs, of doors that a wrong speed turns a few times
  // further.
  CHECK(no_limit.difference < 1e-6);
  CHECK(no_rod.difference < 1e-6);
}

}  // namespace audit_savings_tests
