// A user's program: everything the package installs must be there for it to compile.
#ifdef CONSUMER_USES_COMPILED
#include <delassus/compiled.hpp>
#else
#include <delassus/delassus.hpp>
#endif

#ifdef CONSUMER_USES_FCL
#include <delassus/adapters/fcl.hpp>
#endif
#ifdef CONSUMER_USES_CCD
#include <delassus/adapters/ccd.hpp>
#endif
#ifdef CONSUMER_USES_URDF
#include <delassus/adapters/urdf.hpp>
#endif
#ifdef CONSUMER_USES_MJCF
#include <delassus/adapters/mjcf.hpp>
#endif

#include <cmath>

using namespace delassus;

/// Two sets of bodies and six laws: a rod on a motor carries a box by a ball joint, a slider and a stop beside it, and a particle
/// falls on it.
bool machine_holds() {
  AnimationLoop loop{World{RigidBodies{}, Particles{}},
                     Constraints{Contact{Restitution{Coulomb{.friction = 0.3}, 0.2}}, BallJoint{}, Hinge{}, Slider{}, Limit<Turn>{}, Motor<Turn>{}}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  const auto rod = rigid.add({.position = {0.5, 0, 2}, .mass = 1.0, .shape = Box{1, 0.1, 0.1}});
  const auto box = rigid.add({.position = {1, 0, 1.7}, .mass = 1.0, .shape = Box{0.2, 0.2, 0.2}});
  const auto cart = rigid.add({.position = {0, 2, 0.5}, .mass = 1.0, .shape = Box{0.3, 0.3, 0.3}});
  const auto bead = bodies<Particles>(loop.world()).add({.position = {0, -2, 1}, .mass = 0.1, .radius = 0.05});
  const Quat about_y = frame_along<double>(Vec3(0, 1, 0));
  const Anchor hub = anchor(rigid, rod, {-0.5, 0, 0}, about_y), post = world_anchor({0, 0, 2}, about_y);
  loop.add(Hinge::Item{hub, post});
  loop.add(Motor<Turn>::Item{.a = hub, .b = post, .speed = 1, .max_force = 50});
  loop.add(Limit<Turn>::Item{.a = hub, .b = post, .lower = -0.5, .upper = 0.5});
  loop.add(BallJoint::Item{anchor(rigid, rod, {0.5, 0, 0}), anchor(rigid, box, {0, 0, 0.3})});
  loop.add(Slider::Item{anchor(rigid, cart), world_anchor({0, 2, 0.5})});
  for (int i = 0; i < 500; ++i) loop.step(2e-3);
  const bool stands_at_stop = (rigid.position(rod) - Vec3(0, 0, 2)).norm() > 0.49 && std::abs(rigid.position(rod).z() - 2) > 0.2;
  const bool lies = std::abs(bodies<Particles>(loop.world()).position(bead).z() - 0.05) < 0.01;
  return stands_at_stop && lies && loop.report().max_joint_violation < 1e-2;
}

int main() {
  AnimationLoop loop{World{RigidBodies{}}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const auto box = rigid.add({.position = {0, 0, 5}, .mass = 2.0, .shape = Box{1, 1, 1}});
  loop.step(1e-3);
  return rigid.position(box).z() < 5 && machine_holds() ? 0 : 1;
}
