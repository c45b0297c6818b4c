/// A rope with an overhand knot that its load draws tight.
#pragma once

#include "../../examples/ladders/knot.hpp"

#include <delassus/collision/with_filter.hpp>
#include <delassus/delassus.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

namespace knotted_rope {

using namespace delassus;

inline constexpr double h = 1.0 / 480;  ///< s
inline constexpr int tight = 768;       ///< steps until the knot is

/// Thirty links of 1 kg on ball joints and, as the last, one of 1000 kg.
template <class Solver>
auto rope(Solver solver) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.2}}, BallJoint{}},
                     solver, WholeViolation{}, WithFilter{NativeCollision{}}};
  constexpr int links = 30;
  constexpr double length = 0.25, radius = 0.1;
  auto line = ladders::overhand_knot(0.5 * links);
  for (Vec3& x : line) x *= 2.5 * radius;
  const auto at = ladders::equal_chords(line, length);
  auto& set = bodies<RigidBodies>(loop.world());
  Anchor end = world_anchor(at[0]);
  for (std::size_t k = 0; k + 1 < at.size(); ++k) {
    const auto link = set.add({.position = 0.5 * (at[k] + at[k + 1]),
                               .orientation = frame_along((at[k + 1] - at[k]).normalized()),
                               .mass = k + 2 < at.size() ? 1.0 : 1000.0,
                               .shape = Capsule{radius, length}});
    loop.add(BallJoint::Item{end, anchor(set, link, {0, 0, -0.5 * length})});
    end = anchor(set, link, {0, 0, 0.5 * length});
  }
  return loop;
}

/// A step in air so thick that nothing falls faster than 3 m/s.
template <class Loop>
StepReport sink(Loop& loop) {
  auto& set = bodies<RigidBodies>(loop.world());
  for (const Index b : alive(set))
    set.apply_force(set.handle(b), -3 * set.mass(b) * set.velocity(set.handle(b)));
  return loop.step(h);
}

}  // namespace knotted_rope
