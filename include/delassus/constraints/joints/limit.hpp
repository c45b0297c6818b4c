/// Limits of a free axis: stops that push back and never hold on.
#pragma once

#include <delassus/constraints/joints/coordinate.hpp>
#include <delassus/constraints/joints/stops.hpp>
#include <delassus/constraints/law.hpp>
#include <delassus/constraints/newton_impact.hpp>
#include <delassus/core/cmath.hpp>

#include <limits>

namespace delassus {

/// q − lower ≥ 0 ⟂ λ_0 ≥ 0 and q − upper ≤ 0 ⟂ λ_1 ≤ 0 for q = `Turn`, `Slide` or `Length`: `Limit<Turn>` on a
/// hinge, `Limit<Slide>` on a slider, `Limit<Length>` for a string. At most one acts, so that the two are solved exactly. An open stop lets the axis come to it
/// within the step and no further. With e = 0 the stop takes the speed away, with e > 0 it gives the share e of it back.
///
/// A bound has a row only while it is nearer than `margin` (1 rad, 0.05 m) plus twice the way of the last step. One that is
/// far costs nothing and does not weigh in the residual. Something that is hit and goes further than that in its first step
/// passes the stop by that step's way, and is pushed back as from an overlap.
template <class Coordinate = inner::Absent>
struct Limit : inner::Stops, OnAxis<Coordinate> {
  static constexpr auto refines = inner::Stops::refines | refine::check | refine::follow | refine::restitution;
  using overrides = Overrides<NewtonImpact>;

  /// One axis and its stops.
  struct Item {
    /// Its z axis is the axis.
    Anchor a{}, b{};  ///< is pushed by λ > 0 to larger q
    double lower = -std::numeric_limits<double>::infinity();  ///< rad or m
    double upper = std::numeric_limits<double>::infinity();  ///< rad or m, at least `lower`
    double restitution = 0;  ///< e in [0, 1]
    double margin = Coordinate::limit_margin;  ///< rad or m
    double position = 0;     ///< q at the start of the last step
    double way = 0;          ///< what the last step that moved it added to it
  };

  static void check(const Item& item) {
    Coordinate::check(item, "Limit");
    DELASSUS_EXPECT(item.lower <= item.upper, "Limit: lower " + inner::text(item.lower) +
                                                  " must be <= upper " + inner::text(item.upper));
    inner::expect_zero_to_one("Limit: restitution", item.restitution);
    inner::expect_number(item.margin >= 0 && std::isfinite(item.position), "Limit: margin", item.margin,
                         "must be >= 0 and position finite");
  }

  void follow(Item& item, const auto& world) const {
    const double before = item.position;
    OnAxis<Coordinate>::follow(item, world);
    if (item.position != before) item.way = item.position - before;  // else it is looked at again in one place
  }

  void linearize(const Item& item, const auto& world, auto row) const {
    const double reach = item.margin + 2 * std::abs(item.way);
    const double low = item.position - item.lower, high = item.position - item.upper;
    if (!(low < reach) && !(high > -reach)) return;
    JointRows joint(item.a, item.b, world, row);
    const double moved = this->position(item, joint) - item.position;
    if (low < reach) Coordinate::write(joint, 0, 1), row.phi(0, low + moved);
    if (high > -reach) Coordinate::write(joint, 1, 1), row.phi(1, high + moved);
  }

  double restitution(const Item& item) const { return item.restitution; }
};

/// Of what is no coordinate of a joint; the loop's checks say so.
template <class Coordinate>
  requires(!AxisCoordinate<Coordinate>)
struct Limit<Coordinate> {
  /// Read by the checks, which refuse it.
  using no_coordinate = Coordinate;
};

}  // namespace delassus
