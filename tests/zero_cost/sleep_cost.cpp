// Ten thousand boxes that lie on the ground, awake or asleep; the difference of two runs under callgrind is a step.
//   sleep_cost <awake|asleep|visited> <steps>     visited: asleep, and one ball rolls among them
#include <delassus/delassus.hpp>

#include <cstdio>
#include <cstdlib>
#include <string>

using namespace delassus;

int main(int count, char** words) {
  if (count != 3) return 2;
  const std::string how = words[1];
  constexpr double h = 1.0 / 60;
  // Asleep from the first step on, or never.
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     Sleeping{.after = how == "awake" ? 1e9 : 0.5 * h}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(HalfSpace{});
  for (int x = 0; x < 100; ++x)
    for (int y = 0; y < 100; ++y) set.add({.position = {3.0 * x, 3.0 * y, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
  loop.step(h);
  if (how == "visited") set.add({.position = {1.5, 1.5, 0.5}, .velocity = {3, 0, 0}, .mass = 1.0, .shape = Sphere{0.5}});
  StepReport r;
  for (int n = std::atoi(words[2]); n > 0; --n) r = loop.step(h);
  std::printf("%d %d %zu\n", r.pairs, r.rows, loop.dormant().bodies().size());
}
