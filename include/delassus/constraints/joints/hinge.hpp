/// A hinge: two points and one axis of each end coincide.
#pragma once

#include <delassus/constraints/joints/bilateral.hpp>
#include <delassus/constraints/joints/joint_rows.hpp>

#include <array>

namespace delassus {

/// φ = (a_k · (x_a − x_b), a_y · b_z, −a_x · b_z). Five rows: b turns freely about the z axis of the frames. The impulse λ
/// is the force on a (N·s, axes of a's frame) and its moment about a_x and a_y (N·m·s) about x_b. A row is lost where b_z
/// lies in the plane of a_x and a_y. The pose b_z = −a_z meets the rows as well, and beyond 90° they pull there.
struct Hinge : Bilateral<5, 0b11000> {
  static constexpr std::array<int, 5> acts{0, 1, 2, 3, 4};  ///< see `Reaction`

  /// Both ends need a frame.
  struct Item {
    /// Its axes are those of the rows.
    Anchor a{}, b{};  ///< turns about a_z
  };

  static constexpr auto refines = Bilateral<5, 0b11000>::refines | refine::check;

  static void check(const Item& item) { inner::expect_frames(item, "Hinge"); }

  void linearize(const Item& item, const auto& world, auto row) const {
    JointRows joint(item.a, item.b, world, row);
    for (int k = 0; k < 3; ++k) joint.coincide(k, k);
    joint.parallel(3);
  }
};

}  // namespace delassus
