// A needle goes into soft tissue, and is tilted there.
#include "measure.hpp"

#include <delassus/bodies/elasticity/corotational.hpp>
#include <delassus/bodies/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>

namespace demonstration {

Scene needle(bool is_quick, const Watch& watch) {
  using Soft = TetrahedralFem<Corotational>;
  const double h = 0.01, seconds = is_quick ? 0.5 : 6, length = 0.12;
  AnimationLoop loop{World{RigidBodies{}, Soft{}},
                     Constraints{PointOnLine{}},
                     ImplicitEuler{.rayleigh_stiffness = 0.01},
                     StepTime{},
                     Stopwatch{},
                     Recorder{"Needle",
                              "A needle is pushed 6 cm into tissue and then tilted by 10°. Every centimetre "
                              "a point of the tissue that the tip passed is held on its axis.",
                              20}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  auto& soft = bodies<Soft>(loop.world());
  const auto tissue = soft.add(
      {.mesh = box_mesh({0.12, 0.08, 0.06}, {6, 4, 3}), .elasticity = {.young = 5e3, .poisson = 0.45}});
  soft.fix(tissue, [](const Vec3& x) { return x.z() < 1e-9; });
  const Quat along = frame_along(Vec3::UnitX());  // the needle's z axis
  const auto shaft = rigid.add({.position = {-0.005 - length / 2, 0.043, 0.035},
                                .orientation = along,
                                .shape = Cylinder{0.001, length},
                                .motion = Motion::kinematic,
                                .group = 4,
                                .collides_with = 0});
  Index held = 0;
  Scene scene = measure(loop, "none", h, seconds, watch, [&](double time) {
    const double depth = std::min(0.06, 0.02 * time - 0.005);
    const double tilt = 0.17453 * std::clamp(time - 3.5, 0., 1.);
    const Quat turned = Quat(Eigen::AngleAxisd(tilt, Vec3::UnitY())) * along;
    const Vec3 tip(depth, 0.043, 0.035), entry(0, 0.043, 0.035);
    const Vec3 centre = entry + turned * Vec3(0, 0, depth - length / 2);
    rigid.move_to(shaft, tilt > 0 ? centre : Vec3(tip - length / 2 * Vec3::UnitX()), turned);
    if (depth > 0.01 * held + 1e-3 && tilt == 0) {
      loop.add(PointOnLine::Item{anchor(rigid, shaft),
                                 soft.anchor_at(tissue, Vec3(0.01 * held + 1e-3, 0.043, 0.035))});
      ++held;
    }
  });
  scene.expect_below(1e3 * scene.max_joint_gap, 1, "the largest distance of a held point from the needle",
                     "mm");
  if (!is_quick) scene.expect_below(-double(held), -5, "less the number of held points", "");
  return scene;
}

}  // namespace demonstration
