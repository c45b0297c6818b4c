// Which effects a run used: a box rests on the ground, friction and restitution are paid for all the same.
// prints: never: friction restitution body
#include <delassus/delassus.hpp>
#include <delassus/study/audit.hpp>

#include <cstdio>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Coulomb{.friction = 0.5}, 0.3}}},
                     Audit{}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  rigid.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
  for (int i = 0; i < 100; ++i) loop.step(1e-2);

  const AuditReport report = audit(loop);
  print(audit_table(report));
  std::printf("never:");
  for (const EffectUse& use : report.unused()) std::printf(" %s", name(use.effect));
  std::puts("");
}
