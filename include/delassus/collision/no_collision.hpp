/// No collision detection.
#pragma once

#include <delassus/core/roles.hpp>

namespace delassus {

/// Bodies pass through each other. The choice of every loop without a contact law.
struct NoCollision {
  using plays = role::Collision;
};

}  // namespace delassus
