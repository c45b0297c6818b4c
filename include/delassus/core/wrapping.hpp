/// What a wrapper goes around, and what it is around anything else.
#pragma once

#include <delassus/core/roles.hpp>

#include <concepts>

namespace delassus::inner {

/// Inside a wrapper that was given nothing: `WithFilter{}`.
struct Absent {};

/// A wrapper around what it is not made for derives from this: it takes what it is given and has nothing
/// else, so that the loop's checks say what belongs inside, and the compiler says no more.
struct Hollow {
  constexpr Hollow(const auto&...) {}
};
/// What derives from it, or says so by `is_hollow` and is then asked for nothing else.
template <class P>
concept IsHollow = std::derived_from<P, Hollow> || requires { requires P::is_hollow; };

/// A bit for each wrapper of a role, which is there once.
namespace layer {
inline constexpr unsigned seamless = 1, meshes = 2, compounds = 8, surfaces = 16,
                          filter = 32;                     // of collision
inline constexpr unsigned deadline = 1, minimum_norm = 2, coloured = 4;  // of a solver
inline constexpr unsigned compliance = 1;                  // of a stabilisation
}  // namespace layer

/// The layers a part is made of, itself included: what says `layers`.
template <class P>
inline constexpr unsigned layers_of = 0;
template <class P>
requires requires { P::layers; }
inline constexpr unsigned layers_of<P> = P::layers;

/// A part of this role that is not yet in this layer.
template <class P, class Role, unsigned own>
concept Fills = Plays<P, Role> && !IsHollow<P> && (layers_of<P> & own) == 0;

}  // namespace delassus::inner
