#include "catch.hpp"
#include "study/planted.hpp"

namespace audit_rolling_tests {

using namespace planted;

TEST_CASE("rolling friction of a ball that lies still is found, and that of a ball that rolls out acts") {
  auto still = loop_with(RollingCoulomb{.rolling_friction = 0.01});
  bodies<RigidBodies>(still.world()).add_fixed(HalfSpace{});
  bodies<RigidBodies>(still.world()).add({.position = {0, 0, 0.2}, .mass = 1.0, .shape = Sphere{0.2}});
  const AuditReport idle = audit(run(std::move(still), 20));
  CHECK(find(idle, Effect::rolling).verdict == Verdict::never);
  CHECK(find(idle, Effect::rolling).work == Approx(0.5 * find(idle, Effect::contact).work));
  auto loop = loop_with(RollingCoulomb{.rolling_friction = 0.01});
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  rigid.add({.position = {0, 0, 0.2},
             .velocity = {1, 0, 0},
             .angular_velocity = {0, 5, 0},
             .mass = 1.0,
             .shape = Sphere{0.2}});
  CHECK(find(audit(run(std::move(loop), 20)), Effect::rolling).verdict == Verdict::acted);
}

}  // namespace audit_rolling_tests
