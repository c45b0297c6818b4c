/// Rods in a plane, on hinges: what the mechanisms of HC-21 are put together from.
#pragma once

#include <delassus/delassus.hpp>
#include <delassus/steppers/newton_midpoint.hpp>

#include <cmath>

namespace ladders {

using namespace delassus;

/// Unit rods of 1 kg in the plane of x and z, on hinges along y.
struct PlaneLoop {
  AnimationLoop<World<RigidBodies>, Constraints<Hinge, Slider>, NewtonMidpoint> loop{
      World{RigidBodies{}}, Constraints{Hinge{}, Slider{}}, NewtonMidpoint{}};
  RigidBodies& rigid = bodies<RigidBodies>(loop.world());
  const Quat across = frame_along({0, 1, 0});

  PlaneLoop() { rigid.gravity.setZero(); }
  RigidBodies::Handle rod(const Vec3& from, const Vec3& to, const Vec3& v_from, const Vec3& v_to) {
    const Vec3 way = to - from;
    // ω = way × (v_to − v_from)/|way|²
    return rigid.add({.position = 0.5 * (from + to),
                      .orientation = exponential<double>({0, std::atan2(-way.z(), way.x()), 0}),
                      .velocity = 0.5 * (v_from + v_to),
                      .angular_velocity = way.cross(Vec3(v_to - v_from)) / way.squaredNorm(),
                      .mass = 1.0,
                      .inertia = Mat3(Vec3(1e-3, 1. / 12, 1. / 12).asDiagonal())});
  }
  void pin(const Anchor& a, RigidBodies::Handle b, const Vec3& at) {
    loop.add(Hinge::Item{a, anchor_at(rigid, b, at, across)});
  }
  Anchor on(RigidBodies::Handle body, const Vec3& at) { return anchor_at(rigid, body, at, across); }
  Vec3 end(RigidBodies::Handle body, double side) {
    return rigid.position(body) + rigid.orientation(body) * Vec3(0.5 * side, 0, 0);
  }
};

}  // namespace ladders
