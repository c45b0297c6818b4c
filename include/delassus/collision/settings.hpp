/// How early a pair is noticed, and how many points it gets, in the user's numbers.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>

#include <string>

namespace delassus {

/// `margin`: contacts are made up to this gap, m; negative means automatic, max(5e-3 L, |vₙ| h), at most L/2,
/// with L the smaller size of the pair. `contact_distance`: thickness of every pair, m; the gap is what is
/// left beyond it.
struct CollisionSettings {
  double margin = -1;  ///< m; negative: automatic
  double contact_distance = 0;  ///< m, at least 0
  int max_points = 4;  ///< of one pair, at most 8

  void check(const char* who) const {
    const auto refuse = [&](const std::string& sentence) { inner::refuse(std::string(who) + ": " + sentence); };
    if (!std::isfinite(margin)) refuse("margin " + inner::text(margin) + " m must be finite");
    if (!(std::isfinite(contact_distance) && contact_distance >= 0))
      refuse("contact_distance " + inner::text(contact_distance) + " m must be finite and >= 0");
    if (max_points < 1 || max_points > 8) refuse("max_points " + inner::text(max_points) + " must be in [1, 8]");
  }
};

}  // namespace delassus
