// Counts and times of a step, to see what to make faster.
// prints: converged: 40 contacts, 120 rows, 1 islands, [0-9]+ sweeps
#include <delassus/delassus.hpp>

#include <cstdio>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, Stopwatch{}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  for (int i = 0; i < 10; ++i) rigid.add({.position = {0, 0, 0.5 + i}, .mass = 1.0, .shape = Box{1, 1, 1}});

  StepReport report;
  for (int i = 0; i < 100; ++i) report = loop.step(5e-3);
  std::printf("%s: %d contacts, %d rows, %d islands, %d sweeps\n", name(report.status), report.contacts,
              report.rows, report.islands, report.sweeps);
  loop.get<Stopwatch>().print();
}
