// The normal force between two bodies over time, as a table.
// prints: 0\.1000,9\.81[0-9]*
#include <delassus/delassus.hpp>

#include <cstdio>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const auto floor = rigid.add_fixed(HalfSpace{});
  const auto box = rigid.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});

  const double h = 5e-3;
  std::printf("time (s),force (N)\n");
  for (int i = 0; i < 20; ++i) {
    const StepReport report = loop.step(h);
    double force = 0;
    for (const auto& c : loop.contacts())
      if (rigid.handle(c.record.a.block) == floor && rigid.handle(c.record.b.block) == box)
        force += c.impulse.dot(c.record.normal) / h;
    std::printf("%.4f,%.6f\n", report.time, force);
  }
}
