/// A drive: a free axis is drawn to a position by a spring and a damper whose force may have a cap.
#pragma once

#include <delassus/constraints/joints/bounded.hpp>
#include <delassus/constraints/joints/coordinate.hpp>

#include <limits>

namespace delassus {

/// λ = −h (k (q + h u − q* − h s) + c (u − s)), |λ| ≤ h max_force. That is implicit Euler of a spring and a damper,
/// stable for every k (N·m/rad or N/m), c (N·m·s/rad or N·s/m) and h. The target q* is that of the start of the step and
/// moves at s = `speed`. Without a cap and with speed 0 it is a spring: `Drive<Turn>` beside a hinge, `Drive<Slide>`
/// beside a slider.
template <class Coordinate = inner::Absent>
struct Drive : Bounded, OnAxis<Coordinate> {
  /// One axis, where it shall be, and how hard it is drawn there.
  struct Item {
    /// Its z axis is the axis.
    Anchor a{}, b{};  ///< is driven by λ > 0 to larger q
    double target = 0;                                           ///< q*, rad (over all turns) or m
    double stiffness = 0;                                        ///< k ≥ 0; one of k and c > 0
    double damping = 0;                                          ///< c ≥ 0
    double max_force = std::numeric_limits<double>::infinity();  ///< N·m or N
    double speed = 0;                                            ///< of the target, rad/s or m/s
    double position = 0;                                         ///< q at the start of the last step
  };

  static constexpr auto refines = Bounded::refines | refine::check | refine::follow | refine::speed;

  static void check(const Item& item) {
    Coordinate::check(item, "Drive");
    const auto is_gain = [](double x) { return std::isfinite(x) && x >= 0; };
    DELASSUS_EXPECT(is_gain(item.stiffness) && is_gain(item.damping) && item.stiffness + item.damping > 0,
                    "Drive: stiffness " + inner::text(item.stiffness) + " and damping " +
                        inner::text(item.damping) + " must be finite and >= 0, and one of them > 0");
    DELASSUS_EXPECT(std::isfinite(item.target) && std::isfinite(item.speed) && std::isfinite(item.position),
                    "Drive: target " + inner::text(item.target) + ", speed and position must be finite");
    check_cap(item.max_force, "Drive", Coordinate::force_unit);
  }

  double speed(const Item& item) const { return item.speed; }

  void linearize(const Item& item, const auto& world, auto row) const {
    JointRows joint(item.a, item.b, world, row);
    Coordinate::write(joint, 0, 1);
    row.phi(0, this->position(item, joint) - item.target);
    row.soft(0, item.stiffness, item.damping);
  }
};

/// Of what is no coordinate of a joint; the loop's checks say so.
template <class Coordinate>
  requires(!AxisCoordinate<Coordinate>)
struct Drive<Coordinate> {
  /// Read by the checks, which refuse it.
  using no_coordinate = Coordinate;
};

}  // namespace delassus
