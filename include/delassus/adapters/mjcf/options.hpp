/// What `option` and its flags ask for.
#pragma once

#include <delassus/adapters/mjcf/reading.hpp>

#include <array>
#include <string>

namespace delassus::inner::mjcf {

/// Flags that leave a kind of force out of the model.
struct Flags {
  bool equality = true, friction_loss = true, limit = true, spring = true, damper = true, gravity = true;
  bool clamps_controls = true;
};

inline void read_flags(const Element& e, Flags& flags, Model& model, Skipped& skipped) {
  const auto read = [&](const char* name, bool& to) {
    const int k = e.choice(name, {"disable", "enable"});
    if (k >= 0) to = k == 1;
    return k;
  };
  if (bool all = true; read("constraint", all) >= 0 && !all)
    flags.equality = flags.friction_loss = flags.limit = model.contacts = false;
  if (bool passive = true; read("passive", passive) >= 0 && !passive) flags.spring = flags.damper = false;
  read("equality", flags.equality);
  read("frictionloss", flags.friction_loss);
  read("limit", flags.limit);
  read("contact", model.contacts);
  read("spring", flags.spring);
  read("damper", flags.damper);
  read("gravity", flags.gravity);
  read("clampctrl", flags.clamps_controls);
  if (bool filters = true; read("filterparent", filters) >= 0) model.parents_collide = !filters;
  if (bool acts = true; read("actuation", acts) >= 0 && !acts)
    skipped.add(e, "actuation: actuators are read all the same");
  if (bool overrides = false; read("override", overrides) >= 0 && overrides)
    skipped.add(e, "override: contacts keep the numbers of their geoms");
}

inline void read_option(const Document& document, const Element& e, Flags& flags, Model& model,
                        Skipped& skipped) {
  if (e.read("timestep", model.time_step) && !(model.time_step > 0)) e.refuse("timestep must be > 0");
  e.read("gravity", model.gravity);
  for (const char* fluid : {"density", "viscosity"}) skip_number(e, fluid, "there is no fluid", skipped);
  skip_number(e, "wind", "there is no fluid", skipped);
  document.for_each(e, [&](const Element& child) {
    if (child.name() == "flag") read_flags(child, flags, model, skipped);
  });
}

/// Takes out of the model what the flags leave out.
inline void apply(const Flags& flags, Model& model) {
  if (!flags.gravity) set_zero(model.gravity);
  if (!flags.equality) {
    model.couplings.clear();
    model.connects.clear();
    model.welds.clear();
  }
  const auto clear = [&](auto& with) {
    if (!flags.limit) with.is_limited = false;
    if (!flags.friction_loss) with.friction_loss = 0;
    if (!flags.spring) with.stiffness = 0;
    if (!flags.damper) with.damping = 0;
  };
  for (model::Joint& j : model.joints) clear(j);
  for (model::Tendon& t : model.tendons) clear(t);
  if (!flags.clamps_controls)
    for (model::Actuator& a : model.actuators) a.control_is_limited = false;
}

}  // namespace delassus::inner::mjcf
