/// A planar joint: an end moves in a plane of the other and turns about its normal.
#pragma once

#include <delassus/constraints/joints/bilateral.hpp>
#include <delassus/constraints/joints/joint_rows.hpp>

#include <array>

namespace delassus {

/// φ = (a_z · (x_a − x_b), a_y · b_z, −a_x · b_z). Three rows: b moves along a_x and a_y and turns about a_z. The impulse λ
/// is the force on a along a_z (N·s) and the moment on a about a_x and a_y (N·m·s), about x_b. Ranks are lost where those
/// of `Hinge` are.
struct Planar : Bilateral<3, 0b110> {
  static constexpr std::array<int, 3> acts{2, 3, 4};  ///< see `Reaction`

  /// Both ends need a frame.
  struct Item {
    /// a_z is normal to the plane.
    Anchor a{}, b{};  ///< moves in it
  };

  static constexpr auto refines = Bilateral<3, 0b110>::refines | refine::check;

  static void check(const Item& item) { inner::expect_frames(item, "Planar"); }

  void linearize(const Item& item, const auto& world, auto row) const {
    JointRows joint(item.a, item.b, world, row);
    joint.coincide(0, 2);
    joint.parallel(1);
  }
};

}  // namespace delassus
