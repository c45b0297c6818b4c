/// A spring and a damper on a free axis, for every integrator that takes joints.
#pragma once

#include <delassus/constraints/joints/bilateral.hpp>
#include <delassus/constraints/joints/coordinate.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/rows/soft.hpp>

#include <string>

namespace delassus {

/// f = −k (q − rest) − c q̇ on one coordinate: `SpringDamper<Turn>` beside a hinge, `SpringDamper<Length>` between two points. One
/// soft row. Integrators with one solve a step take it at the end of the step, stable for every k, c and h. `NewtonMidpoint` takes
/// the mean of φ and of its change, and keeps the energy of springs without dampers to rounding. A `Drive` has a cap and a
/// speed besides, and is no equality: steppers do not take it.
template <class Coordinate = inner::Absent>
struct SpringDamper : Bilateral<1, Coordinate::winds ? 1u : 0u>, OnAxis<Coordinate> {
  using Base = Bilateral<1, Coordinate::winds ? 1u : 0u>;  ///< the law of its row
  static constexpr unsigned turns = Base::turns;  ///< bit 0: the row is in rad/s

  /// One axis, where it is at rest, and how stiff it is.
  struct Item {
    /// Its z axis is the axis.
    Anchor a{}, b{};       ///< is pushed by f > 0 to larger q
    double rest = 0;       ///< q at rest, rad (over all turns) or m
    double stiffness = 0;  ///< k, N·m/rad or N/m: 0, or 1e-20 to 1e20
    double damping = 0;    ///< c, N·m·s/rad or N·s/m: 0, or 1e-20 to 1e20; one of the two > 0
    double position = 0;   ///< q at the start of the last step
  };

  static constexpr auto refines = Base::refines | refine::check | refine::follow;

  static void check(const Item& item) {
    Coordinate::check(item, "SpringDamper");
    const std::string unit = Coordinate::force_unit;
    inner::check_soft_number(item.stiffness, "SpringDamper: stiffness", (unit + (Coordinate::winds ? "/rad" : "/m")).c_str());
    inner::check_soft_number(item.damping, "SpringDamper: damping", (unit + (Coordinate::winds ? "·s/rad" : "·s/m")).c_str());
    DELASSUS_EXPECT(item.stiffness + item.damping > 0, "SpringDamper: stiffness and damping are both 0; one must be > 0");
    DELASSUS_EXPECT(std::isfinite(item.rest) && std::isfinite(item.position),
                    "SpringDamper: rest " + inner::text(item.rest) + " and position must be finite");
  }

  void linearize(const Item& item, const auto& world, auto row) const {
    JointRows joint(item.a, item.b, world, row);
    Coordinate::write(joint, 0, 1);
    row.phi(0, this->position(item, joint) - item.rest);
    row.soft(0, item.stiffness, item.damping);
  }
};

/// Of what is no coordinate of a joint; the loop's checks say so.
template <class Coordinate>
  requires(!AxisCoordinate<Coordinate>)
struct SpringDamper<Coordinate> {
  /// Read by the checks, which refuse it.
  using no_coordinate = Coordinate;
};

}  // namespace delassus
