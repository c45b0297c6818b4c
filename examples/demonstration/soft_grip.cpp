// Two soft cubes, each lifted by two fingers: one with friction just above what holds it, one just below.
#include "measure.hpp"

#include <delassus/bodies/elasticity/corotational.hpp>
#include <delassus/bodies/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>

namespace demonstration {

Scene soft_grip(bool is_quick, const Watch& watch) {
  using Soft = TetrahedralFem<Corotational>;
  const double h = 0.01, seconds = is_quick ? 0.2 : 3, press = 20, weight = 9.81;  // N; the cube has 1 kg
  AnimationLoop loop{World{RigidBodies{}, Soft{}},
                     Constraints{Contact{Coulomb{}}, Slider{}},
                     ImplicitEuler{.rayleigh_stiffness = 0.01},
                     StepTime{},
                     Stopwatch{},
                     Recorder{"Soft grip",
                              "Fingers press two soft cubes with 20 N each and lift them. Friction holds "
                              "from μ = m g/(2 N) on: 5 % above it does, 5 % below it does not.",
                              20}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  auto& soft = bodies<Soft>(loop.world());
  struct Grip {
    Soft::BodyHandle cube;
    RigidBodies::Handle hand, finger[2];
  } grips[2];
  const Vec3 x = Vec3::UnitX();
  rigid.add_fixed(HalfSpace{Vec3::UnitZ(), -0.06});  // well below
  for (int k = 0; k < 2; ++k) {
    const double friction = (k == 0 ? 1.05 : 0.95) * weight / (2 * press), y = 0.25 * k;
    const Index material = loop.materials().add({.friction = friction});
    grips[k].cube = soft.add({.mesh = box_mesh({0.1, 0.1, 0.1}, {3, 3, 3}),
                              .elasticity = {.young = 5e4},
                              .position = {0, y, 0},
                              .contact_radius = 0.002,
                              .material = material});
    grips[k].hand = rigid.add({.position = {0.05, y + 0.05, 0.2}, .motion = Motion::kinematic});
    for (int side = 0; side < 2; ++side) {
      const Vec3 at(0.05 + (side == 0 ? -0.0625 : 0.0625), y + 0.05, 0.05);
      grips[k].finger[side] =
          rigid.add({.position = at, .mass = 0.2, .shape = Box{0.02, 0.12, 0.12}, .material = material});
      loop.add(Slider::Item{anchor_at(rigid, grips[k].hand, at, frame_along(x)),
                            anchor_at(rigid, grips[k].finger[side], at, frame_along(x))});
    }
  }
  // 0.5 s to grip, 0.5 s in which gravity comes, 1.5 s to lift by 5 cm, so slowly that it adds 1.3 % to the
  // weight.
  Scene scene = measure(loop, "native", h, seconds, watch, [&](double time) {
    const double t = std::clamp((time - 1) / 1.5, 0., 1.);
    soft.gravity = {0, 0, -9.81 * std::clamp((time - 0.5) / 0.5, 0., 1.)};
    for (Grip& grip : grips) {
      for (int side = 0; side < 2; ++side)
        rigid.apply_force(grip.finger[side], (side == 0 ? press : -press) * x);
      const Vec3 at = rigid.position(grip.hand);
      rigid.move_to(grip.hand, {at.x(), at.y(), 0.2 + 0.05 * t * t * t * (10 - 15 * t + 6 * t * t)},
                    Quat::Identity());
    }
  });
  const auto slip = [&](const Grip& grip) {  // of a node at 2/3 of a gripped face's height
    return rigid.position(grip.finger[0]).z() - 0.05 -
           (soft.position(soft.node(grip.cube, 36)).z() - 0.2 / 3);
  };
  if (!is_quick) {
    scene.expect_below(1e3 * std::abs(slip(grips[0])), 1, "the slip of the cube that is held", "mm");
    scene.expect_below(-1e3 * slip(grips[1]), -50, "less the slip of the cube that is not", "mm");
  }
  return scene;
}

}  // namespace demonstration
