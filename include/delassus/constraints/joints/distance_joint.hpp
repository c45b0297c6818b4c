/// A distance joint: two points keep a length, rigidly or as a spring.
#pragma once

#include <delassus/constraints/joints/bilateral.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/rows/anchor.hpp>
#include <delassus/rows/soft.hpp>


namespace delassus {

/// φ = |x_a − x_b| − L, u = e · (v_a − v_b), e = (x_a − x_b)/|x_a − x_b|.
///
/// With stiffness k (N/m) or damping c (N·s/m) the row is soft: λ = −h (k (φ + h u) + c u), the spring and damper of
/// implicit Euler. Points that coincide have no direction: the row then acts along z, where it is deterministic.
struct DistanceJoint : Bilateral<1> {
  /// Two points, of bodies or of the world; without stiffness and damping the joint is rigid.
  struct Item {
    /// λ > 0 pushes it away from b.
    Anchor a{}, b{};  ///< gets −λ
    double length = 0;  ///< L ≥ 0, m
    double stiffness = 0;  ///< k ≥ 0, N/m
    double damping = 0;  ///< c ≥ 0, N·s/m
  };

  static constexpr auto refines = Bilateral<1>::refines | refine::check;

  static void check(const Item& item) {
    inner::expect_not_negative("DistanceJoint: length", item.length, "m");
    inner::expect_not_negative("DistanceJoint: stiffness", item.stiffness, "N/m");
    inner::expect_not_negative("DistanceJoint: damping", item.damping, "N·s/m");
    inner::expect_number(item.length <= 1e20, "DistanceJoint: length", item.length, "must be <= 1e20 m");
    inner::check_soft_number(item.stiffness, "DistanceJoint: stiffness", "N/m");
    inner::check_soft_number(item.damping, "DistanceJoint: damping", "N·s/m");
  }

  void linearize(const Item& item, const auto& world, auto row) const {
    const Vec3 xa = world.point(item.a), xb = world.point(item.b), span = xa - xb;
    const double distance = span.norm();
    const Vec3 e = distance > 0 ? Vec3(span / distance) : unit_axis(2);
    // Along the line of the two points every point of it gives the same row, each end's own included.
    row.end(item.a, xa).along(0, e);
    row.end(item.b, xb).along(0, -e);
    row.phi(0, distance - item.length);
    if (inner::is_spring(item.stiffness, item.damping)) row.soft(0, item.stiffness, item.damping);
  }
};

}  // namespace delassus
