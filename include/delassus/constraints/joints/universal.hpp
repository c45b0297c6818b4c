/// A universal joint: two points coincide, and an axis of one end stays perpendicular to one of the other.
#pragma once

#include <delassus/constraints/joints/bilateral.hpp>
#include <delassus/constraints/joints/joint_rows.hpp>

#include <array>

namespace delassus {

/// φ = (a_k · (x_a − x_b), a_x · b_y). Four rows: The arms of the cross are a_x, on a, and b_y, on b. The end b turns
/// freely about either, and not about a_x × b_y. Shafts along a_z and b_z turn each other; where they meet at a right
/// angle (b_z = ±a_x) the shaft a cannot turn. The impulse λ is the force on a (N·s, axes of a's frame) and its moment
/// about a_x × b_y (N·m·s) about x_b. The last row is lost only where the arms are parallel, which it forbids.
struct Universal : Bilateral<4, 0b1000> {
  static constexpr std::array<int, 4> acts{0, 1, 2, 5};  ///< see `Reaction`

  /// Both ends need a frame.
  struct Item {
    /// a_x is one arm of the cross.
    Anchor a{}, b{};  ///< b_y is the other
  };

  static constexpr auto refines = Bilateral<4, 0b1000>::refines | refine::check;

  static void check(const Item& item) { inner::expect_frames(item, "Universal"); }

  void linearize(const Item& item, const auto& world, auto row) const {
    JointRows joint(item.a, item.b, world, row);
    for (int k = 0; k < 3; ++k) joint.coincide(k, k);
    joint.perpendicular(3, 0, 1);
  }
};

}  // namespace delassus
