/// A weld: two frames coincide.
#pragma once

#include <delassus/constraints/joints/bilateral.hpp>
#include <delassus/constraints/joints/joint_rows.hpp>

#include <array>

namespace delassus {

/// φ = (a_k · (x_a − x_b), ½ (a_j · b_l − a_l · b_j)), (k, j, l) cyclic. Six rows, no free axis. The impulse λ is the force
/// (N·s) and the moment (N·m·s) on a about x_b, in the axes of a's frame. The rows lose rank where b is turned by 90° or
/// 180° against a; beyond 90° they pull to the half turn.
struct Weld : Bilateral<6, 0b111000> {
  static constexpr std::array<int, 6> acts{0, 1, 2, 3, 4, 5};  ///< see `Reaction`

  /// Both ends need a frame.
  struct Item {
    /// Its axes are those of the rows.
    Anchor a{}, b{};  ///< its frame is held on that of a
  };

  static constexpr auto refines = Bilateral<6, 0b111000>::refines | refine::check;

  static void check(const Item& item) { inner::expect_frames(item, "Weld"); }

  void linearize(const Item& item, const auto& world, auto row) const {
    JointRows joint(item.a, item.b, world, row);
    for (int k = 0; k < 3; ++k) joint.coincide(k, k);
    joint.alike(3);
  }
};

}  // namespace delassus
