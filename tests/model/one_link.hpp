/// A link on a hinge about y through its centre, for tests of what drives it.
#pragma once

#include <delassus/delassus.hpp>
#include <delassus/model/actuators.hpp>
#include <delassus/model/add.hpp>

#include <array>
#include <string>

namespace delassus {

/// 2 kg and 0.2 kg·m², with a site at 0.5 m on x.
inline Model one_link() {
  Model model{};
  model.name = "arm";
  model::Joint joint;
  joint.name = "hinge", joint.axis = {0, 1, 0};
  model.joints = {joint};
  model::Body body;
  body.name = "link", body.mass = 2, body.inertia = Vec3(0.2, 0.2, 0.2).asDiagonal(), body.joints = {0};
  model.bodies = {body};
  model::Site site;
  site.name = "hand", site.body = 0, site.pose.position = {0.5, 0, 0};
  model.sites = {site};
  return model;
}
/// With one actuator on the hinge.
inline Model one_link(double gain, std::array<double, 3> bias = {0, 0, 0}, double time_constant = 0) {
  Model model = one_link();
  model::Actuator actuator;
  actuator.name = "motor", actuator.target = 0, actuator.gain = gain, actuator.bias = bias,
  actuator.time_constant = time_constant;
  model.actuators = {actuator};
  return model;
}

/// Without gravity.
template <class Loop>
RigidBodies& weightless(Loop& loop) {
  auto& set = bodies<RigidBodies>(loop.world());
  set.gravity = zero<Vec3>();
  return set;
}

}  // namespace delassus
