/// A slider: an end moves along one axis of the other and does not turn.
#pragma once

#include <delassus/constraints/joints/bilateral.hpp>
#include <delassus/constraints/joints/joint_rows.hpp>

#include <array>

namespace delassus {

/// φ = (a_x · (x_a − x_b), a_y · (x_a − x_b), ½ (a_j · b_l − a_l · b_j)). Five rows: b moves freely along a_z. The impulse λ
/// is the force on a along a_x and a_y (N·s) and the moment on a about x_b (N·m·s), in the axes of a's frame. Ranks are
/// lost where those of `Weld` are.
struct Slider : Bilateral<5, 0b11100> {
  static constexpr std::array<int, 5> acts{0, 1, 3, 4, 5};  ///< see `Reaction`

  /// Both ends need a frame.
  struct Item {
    /// Its axes are those of the rows.
    Anchor a{}, b{};  ///< moves along a_z
  };

  static constexpr auto refines = Bilateral<5, 0b11100>::refines | refine::check;

  static void check(const Item& item) { inner::expect_frames(item, "Slider"); }

  void linearize(const Item& item, const auto& world, auto row) const {
    JointRows joint(item.a, item.b, world, row);
    for (int k = 0; k < 2; ++k) joint.coincide(k, k);
    joint.alike(2);
  }
};

}  // namespace delassus
