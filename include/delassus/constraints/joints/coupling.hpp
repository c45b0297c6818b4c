/// A coupling: the coordinates of two joints keep a ratio. Gears, and a rack on its wheel.
#pragma once

#include <delassus/constraints/joints/bilateral.hpp>
#include <delassus/constraints/joints/coordinate.hpp>
#include <delassus/core/cmath.hpp>

#include <limits>

namespace delassus {

/// The phase of a coupling is what it is in the pose of the first step.
inline constexpr double from_pose = std::numeric_limits<double>::quiet_NaN();

/// φ = q_a − ratio q_b − phase. (The `First` coordinate of a against its carrier c is q_a, the `Second` of b against its
/// carrier d is q_b.) One row, turns counted over all of them, so that nothing adds up. Mostly c and d are points of one
/// housing, or of the world. The impulse λ is the force or moment on a along its axis (N·s, N·m·s), and −ratio λ acts on
/// b. The carriers take the opposite of each, so that momentum and angular momentum of free bodies stay. The joints that
/// leave a and b these coordinates are added beside it. Singular where the coordinates are.
template <class First = inner::Absent, class Second = inner::Absent>
struct Coupling : Bilateral<1, First::winds ? 1u : 0u> {
  /// Two coordinates and their ratio.
  struct Item {
    /// What moves by q_a.
    Anchor a{}, b{};               ///< what moves by q_b
    /// What a moves against; its z axis is the axis of q_a.
    Anchor c, d;               ///< what b moves against, likewise
    double ratio = 1;          ///< of q_a to q_b
    double phase = from_pose;  ///< rad or m
    /// q_a at the start of the last step, over all turns.
    double position_a = 0, position_b = 0;  ///< q_b, likewise
  };

  static constexpr auto refines = Bilateral<1>::refines | refine::check | refine::follow;

  static void check(const Item& item) {
    First::check(Pair{item.c, item.a}, "Coupling, first joint");
    Second::check(Pair{item.d, item.b}, "Coupling, second joint");
    DELASSUS_EXPECT(
        std::isfinite(item.ratio) && std::isfinite(item.position_a) && std::isfinite(item.position_b),
        "Coupling: ratio " + inner::text(item.ratio) + " and positions must be finite");
  }

  void follow(Item& item, const auto& world) const {
    item.position_a = inner::unwound<First>(First::value({item.c, item.a, world}), item.position_a);
    item.position_b = inner::unwound<Second>(Second::value({item.d, item.b, world}), item.position_b);
    if (std::isnan(item.phase)) item.phase = item.position_a - item.ratio * item.position_b;
  }

  void linearize(const Item& item, const auto& world, auto row) const {
    JointRows first(item.c, item.a, world, row), second(item.d, item.b, world, row);
    First::write(first, 0, 1);
    Second::write(second, 0, -item.ratio);
    const double qa = inner::unwound<First>(First::value(first), item.position_a),
                 qb = inner::unwound<Second>(Second::value(second), item.position_b);
    row.phi(0, qa - item.ratio * qb - item.phase);
  }

 private:
  struct Pair {
    const Anchor &a, &b;
  };
};

/// Of what is no coordinate of a joint; the loop's checks say so.
template <class First, class Second>
  requires(!AxisCoordinate<First> || !AxisCoordinate<Second>)
struct Coupling<First, Second> {
  /// Read by the checks, which refuse it.
  using no_coordinate = First;
};

/// θ_a = ratio θ_b + phase; two wheels that mesh outside each other have the ratio −(teeth of b)/(teeth of
/// a).
using Gear = Coupling<Turn, Turn>;
/// s_a = ratio θ_b + phase: the bar a on the wheel b, ratio the wheel's radius (m), its sign that of the
/// side.
using Rack = Coupling<Slide, Turn>;

}  // namespace delassus
