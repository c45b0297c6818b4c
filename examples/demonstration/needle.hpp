/// The needle of the demonstration and the tissue that it goes into.
#pragma once

#include "soft_bodies.hpp"

#include <delassus/bodies/anchor_at.hpp>
#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/constraints/joints/point_on_line.hpp>
#include <delassus/geometry/box_mesh.hpp>

#include <algorithm>

namespace demonstration {

/// A needle is pushed 6 cm into tissue and then tilted by 10°. Every centimetre a point of the tissue that the tip passed
/// is held on its axis.
template <class Loop>
class NeedleInTissue {
 public:
  explicit NeedleInTissue(Loop& loop) : loop_(loop) {
    using namespace delassus;
    tissue_ = soft().add(
        {.mesh = box_mesh({0.12, 0.08, 0.06}, {6, 4, 3}), .elasticity = {.young = 5e3, .poisson = 0.45}});
    soft().fix(tissue_, [](const Vec3& x) { return x.z() < 1e-9; });
    shaft_ = rigid().add({.position = {-0.005 - length / 2, 0.043, 0.035},
                          .orientation = along,
                          .shape = Cylinder{0.001, length},
                          .motion = Motion::kinematic,
                          .group = 4,
                          .collides_with = 0});
  }

  /// Before the step that begins at `time`.
  void drive(double time) {
    using namespace delassus;
    const double depth = std::min(0.06, 0.02 * time - 0.005);
    const double tilt = 0.17453 * std::clamp(time - 3.5, 0., 1.);
    const Quat turned = Quat(Eigen::AngleAxisd(tilt, Vec3::UnitY())) * along;
    const Vec3 tip(depth, 0.043, 0.035), entry(0, 0.043, 0.035);
    const Vec3 centre = entry + turned * Vec3(0, 0, depth - length / 2);
    rigid().move_to(shaft_, tilt > 0 ? centre : Vec3(tip - length / 2 * Vec3::UnitX()), turned);
    if (depth > 0.01 * held_ + 1e-3 && tilt == 0) {
      loop_.add(PointOnLine::Item{anchor(rigid(), shaft_),
                                  soft().anchor_at(tissue_, Vec3(0.01 * held_ + 1e-3, 0.043, 0.035))});
      ++held_;
    }
  }

  delassus::Index held() const { return held_; }

 private:
  static constexpr double length = 0.12;                                     ///< m
  const delassus::Quat along = delassus::frame_along(delassus::Vec3::UnitX());  ///< the needle's z axis

  auto& rigid() { return delassus::bodies<delassus::RigidBodies>(loop_.world()); }
  auto& soft() { return delassus::bodies<SoftBodies>(loop_.world()); }

  Loop& loop_;
  SoftBodies::BodyHandle tissue_;
  delassus::RigidBodies::Handle shaft_;
  delassus::Index held_ = 0;
};

}  // namespace demonstration
