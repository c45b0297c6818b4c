/// A motor: a free axis is brought to a speed by a force that has a cap; with speed 0, dry friction in the
/// joint.
#pragma once

#include <delassus/constraints/joints/bounded.hpp>
#include <delassus/constraints/joints/coordinate.hpp>

#include <limits>

namespace delassus {

/// q̇ = speed at the end of the step where |f| ≤ max_force allows it, else the whole force towards it. q =
/// `Turn` or `Slide`: `Motor<Turn>` beside a hinge. Speed 0 is dry friction of that moment or force, which
/// holds what is below its cap.
template <class Coordinate = inner::Absent>
struct Motor : Bounded, OnAxis<Coordinate> {
  /// One axis, its speed, and how strong it is.
  struct Item {
    /// Its z axis is the axis.
    Anchor a{}, b{};  ///< is pushed by λ > 0 to larger q
    double speed = 0;                                            ///< rad/s or m/s
    double max_force = std::numeric_limits<double>::infinity();  ///< N·m or N
    double position = 0;  ///< of the axis at the start of the last step, rad over all turns or m
  };

  static constexpr auto refines = Bounded::refines | refine::check | refine::follow | refine::speed;

  static void check(const Item& item) {
    Coordinate::check(item, "Motor");
    DELASSUS_EXPECT(std::isfinite(item.speed) && std::isfinite(item.position),
                    "Motor: speed " + inner::text(item.speed) + " and position must be finite");
    check_cap(item.max_force, "Motor", Coordinate::force_unit);
  }

  double speed(const Item& item) const { return item.speed; }

  void linearize(const Item& item, const auto& world, auto row) const {
    JointRows joint(item.a, item.b, world, row);
    Coordinate::write(joint, 0, 1);
  }
};

/// Of what is no coordinate of a joint; the loop's checks say so.
template <class Coordinate>
  requires(!AxisCoordinate<Coordinate>)
struct Motor<Coordinate> {
  /// Read by the checks, which refuse it.
  using no_coordinate = Coordinate;
};

}  // namespace delassus
