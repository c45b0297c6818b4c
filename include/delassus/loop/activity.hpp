/// Which islands take part in a step.
#pragma once

#include <delassus/core/roles.hpp>

namespace delassus {

/// All of them, always: no list, no test.
struct AllActive {
  using plays = role::Activity;
};

/// An activity with dormant bodies says so, and has `template <class World, class Laws> using State`, whose functions the
/// stages call: begin, add_obstacles, wake_touched, drop_points, watch, settle (see `Sleepers`).
template <class A>
inline constexpr bool has_dormant = requires { requires A::has_dormant; };

}  // namespace delassus
