/// What tendons, equalities and pairs of geoms say of themselves, and classes before them.
#pragma once

#include <delassus/adapters/mjcf/limits.hpp>

#include <array>

namespace delassus::inner::mjcf {

/// What `spatial` and `fixed` say.
struct TendonSpec {
  Limit limit;
  double stiffness = 0, damping = 0, friction_loss = 0;
  std::array<double, 2> rest{-1, -1};  ///< lengths at rest; −1: that of the pose of the file
};

inline void read(const Element& e, TendonSpec& s, Skipped& skipped) {
  read_limit(e, "", s.limit);
  read_polynomial(e, "stiffness", s.stiffness, skipped);
  read_polynomial(e, "damping", s.damping, skipped);
  e.read("frictionloss", s.friction_loss);
  if (e.read("springlength", s.rest, 1) == 1) s.rest[1] = s.rest[0];
  skip_number(e, "margin", "a limit acts where it is reached", skipped);
  skip_number(e, "armature", "the inertia of a tendon", skipped);
  skip_number(e, "actuatorfrcrange", "a bound on the sum of the actuators of a tendon", skipped);
  skip_softness(e, skipped);
}

/// What all equalities say.
struct EqualitySpec {
  bool is_active = true;
};

inline void read(const Element& e, EqualitySpec& s, Skipped& skipped) {
  e.read("active", s.is_active);
  skip_softness(e, skipped);
}

/// What `pair` says; its numbers have defaults of their own, and are not those of the two geoms.
struct PairSpec {
  int condim = 3;
  std::array<double, 5> friction{1, 1, 0.005, 0.0001, 0.0001};
};

inline void read(const Element& e, PairSpec& s, Skipped& skipped) {
  e.read("condim", s.condim);
  e.read("friction", s.friction, 1);
  skip_number(e, "margin", "contacts begin where surfaces meet", skipped);
  skip_number(e, "gap", "contacts begin where surfaces meet", skipped);
  skip_number(e, "adhesion", "surfaces do not stick", skipped);
  skip_softness(e, skipped);
}

}  // namespace delassus::inner::mjcf
