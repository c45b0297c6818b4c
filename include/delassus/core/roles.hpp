/// The parts an AnimationLoop is made of: each policy says which one it plays.
#pragma once

#include <concepts>

namespace delassus {

/// A policy declares `using plays = role::Solver;`. The tags carry no data and no base class.
namespace role {
struct World;
struct Constraints;
struct Integrator;
struct Collision;
struct Compliance;
struct Solver;
struct Stabilisation;
struct Scheme;
struct Activity;
struct Execution;
struct Listener;
}  // namespace role

template <class P, class Role>
concept Plays = std::same_as<typename P::plays, Role>;

}  // namespace delassus
