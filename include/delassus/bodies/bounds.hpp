/// The box around everything a scene moves.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/geometry/support.hpp>
#include <delassus/rows/alive.hpp>

#include <Eigen/Geometry>

namespace delassus {

/// Bounds of all shapes and centres of mass of a world, m; half-spaces are left out, they have none.
template <class... Sets>
Eigen::AlignedBox3d bounds(const World<Sets...>& world) {
  Eigen::AlignedBox3d box;
  world.each([&](const auto& set, auto) {
    for (const Index b : alive(set)) {
      const Pose pose = set.pose(b);
      if (set.has_collider(b)) {
        const Shape shape = set.shape(b);
        if (shape.kind == ShapeKind::half_space) continue;
        const Aabb tight = tight_box(shape, pose);
        if (!tight.is_empty()) box.extend(Eigen::AlignedBox3d(tight.min(), tight.max()));
      } else {
        box.extend(pose.position);
      }
    }
  });
  return box;
}

}  // namespace delassus
