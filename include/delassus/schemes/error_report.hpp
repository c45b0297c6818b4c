/// What `ErrorControlled` says of a step.
#pragma once

#include <delassus/core/index.hpp>

#include <array>

namespace delassus {

/// What an error is made by.
enum class ErrorEffect : unsigned char {
  motion,   ///< flight and spin, and forces that nothing stops
  joint,    ///< a body that a joint holds
  contact,  ///< something pushes all along: it slides, sticks or rolls
  impact,   ///< something begins to push
};

/// As the enumerator is written.
constexpr const char* name(ErrorEffect effect) {
  constexpr const char* names[] = {"motion", "joint", "contact", "impact"};
  return unsigned(effect) < 4 ? names[unsigned(effect)] : "unknown";
}

/// The inner steps whose largest error one effect made.
struct EffectSteps {
  long steps = 0;         ///< accepted
  long rejections = 0;    ///< tried in vain
  double least_step = 0;           ///< s, of the accepted ones; 0 where there is none
};

/// Of one step of the host.
struct ErrorReport {
  long steps = 0;       ///< inner steps that were accepted, each of two halves
  long rejections = 0;  ///< trials that were not
  long measurements = 0;  ///< trials that took two quarters more, to measure the order of an arc in contact
  long at_floor = 0;    ///< steps of `min_step` that were accepted with a larger error than asked
  double error = 0;     ///< the largest estimate of an accepted step, in the unit of `accuracy`
  double least_step = 0;  ///< of the accepted ones, s
  double last_step = 0;   ///< s
  Index set = -1;         ///< of the body with that largest error; -1: none
  Index block = -1;       ///< its place in that set
  ErrorEffect effect = ErrorEffect::motion;  ///< what made it
  std::array<EffectSteps, 4> by_effect{};    ///< in the order of `ErrorEffect`
};

}  // namespace delassus
