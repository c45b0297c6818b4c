/// A point on a line: a point of one end stays on an axis of the other.
#pragma once

#include <delassus/constraints/joints/bilateral.hpp>
#include <delassus/constraints/joints/joint_rows.hpp>

#include <array>

namespace delassus {

/// φ = (a_x · (x_a − x_b), a_y · (x_a − x_b)). Two rows: x_b is free along a_z and b turns as it likes, so that b may be a
/// particle. The impulse λ is the force on a along a_x and a_y (N·s), which acts at x_b. No pose is singular.
struct PointOnLine : Bilateral<2> {
  static constexpr std::array<int, 2> acts{0, 1};  ///< see `Reaction`

  /// The first end needs a frame.
  struct Item {
    /// a_z is the line.
    Anchor a{}, b{};  ///< the point on it
  };

  static constexpr auto refines = Bilateral<2>::refines | refine::check;

  static void check(const Item& item) { inner::expect_frame(item.a, "PointOnLine", "first"); }

  void linearize(const Item& item, const auto& world, auto row) const {
    JointRows joint(item.a, item.b, world, row);
    for (int k = 0; k < 2; ++k) joint.coincide(k, k);
  }
};

}  // namespace delassus
