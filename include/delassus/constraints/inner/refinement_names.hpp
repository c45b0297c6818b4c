/// The refinements whose names a law's functions have, declared or not.
#pragma once

#include <delassus/constraints/law.hpp>

#include <type_traits>

namespace delassus::inner {

/// Members with these names. A name that a class inherits twice is ambiguous, whatever overloads and templates it has.
struct NamesOfRefinements {
  int prepare, clamp, natural_map, natural_squares, tangent, convex_tangent, is_sliding, check, speed, follow, breaks, restitution,
      set_friction, set_restitution, soften, projection_step;
};
template <class L>
struct BesideNames : std::conditional_t<std::is_final_v<L>, NoMemory, L>, NamesOfRefinements {};

/// A pointer to data: a number of the law may have such a name.
template <class P>
concept PointsToData = std::is_member_object_pointer_v<P> || (std::is_pointer_v<P> && std::is_object_v<std::remove_pointer_t<P>>);

/// Of a law that is final, none.
template <class L, class B = BesideNames<L>>
consteval unsigned named_refinements() {
  unsigned absent = 0;
  if (requires { &B::prepare; } || requires { requires PointsToData<decltype(&L::prepare)>; }) absent |= refine::prepare;
  if (requires { &B::clamp; } || requires { requires PointsToData<decltype(&L::clamp)>; }) absent |= refine::clamp;
  if (requires { &B::natural_map; } || requires { requires PointsToData<decltype(&L::natural_map)>; }) absent |= refine::natural_map;
  if (requires { &B::natural_squares; } || requires { requires PointsToData<decltype(&L::natural_squares)>; }) absent |= refine::natural_squares;
  if (requires { &B::tangent; } || requires { requires PointsToData<decltype(&L::tangent)>; }) absent |= refine::tangent;
  if (requires { &B::convex_tangent; } || requires { requires PointsToData<decltype(&L::convex_tangent)>; }) absent |= refine::convex_tangent;
  if (requires { &B::is_sliding; } || requires { requires PointsToData<decltype(&L::is_sliding)>; }) absent |= refine::is_sliding;
  if (requires { &B::check; } || requires { requires PointsToData<decltype(&L::check)>; }) absent |= refine::check;
  if (requires { &B::speed; } || requires { requires PointsToData<decltype(&L::speed)>; }) absent |= refine::speed;
  if (requires { &B::follow; } || requires { requires PointsToData<decltype(&L::follow)>; }) absent |= refine::follow;
  if (requires { &B::breaks; } || requires { requires PointsToData<decltype(&L::breaks)>; }) absent |= refine::breaks;
  if (requires { &B::restitution; } || requires { requires PointsToData<decltype(&L::restitution)>; }) absent |= refine::restitution;
  if (requires { &B::set_friction; } || requires { requires PointsToData<decltype(&L::set_friction)>; }) absent |= refine::set_friction;
  if (requires { &B::set_restitution; } || requires { requires PointsToData<decltype(&L::set_restitution)>; }) absent |= refine::set_restitution;
  if (requires { &B::soften; } || requires { requires PointsToData<decltype(&L::soften)>; }) absent |= refine::soften;
  if (requires { &B::projection_step; } || requires { requires PointsToData<decltype(&L::projection_step)>; }) absent |= refine::projection_step;
  return ~absent;
}

}  // namespace delassus::inner
