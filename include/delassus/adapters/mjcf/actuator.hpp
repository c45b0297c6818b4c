/// Actuators: what they say, and the law of force that it comes to.
#pragma once

#include <delassus/adapters/mjcf/limits.hpp>
#include <delassus/model/model.hpp>

#include <array>
#include <string>

namespace delassus::inner::mjcf {

enum class Dynamics { none, integrator, filter, filter_exact, muscle, other };
enum class Gain { fixed, affine, muscle, other };
enum class Bias { none, affine, muscle, other };

/// What an actuator of any name says: each name is a way to set these.
struct ActuatorSpec {
  std::array<double, 6> gear{1, 0, 0, 0, 0, 0};
  Limit control, force, activation;
  Dynamics dynamics = Dynamics::none;
  Gain gain_kind = Gain::fixed;
  Bias bias_kind = Bias::none;
  std::array<double, 10> dynamics_numbers{1}, gain{1}, bias{};
  double inherit_range = 0;
};

/// kp and kv of a servo, of which the force is kp (control − l) − kv l̇.
inline void read_servo(const Element& e, ActuatorSpec& s, Skipped& skipped) {
  double kp = s.gain[0], kv = -s.bias[2];
  e.read("kp", kp);
  if (e.read("kv", kv)) expect_not_below_zero(e, "kv", kv);
  s.gain[0] = kp;
  s.bias[1] = -kp;
  s.bias[2] = -kv;
  if (e.has("dampratio")) {
    if (e.has("kv")) e.refuse("kv and dampratio are both given; give one");
    skip_number(e, "dampratio", "give kv instead, which needs no mass to be known", skipped);
  }
  if (double time = 0; e.read("timeconst", time)) {
    expect_not_below_zero(e, "timeconst", time);
    s.dynamics_numbers[0] = time;
    s.dynamics = time > 0 ? Dynamics::filter_exact : Dynamics::none;
  }
  e.read("inheritrange", s.inherit_range);
  s.gain_kind = Gain::fixed;
  s.bias_kind = Bias::affine;
}

/// What the name of the actuator sets.
inline void read_kind(const Element& e, ActuatorSpec& s, Skipped& skipped) {
  const std::string_view kind = e.name();
  const auto set = [&](Dynamics dynamics, Gain gain, Bias bias) {
    s.dynamics = dynamics;
    s.gain_kind = gain;
    s.bias_kind = bias;
  };
  if (kind == "motor") {
    s.gain[0] = 1;
    set(Dynamics::none, Gain::fixed, Bias::none);
  } else if (kind == "position") {
    read_servo(e, s, skipped);
  } else if (kind == "intvelocity") {
    read_servo(e, s, skipped);
    s.dynamics = Dynamics::integrator;
  } else if (kind == "velocity") {
    double kv = s.gain[0];
    e.read("kv", kv);
    s.bias = {0, 0, -kv};
    s.gain[0] = kv;
    set(Dynamics::none, Gain::fixed, Bias::affine);
  } else if (kind == "damper") {
    double kv = s.gain_kind == Gain::affine ? -s.gain[2] : 0;
    e.read("kv", kv);
    s.gain = {0, 0, -kv};
    s.control.is_on = 1;
    set(Dynamics::none, Gain::affine, Bias::none);
  } else if (kind == "cylinder") {
    e.read("timeconst", s.dynamics_numbers[0]);
    e.read("bias", std::span(s.bias).first(3), 3);
    e.read("area", s.gain[0]);
    if (double d = 0; e.read("diameter", d)) s.gain[0] = 3.14159265358979323846 / 4 * d * d;
    set(Dynamics::filter, Gain::fixed, Bias::affine);
  } else if (kind == "muscle") {
    set(Dynamics::muscle, Gain::muscle, Bias::muscle);
  } else if (kind != "general") {  // adhesion, orientation, pid, dcmotor, plugin
    set(Dynamics::other, Gain::other, Bias::other);
  }
}

inline void read(const Element& e, ActuatorSpec& s, Skipped& skipped) {
  e.read("gear", s.gear, 1);
  read_limit(e, "ctrl", s.control);
  read_limit(e, "force", s.force);
  read_limit(e, "act", s.activation);
  if (const int k = e.choice(
          "dyntype", {"none", "integrator", "filter", "filterexact", "muscle", "dcmotor", "pid", "user"});
      k >= 0)
    s.dynamics = Dynamics(std::min(k, 5));
  if (const int k = e.choice("gaintype", {"fixed", "affine", "muscle", "dcmotor", "so3", "pid", "user"});
      k >= 0)
    s.gain_kind = Gain(std::min(k, 3));
  if (const int k = e.choice("biastype", {"none", "affine", "muscle", "dcmotor", "so3", "user"}); k >= 0)
    s.bias_kind = Bias(std::min(k, 3));
  e.read("dynprm", s.dynamics_numbers, 1);
  e.read("gainprm", s.gain, 1);
  e.read("biasprm", s.bias, 1);
  read_kind(e, s, skipped);
  for (const char* attribute : {"delay", "damping", "armature"})
    skip_number(e, attribute, "not of an actuator; give it to the joint", skipped);
  bool is_early = false;
  if (e.read("actearly", is_early) && is_early)
    skipped.add(e, "actearly: the force follows the filter as it was");
}

/// Why the law of force is none that `Model` has; empty where it is.
inline std::string beyond_model(const ActuatorSpec& s) {
  using enum Dynamics;
  if (s.dynamics == muscle || s.gain_kind == Gain::muscle || s.bias_kind == Bias::muscle)
    return "it is a muscle";
  if (s.dynamics == integrator) return "its activation is the integral of the control";
  if (s.dynamics == other || s.gain_kind == Gain::other || s.bias_kind == Bias::other)
    return "its law of force is not fixed gain and affine bias";
  if (s.gain_kind == Gain::affine && (s.gain[1] != 0 || s.gain[2] != 0))
    return "its gain depends on length or rate";
  return {};
}

/// The law of force, without a name and what it acts on.
inline model::Actuator make_actuator(const Element& e, const ActuatorSpec& s, const Compiler& c) {
  model::Actuator a{.gear = s.gear, .gain = s.gain[0]};
  if (s.bias_kind == Bias::affine) a.bias = {s.bias[0], s.bias[1], s.bias[2]};
  if (s.dynamics == Dynamics::filter || s.dynamics == Dynamics::filter_exact) {
    a.time_constant = s.dynamics_numbers[0];
    if (!(a.time_constant > 0))
      e.refuse("the time constant of the filter, " + text(a.time_constant) + " s, must be > 0");
  }
  if ((a.control_is_limited = holds(e, c, s.control, "ctrl"))) {
    a.control_lower = s.control.range[0];
    a.control_upper = s.control.range[1];
  }
  if ((a.force_is_limited = holds(e, c, s.force, "force"))) {
    a.force_lower = s.force.range[0];
    a.force_upper = s.force.range[1];
  }
  return a;
}

}  // namespace delassus::inner::mjcf
