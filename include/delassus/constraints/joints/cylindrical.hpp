/// A cylindrical joint: an end moves along one axis of the other and turns about it.
#pragma once

#include <delassus/constraints/joints/bilateral.hpp>
#include <delassus/constraints/joints/joint_rows.hpp>

#include <array>

namespace delassus {

/// φ = (a_x · (x_a − x_b), a_y · (x_a − x_b), a_y · b_z, −a_x · b_z). Four rows: b moves along a_z and turns about it.
/// The impulse λ is the force on a along a_x and a_y (N·s) and the moment on a about them (N·m·s), about x_b. Ranks are
/// lost where those of `Hinge` are.
struct Cylindrical : Bilateral<4, 0b1100> {
  static constexpr std::array<int, 4> acts{0, 1, 3, 4};  ///< see `Reaction`

  /// Both ends need a frame.
  struct Item {
    /// Its axes are those of the rows.
    Anchor a{}, b{};  ///< moves along a_z and turns about it
  };

  static constexpr auto refines = Bilateral<4, 0b1100>::refines | refine::check;

  static void check(const Item& item) { inner::expect_frames(item, "Cylindrical"); }

  void linearize(const Item& item, const auto& world, auto row) const {
    JointRows joint(item.a, item.b, world, row);
    for (int k = 0; k < 2; ++k) joint.coincide(k, k);
    joint.parallel(2);
  }
};

}  // namespace delassus
