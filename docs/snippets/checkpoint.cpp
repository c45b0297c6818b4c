// A loop is saved to a file, and another loop of the same type goes on from there to the bit.
// prints: same state: yes, at 2\.0 s, hook still holds: yes
#include <delassus/delassus.hpp>
#include <delassus/io/checkpoint.hpp>

#include <cstdio>

using namespace delassus;

auto make_loop() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}}};
}

int main() {
  auto loop = make_loop();
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  const auto bob = rigid.add({.position = {1, 0, 2}, .mass = 1.0, .shape = Sphere{0.1}});
  loop.add(BallJoint::Item{anchor(rigid, bob, {-1, 0, 0}), world_anchor({0, 0, 2})});
  for (int i = 0; i < 100; ++i) loop.step(0.01);
  save_checkpoint(loop, "pendulum.checkpoint");
  for (int i = 0; i < 100; ++i) loop.step(0.01);

  auto other = make_loop();  // may be empty, or hold something else
  load_checkpoint(other, "pendulum.checkpoint");
  const auto its_bob = bodies<RigidBodies>(other.world()).handle(1);  // handles are given anew
  const auto its_hook = other.constraint<BallJoint>(0);
  for (int i = 0; i < 100; ++i) other.step(0.01);

  const double length = bodies<RigidBodies>(other.world()).position(its_bob).norm();
  std::printf("same state: %s, at %.1f s, hook still holds: %s\n", state_hash(loop) == state_hash(other) ? "yes" : "no",
              other.time(), length > 0 && other.impulse(its_hook).norm() > 0 ? "yes" : "no");
  std::remove("pendulum.checkpoint");
}
