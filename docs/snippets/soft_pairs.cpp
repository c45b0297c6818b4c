// Penalty contact for pairs with a rubber mat, rigid contact for all others: the first law that takes a pair has it.
// prints: the ball on the mat sinks in by 0\.98 mm, the one on the floor by 0\.00 mm
#include <delassus/delassus.hpp>

#include <cstdio>

using namespace delassus;

constexpr Index rubber = 1;
struct OnRubber {
  static bool takes(Index a, Index b) { return a == rubber || b == rubber; }
};

int main() {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{ContactFor<Penalty<Coulomb>, OnRubber>{{Penalty{Coulomb{.friction = 0.5}, 1e4, 50}}},
                                 Contact{Coulomb{.friction = 0.5}}}};
  loop.materials().add({.friction = 0.8});  // gets the number 1
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  rigid.add({.position = {3, 0, 0.05}, .shape = Box{1, 1, 0.1}, .motion = Motion::fixed, .material = rubber});
  const auto low = rigid.add({.position = {0, 0, 0.1}, .mass = 1.0, .shape = Sphere{0.1}});
  const auto high = rigid.add({.position = {3, 0, 0.2}, .mass = 1.0, .shape = Sphere{0.1}});
  for (int n = 0; n < 500; ++n) loop.step(2e-3);
  std::printf("the ball on the mat sinks in by %.2f mm, the one on the floor by %.2f mm\n",
              1e3 * (0.2 - rigid.position(high).z()), 1e3 * (0.1 - rigid.position(low).z()));

  for (const auto& c : loop.contacts())
    if (rigid.handle(c.record.b.block) == high)
      std::printf("it receives %.2f N along (%.0f, %.0f, %.0f)\n", c.impulse.norm() / 2e-3, c.record.normal.x(),
                  c.record.normal.y(), c.record.normal.z());
}
