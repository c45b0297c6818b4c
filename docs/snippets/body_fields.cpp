// What a rigid body and a particle are given, how each kind of motion is driven, and what a stale handle does.
// prints: box of 500 kg, lift at 1\.20 m, corner at \(0\.50, 0\.50, 1\.00\)
#include <delassus/delassus.hpp>

#include <cstdio>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}, Particles{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  auto& dust = bodies<Particles>(loop.world());
  rigid.gravity = {0, 0, -9.81};  // of this set, m/s²

  rigid.add_fixed(HalfSpace{});
  const auto box = rigid.add({.position = {0, 0, 0.5}, .density = 500.0, .shape = Box{1, 1, 1}});
  const auto lift = rigid.add({.position = {3, 0, 1}, .shape = Box{1, 1, 0.2}, .motion = Motion::kinematic});
  const auto rotor = rigid.add(
      {.position = {6, 0, 2}, .mass = 2.0, .inertia = Mat3(Vec3(0.1, 0.2, 0.2).asDiagonal())});  // no shape: no contact
  dust.add({.position = {-2, 0, 0.02}, .mass = 0.01, .radius = 0.02});

  const double h = 0.01;
  for (int n = 1; n <= 100; ++n) {
    rigid.move_to(lift, {3, 0, 1 + 0.2 * n * h});  // its place at the end of this step
    rigid.apply_force(box, {100, 0, 0});           // N, during this step only; too weak to move it
    loop.step(h);
  }

  const Anchor corner = anchor(rigid, box, {0.5, 0.5, 0.5});           // the body's frame
  const Anchor same = anchor_at(rigid, box, {0.5, 0.5, 1});            // the world's frame, as it is now
  const Anchor hook = world_anchor({0, 0, 2}, frame_along({1, 0, 0}));  // no body: a point of the world
  const Vec3 x = loop.world().point(corner);
  std::printf("box of %.0f kg, lift at %.2f m, corner at (%.2f, %.2f, %.2f)\n", rigid.mass(box),
              rigid.position(lift).z(), x.x(), x.y(), x.z());
  std::printf("apart %.0e m, hook at %.1f m\n", (loop.world().point(same) - x).norm(), loop.world().point(hook).z());

  loop.remove(rotor);  // with every joint on it
  try {
    rigid.position(rotor);
  } catch (const InvalidArgument& refusal) {
    std::puts(refusal.what());
  }
}
