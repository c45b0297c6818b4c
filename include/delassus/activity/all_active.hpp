/// The default activity: every island takes part in every step.
#pragma once

#include <delassus/core/roles.hpp>

namespace delassus {

/// All of them, always: no list, no test.
struct AllActive {
  using plays = role::Activity;
};

}  // namespace delassus
