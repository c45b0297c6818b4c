/// Two bodies in any pose, and what must hold of the contacts that an engine finds between them.
#pragma once

#include "shapes.hpp"

#include <delassus/collision/engine.hpp>
#include <delassus/collision/inner/difference.hpp>
#include <delassus/collision/sweep_and_prune.hpp>

#include <algorithm>
#include <vector>

namespace fuzz {

inline double extent(const Collider& c) {
  const Aabb box = tight_box(c.shape, c.pose);
  return c.shape.kind == ShapeKind::half_space ? 0 : (box.max() - box.min()).maxCoeff();
}

/// Finite; a unit normal; witnesses one gap apart along it; and no contact deeper than the whole overlap
/// along that normal, h(n) = n · (s_A(n) − s_B(−n)).
inline void check_contact(const std::vector<Collider>& bodies, const ContactPoint& p) {
  expect(is_finite(p.point_a) && is_finite(p.point_b) && is_finite(p.normal) && std::isfinite(p.gap),
         "a contact is not finite");
  expect(p.a != p.b && p.a >= 0 && p.b >= 0 && p.a < Index(bodies.size()) && p.b < Index(bodies.size()),
         "a contact is between bodies that are not there");
  expect(std::abs(p.normal.norm() - 1) < 1e-9, "the normal of a contact is no unit vector");
  const Collider &a = bodies[std::size_t(p.a)], &b = bodies[std::size_t(p.b)];
  // Rounding of world coordinates and of what the kernels scale by: 1e-9 of the largest number in play.
  const double size = std::max({extent(a), extent(b), p.point_a.norm(), p.point_b.norm(),
                                a.pose.position.norm(), b.pose.position.norm()}),
               rounding = 1e-9 * size;
  expect((p.point_b - p.point_a - p.gap * p.normal).norm() <= rounding,
         "the witnesses of a contact are not its gap apart");
  if (a.shape.kind == ShapeKind::half_space || b.shape.kind == ShapeKind::half_space) return;
  const Vec3 n = a.pose.rotation.transpose() * p.normal;
  const Pose b_in_a{.position = a.pose.to_local(b.pose.position),
                    .rotation = a.pose.rotation.transpose() * b.pose.rotation};
  // Faces of hulls are flat to 1e-7 of their extent and clipped with a slack of as much, on planes no steeper
  // than 1 : 5.
  const double slack = 5e-7 * (extent(a) + extent(b));
  expect(-p.gap <= delassus::inner::Difference{a.shape, b.shape, b_in_a}.reach(n) + rounding + slack,
         "a contact is deeper than the bodies overlap along its normal");
}

/// Two to four bodies, found twice, the second time a little further on: what the engine remembers is used as
/// well.
template <class Kernel>
int collide(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  const double unit = bytes.magnitude(-4, 4), stretch = bytes.below(4), h = bytes.magnitude(-4, -1);
  const bool is_far = bytes.chance(64);
  Shapes shapes;
  std::vector<Collider> bodies;
  const int count = 2 + bytes.below(3);
  for (int k = 0; k < count; ++k) {
    try {
      Collider c{.shape = shapes.any(bytes, unit, stretch, true)};
      check(c.shape, "body");
      c.pose.position = unit * (bytes.chance(32) ? Vec3::Zero() : vector(bytes, 1));
      if (is_far) c.pose.position += 1e6 * unit * Vec3(1, -1, 2);
      c.pose.rotation = rotation(bytes).toRotationMatrix();
      c.velocity = unit * vector(bytes, 10);
      c.angular_velocity = vector(bytes, 10);
      c.is_movable = !bytes.chance(32);
      c.key = std::uint32_t(bodies.size());
      bodies.push_back(c);
    } catch (const InvalidArgument&) {
    }
  }
  CollisionEngine<Kernel, SweepAndPrune> engine;
  std::vector<ContactPoint> points;
  const CollisionSettings settings{.max_points = 1 + bytes.below(8)};
  for (int frame = 0; frame < 2; ++frame) {
    engine.detect(bodies, h, settings, points);
    for (const ContactPoint& p : points) check_contact(bodies, p);
    for (Collider& c : bodies) {
      c.pose.position += h * c.velocity;
      c.pose.rotation = exponential<double>(h * c.angular_velocity).toRotationMatrix() * c.pose.rotation;
    }
  }
  return 0;
}

}  // namespace fuzz
