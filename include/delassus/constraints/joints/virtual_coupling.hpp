/// A virtual coupling: a spring and a damper between a tool and the device that leads it, in position and orientation.
#pragma once

#include <delassus/constraints/joints/bilateral.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/math/rotation.hpp>
#include <delassus/rows/anchor.hpp>
#include <delassus/rows/soft.hpp>


namespace delassus {

/// φ = (x_a − x_b, θ), θ the vector of the turn that takes b's frame to a's. With u = (v_a − v_b, ω_a − ω_b), all in world
/// axes,
///
///   λ = −h (K (φ + h u) + C u),   K = diag(k 1, k_θ 1), C = diag(c 1, c_θ 1).
///
/// Six soft rows of compliance 1/(h² k + h c) are stable for any k, c ≥ 0 and any mass. The rows about axes take θ̇ for
/// ω_a − ω_b, true to second order in θ. Both impulses act at the middle of the two anchors.
/// Source: [ColgateStanleyBrown1995] for the coupling.
struct VirtualCoupling : Bilateral<6, 0b111000> {
  /// Both ends need an orientation.
  struct Item {
    Anchor a;                       ///< on the tool
    Anchor b;                       ///< on the device: a kinematic body, or a place in the world
    double stiffness = 500;         ///< k > 0, N/m
    double damping = 0;             ///< c ≥ 0, N·s/m
    double angular_stiffness = 1;   ///< k_θ > 0, N·m/rad
    double angular_damping = 0;     ///< c_θ ≥ 0, N·m·s/rad
  };

  static constexpr auto refines = Bilateral<6, 0b111000>::refines | refine::check;

  static void check(const Item& item) {
    DELASSUS_EXPECT(item.a.has_frame && item.b.has_frame,
                    "VirtualCoupling: both ends need an orientation; a particle has none");
    inner::expect_positive("VirtualCoupling: stiffness", item.stiffness, "N/m");
    inner::expect_not_negative("VirtualCoupling: damping", item.damping, "N·s/m");
    inner::expect_positive("VirtualCoupling: angular_stiffness", item.angular_stiffness, "N·m/rad");
    inner::expect_not_negative("VirtualCoupling: angular_damping", item.angular_damping, "N·m·s/rad");
    inner::check_soft_number(item.stiffness, "VirtualCoupling: stiffness", "N/m");
    inner::check_soft_number(item.damping, "VirtualCoupling: damping", "N·s/m");
    inner::check_soft_number(item.angular_stiffness, "VirtualCoupling: angular_stiffness", "N·m/rad");
    inner::check_soft_number(item.angular_damping, "VirtualCoupling: angular_damping", "N·m·s/rad");
  }

  void linearize(const Item& item, const auto& world, auto row) const {
    const Vec3 xa = world.point(item.a), xb = world.point(item.b), middle = 0.5 * (xa + xb);
    const Vec3 turn = logarithm<double>(world.frame(item.a) * world.frame(item.b).conjugate());
    auto a = row.end(item.a, middle), b = row.end(item.b, middle);
    a.along_axes(1);
    b.along_axes(-1);
    for (int k = 0; k < 3; ++k) {
      row.phi(k, xa[k] - xb[k]);
      row.soft(k, item.stiffness, item.damping);
      a.about(3 + k, unit_axis(k));
      b.about(3 + k, -unit_axis(k));
      row.phi(3 + k, turn[k]);
      row.soft(3 + k, item.angular_stiffness, item.angular_damping);
    }
  }
};

}  // namespace delassus
