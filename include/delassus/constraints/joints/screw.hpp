/// A screw: an end turns about an axis of the other and moves along it in one ratio.
#pragma once

#include <delassus/constraints/joints/bilateral.hpp>
#include <delassus/constraints/joints/coordinate.hpp>
#include <delassus/core/cmath.hpp>

#include <numbers>

namespace delassus {

/// φ = (a_x · (x_a − x_b), a_y · (x_a − x_b), a_y · b_z, −a_x · b_z, s − p θ/2π − phase). These are the rows of
/// `Cylindrical`, and one more. It couples s, how far b is along a_z, with θ, its turn about it over all turns. A pitch
/// p > 0 is a right-handed thread. The impulse λ_4 pushes b along a_z with as many N·s and turns it back with p/2π of it
/// (N·m·s). Ranks are lost where those of `Hinge` are.
struct Screw : Bilateral<5, 0b01100> {
  /// Both ends need a frame.
  struct Item {
    /// a_z is the axis.
    Anchor a{}, b{};  ///< turns about it and moves along it
    double pitch = 1e-3;  ///< p, m a turn
    double phase = 0;     ///< s where θ is 0, m
    double position = 0;  ///< θ at the start of the last step, rad over all turns
  };

  static constexpr auto refines = Bilateral<5, 0b01100>::refines | refine::check | refine::follow;

  static void check(const Item& item) {
    inner::expect_frames(item, "Screw");
    DELASSUS_EXPECT(std::isfinite(item.pitch) && std::isfinite(item.phase) && std::isfinite(item.position),
                    "Screw: pitch " + inner::text(item.pitch) + " m, phase and position must be finite");
  }

  void follow(Item& item, const auto& world) const { OnAxis<Turn>().follow(item, world); }

  void linearize(const Item& item, const auto& world, auto row) const {
    JointRows joint(item.a, item.b, world, row);
    const double lead = item.pitch / (2 * std::numbers::pi);
    for (int k = 0; k < 2; ++k) joint.coincide(k, k);
    joint.parallel(2);
    Slide::write(joint, 4, 1);
    Turn::write(joint, 4, -lead);
    row.phi(4, Slide::value(joint) - lead * OnAxis<Turn>::position(item, joint) - item.phase);
  }
};

}  // namespace delassus
