// One scene in which friction, restitution, a joint and a limit do nothing, and one that needs them all.
#include "catch.hpp"
#include "study/planted.hpp"

#include <delassus/solvers/proximal_newton.hpp>

#include <cmath>

namespace audit_planted_tests {

using namespace planted;

struct Idle {
  bool rod = true, limit = true;
};

template <class Law, class Solver>
auto machine(Law law, Solver solver) {
  return AnimationLoop{World{RigidBodies{}},
                       Constraints{Contact{law}, DistanceJoint{}, Hinge{}, Limit<Turn>{}}, solver, Audit{}};
}

/// Three pairs of boxes rest on the ground, each with a rod of just its length between the two; a door
/// swings, its limits out of reach.
template <class Law, class Solver = AcceleratedGaussSeidel>
auto useless(Law law, Idle idle = {}, Solver solver = {.tolerance = 1e-8}) {
  auto loop = machine(law, solver);
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  for (int k = 0; k < 3; ++k) {
    const auto a = rigid.add({.position = {0, 3. * k, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
    const auto b = rigid.add({.position = {2, 3. * k, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
    if (idle.rod) loop.add(DistanceJoint::Item{.a = anchor(rigid, a), .b = anchor(rigid, b), .length = 2});
  }
  const Quat level = frame_along({0, 1, 0});
  const auto door = rigid.add({.position = {0.5, 0, 5}, .mass = 1.0, .shape = Box{1, 0.4, 0.1}});
  const Anchor post = world_anchor({0, 0, 5}, level), leaf = anchor(rigid, door, {-0.5, 0, 0}, level);
  loop.add(Hinge::Item{post, leaf});
  if (idle.limit) loop.add(Limit<Turn>::Item{.a = post, .b = leaf, .lower = -3, .upper = 3});
  return run(std::move(loop), 60);
}

constexpr Coulomb rough{.friction = 0.5};

/// The share of the visits that the audit predicts for all uses of an effect of laws whose name holds `word`.
inline double predicted(const AuditReport& report, Effect effect, const char* word) {
  double share = 0;
  for (const EffectUse& use : report.uses)
    if (use.effect == effect && use.name.find(word) != std::string::npos) {
      CAPTURE(use.name);
      CHECK(use.verdict == Verdict::never);
      share += report.predicted_saving(use);
    }
  return share;
}

TEST_CASE(
    "friction, restitution, joints and limits that do nothing are found, each at what a run without it "
    "saves") {
  const AuditReport report = audit(useless(Restitution{rough, 0.5}));
  struct Planted {
    const char* what;
    double predicted;
    Without measured;
  };
  const Planted all[] = {{"friction", predicted(report, Effect::friction, "Coulomb"),
                          without(report,
                                  [] {
                                    return useless(Restitution{Frictionless{}, 0.5});
                                  })},
                         {"restitution", predicted(report, Effect::restitution, "Restitution"),
                          without(report, [] { return useless(rough); })},
                         {"rods", predicted(report, Effect::joint, "DistanceJoint"),
                          without(report,
                                  [] {
                                    return useless(Restitution{rough, 0.5}, {.rod = false});
                                  })},
                         {"limit", predicted(report, Effect::joint, "Limit"), without(report, [] {
                            return useless(Restitution{rough, 0.5}, {.limit = false});
                          })}};
  for (const Planted& planted : all) {
    CAPTURE(planted.what, planted.predicted, planted.measured.saving);
    CHECK(std::abs(planted.measured.saving - planted.predicted) <= 0.2 * planted.predicted);
    CHECK((planted.predicted > 0) == (std::string(planted.what) != "restitution"));  // which has no rows
    // Solves to 1e-8 of h g, for 0.6 s, in each of two runs, of a door that a wrong speed turns a few times
    // further.
    CHECK(planted.measured.difference < 1e-6);
  }
}

TEST_CASE("visits of rows are sweeps and factorizations") {
  const auto loop = useless(rough, {}, ProximalNewton{.tolerance = 1e-10});
  int factorizations = 0;
  for (const SolveReport& island : loop.island_reports()) factorizations += island.factorizations;
  CHECK(factorizations > 0);
  CHECK(audit(loop).work > 60. * loop.report().rows);
}

TEST_CASE("nothing is found in a scene that needs friction, restitution, a rod and a limit") {
  auto loop = machine(Restitution{Coulomb{.friction = 0.05}, 0.7}, AcceleratedGaussSeidel{.tolerance = 1e-8});
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  rigid.add({.position = {0, 0, 1}, .velocity = {3, 0, 0}, .mass = 1.0, .shape = Sphere{0.2}});
  const auto bob = rigid.add({.position = {1, 5, 4}, .mass = 1.0, .shape = Sphere{0.1}});
  loop.add(DistanceJoint::Item{.a = anchor(rigid, bob), .b = world_anchor({0, 5, 4}), .length = 1});
  const Quat level = frame_along({0, 1, 0});
  const auto door = rigid.add({.position = {0.5, -5, 5}, .mass = 1.0, .shape = Box{1, 0.4, 0.1}});
  const Anchor post = world_anchor({0, -5, 5}, level), leaf = anchor(rigid, door, {-0.5, 0, 0}, level);
  loop.add(Hinge::Item{post, leaf});
  loop.add(Limit<Turn>::Item{.a = post, .b = leaf, .lower = -0.5, .upper = 0.5});  // gravity turns it to one
  const AuditReport report = audit(run(std::move(loop), 100));
  CHECK(report.uses.size() == 3 + 3 + 3);  // of the contact; rod, hinge, limit; bodies
  CHECK(report.unused().empty());
}

}  // namespace audit_planted_tests
