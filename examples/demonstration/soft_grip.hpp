/// The fingers of the demonstration and the soft cubes between them.
#pragma once

#include "soft_bodies.hpp"

#include <delassus/bodies/anchor_at.hpp>
#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/constraints/joints/slider.hpp>
#include <delassus/geometry/box_mesh.hpp>

#include <algorithm>

namespace demonstration {

/// Two fingers press each of two soft cubes of one kilogram with 20 N and lift it. Friction holds from μ = m g/(2 N)
/// on: the first cube has 5 % more, the second 5 % less.
template <class Loop>
class SoftGrip {
 public:
  explicit SoftGrip(Loop& loop) : loop_(loop) {
    using namespace delassus;
    rigid().add_fixed(HalfSpace{Vec3::UnitZ(), -0.06});  // well below
    for (int k = 0; k < 2; ++k) {
      Grip& grip = grips_[k];
      const double friction = (k == 0 ? 1.05 : 0.95) * weight / (2 * press), y = 0.25 * k;
      const Index material = loop.materials().add({.friction = friction});
      grip.cube = soft().add({.mesh = box_mesh({0.1, 0.1, 0.1}, {3, 3, 3}),
                              .elasticity = {.young = 5e4},
                              .position = {0, y, 0},
                              .contact_radius = 0.002,
                              .material = material});
      grip.hand = rigid().add({.position = {0.05, y + 0.05, 0.2}, .motion = Motion::kinematic});
      for (int side = 0; side < 2; ++side) {
        const Vec3 at(0.05 + (side == 0 ? -0.0625 : 0.0625), y + 0.05, 0.05);
        grip.finger[side] =
            rigid().add({.position = at, .mass = 0.2, .shape = Box{0.02, 0.12, 0.12}, .material = material});
        const Quat along = frame_along(Vec3::UnitX());
        loop.add(Slider::Item{anchor_at(rigid(), grip.hand, at, along),
                              anchor_at(rigid(), grip.finger[side], at, along)});
      }
    }
  }

  /// Before the step that begins at `time`: 0.5 s to grip, 0.5 s in which gravity comes, 1.5 s to lift by 5 cm, so slowly
  /// that it adds 1.3 % to the weight.
  void drive(double time) {
    using namespace delassus;
    const double t = std::clamp((time - 1) / 1.5, 0., 1.);
    soft().gravity = {0, 0, -9.81 * std::clamp((time - 0.5) / 0.5, 0., 1.)};
    for (Grip& grip : grips_) {
      for (int side = 0; side < 2; ++side)
        rigid().apply_force(grip.finger[side], (side == 0 ? press : -press) * Vec3::UnitX());
      const Vec3 at = rigid().position(grip.hand);
      rigid().move_to(grip.hand, {at.x(), at.y(), 0.2 + 0.05 * t * t * t * (10 - 15 * t + 6 * t * t)},
                      Quat::Identity());
    }
  }

  /// Of cube k, at a node at 2/3 of a gripped face's height, m.
  double slip(int k) {
    const Grip& grip = grips_[k];
    return rigid().position(grip.finger[0]).z() - 0.05 -
           (soft().position(soft().node(grip.cube, 36)).z() - 0.2 / 3);
  }

 private:
  static constexpr double press = 20, weight = 9.81;  ///< N
  struct Grip {
    SoftBodies::BodyHandle cube;
    delassus::RigidBodies::Handle hand, finger[2];
  };

  auto& rigid() { return delassus::bodies<delassus::RigidBodies>(loop_.world()); }
  auto& soft() { return delassus::bodies<SoftBodies>(loop_.world()); }

  Loop& loop_;
  Grip grips_[2];
};

}  // namespace demonstration
