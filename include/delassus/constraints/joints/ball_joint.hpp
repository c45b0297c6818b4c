/// A ball joint: two points coincide.
#pragma once

#include <delassus/constraints/joints/bilateral.hpp>
#include <delassus/rows/anchor.hpp>

#include <array>

namespace delassus {

/// φ = x_a − x_b (m, world axes), u = v_a − v_b. Both impulses act at one point, so that they have no moment. That is
/// where the end without a frame is, a particle that can only be pushed at its centre; else the middle of the two anchors.
/// Two particles apart have no such point; their moment is φ × λ.
struct BallJoint : Bilateral<3> {
  static constexpr std::array<int, 3> acts{0, 1, 2};  ///< see `Reaction`

  /// Two points, of bodies or of the world.
  struct Item {
    /// λ is the impulse on it.
    Anchor a{}, b{};  ///< one that is not given is the world's origin
  };

  using holds_point = BallJoint;  ///< `place` says it all

  /// The point at which both impulses act, and x_a − x_b, m: all there is to know of the joint in a step.
  struct Place {
    /// Where both impulses act, m, world.
    Vec3 point, gap;  ///< x_a − x_b, m, world
  };
  /// In the poses that `world` shows.
  static Place place(const Item& item, const auto& world) {
    const Vec3 xa = world.point(item.a), xb = world.point(item.b);
    return {!item.a.has_frame ? xa : !item.b.has_frame ? xb : Vec3(0.5 * (xa + xb)), xa - xb};
  }

  void linearize(const Item& item, const auto& world, auto row) const {
    const auto [point, gap] = place(item, world);
    row.end(item.a, point).along_axes(1);
    row.end(item.b, point).along_axes(-1);
    for (int k = 0; k < 3; ++k) row.phi(k, gap[k]);
  }
};

}  // namespace delassus
