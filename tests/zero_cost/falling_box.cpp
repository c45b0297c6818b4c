// What a loop without collision, constraints and solver is compiled to: symbols.py looks at it.
#include <delassus/delassus.hpp>

using namespace delassus;

using Free = AnimationLoop<World<RigidBodies>>;

// A loop without constraints is its world, the scratch of its sets, the report, the clock and whether a step runs; nothing else.
struct LeastLoop {
  World<RigidBodies> world;
  std::vector<RigidBodies::Velocity> scratch;
  StepReport report;
  double h, last_h, start;
  long steps;
  bool is_under_way;
};
static_assert(sizeof(Free) == sizeof(LeastLoop));

// Listeners and policies that carry no state add no byte.
struct Silent {
  using plays = role::Listener;
  using listens = Listens<>;
};
static_assert(sizeof(AnimationLoop<World<RigidBodies>, Silent, SymplecticEuler>) == sizeof(LeastLoop));

// A contact without friction has one impulse, one with friction three; a joint has no field of limits or motors.
static_assert(sizeof(Local<1>) == 3 * sizeof(double));
static_assert(Frictionless::rows == 1 && Coulomb::rows == 3);
static_assert(sizeof(BallJoint::Item) == 2 * sizeof(Anchor));

int main() {
  Free loop{World{RigidBodies{}}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const auto box = rigid.add({.position = {0, 0, 5}, .mass = 2.0, .shape = Box{1, 1, 1}});
  for (int i = 0; i < 1000; ++i) loop.step(1e-3);
  return rigid.position(box).z() > 0.1 ? 1 : 0;
}
