/// A ball joint: two points coincide.
#pragma once

#include <delassus/constraints/joints/bilateral.hpp>
#include <delassus/rows/anchor.hpp>

namespace delassus {

/// φ = x_a − x_b (m, world axes), u = v_a − v_b. Both impulses act at the middle of the two anchors.
struct BallJoint : Bilateral<3> {
  struct Item {
    Anchor a, b;
  };

  void linearize(const Item& item, const auto& world, auto row) const {
    const Vec3 xa = world.point(item.a), xb = world.point(item.b), middle = 0.5 * (xa + xb);
    auto a = row.end(item.a, middle), b = row.end(item.b, middle);
    for (int k = 0; k < 3; ++k) {
      a.along(k, Vec3::Unit(k));
      b.along(k, -Vec3::Unit(k));
      row.phi(k, xa[k] - xb[k]);
    }
  }
};

}  // namespace delassus
