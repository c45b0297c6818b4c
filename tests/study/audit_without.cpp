#include "catch.hpp"
#include "study/planted.hpp"

namespace audit_without_tests {

using namespace planted;

TEST_CASE("a second run without what never acted ends in the same place, and saves what was predicted") {
  const AuditReport report = audit(scene(Coulomb{.friction = 0.5}, true));
  const Without friction = without(report, [] { return scene(Frictionless{}, true); });
  const double predicted = report.predicted_saving(find(report, Effect::friction));
  CHECK(predicted > 0.5);
  CHECK(friction.saving == Approx(predicted).epsilon(0.2));
  // Solves to 1e-8 of h g leave that speed in a body, for 1 s, in each of the two runs.
  CHECK(friction.difference < 2 * 1e-8 * 9.81);
  const Without rod = without(report, [] { return scene(Coulomb{.friction = 0.5}, false); });
  CHECK(rod.difference < 2 * 1e-8 * 9.81);
  CHECK(rod.saving > 0);
  CHECK_THROWS_WITH(without(report, [] { return run(scene(Coulomb{}, true), 1); }),
                    "delassus: without: the second run took 101 steps, the first 100; they must be as many");
}

}  // namespace audit_without_tests
