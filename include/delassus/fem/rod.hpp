/// What a user says of a new rod, and the checks that refuse what cannot be one.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/index.hpp>
#include <delassus/fem/inner/place_of_nodes.hpp>
#include <delassus/fem/rod_section.hpp>
#include <delassus/math/fits.hpp>
#include <delassus/math/rotation.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace delassus {

/// A rod as it is added: a line of nodes at rest, straight between them, put in its place. SI units.
///
/// A node's frame has x along the segment after it (the last one: before it), and y towards `up` as far as x
/// allows. The frames of a bent line turn about it no more than they must. `up` matters where the section has
/// two different second moments, and is any direction where it is zero.
/// `contact_radius` > 0 (m) makes every segment a capsule for collision; at 0 nothing collides. Segments are
/// in a group of their own and leave it out, so that neighbours do not meet.
struct Rod {
  std::vector<Vec3> points{};  ///< of its nodes at rest, m, in its own axes; two at least
  RodSection section = round_section(1e-3);  ///< a full circle of 1 mm radius
  double young = 1e9;     ///< Pa
  double poisson = 0.3;   ///< G = E/(2(1 + ν))
  double density = 1000;  ///< kg/m³
  Vec3 position = Vec3::Zero();  ///< of the origin of its axes, world, m
  Quat orientation = Quat::Identity();  ///< its axes to the world, unit
  Vec3 velocity = Vec3::Zero();  ///< of every node, world, m/s
  double contact_radius = 0;  ///< m, ≥ 0
  Vec3 up = Vec3::Zero();  ///< in its own axes, of any length
  Index material = 0;  ///< a number that `Materials` gave
  std::uint32_t group = 4;  ///< a bit for every group it is in
  /// The groups it meets; its own is refused where it has a contact_radius.
  std::uint32_t collides_with = ~4u;
};

/// n segments of one length from `first` to `last`.
inline std::vector<Vec3> straight_line(const Vec3& first, const Vec3& last, Index n) {
  DELASSUS_EXPECT(n > 0, "straight_line: " + std::to_string(n) + " segments; it needs one at least");
  std::vector<Vec3> points;
  for (Index k = 0; k <= n; ++k) points.push_back(first + double(k) / double(n) * Vec3(last - first));
  return points;
}

namespace inner {

/// Refuses a line that no rod follows.
inline void check_line(const Rod& rod, const std::string& who) {
  const auto& points = rod.points;
  DELASSUS_EXPECT(points.size() >= 2,
                  who + ": it has " + std::to_string(points.size()) + " points; a rod needs two at least");
  for (std::size_t k = 0; k < points.size(); ++k)
    DELASSUS_EXPECT(is_finite(points[k]), who + ": point #" + std::to_string(k) + " is not finite");
  double total = 0;
  for (std::size_t k = 1; k < points.size(); ++k) total += (points[k] - points[k - 1]).norm();
  for (std::size_t k = 1; k < points.size(); ++k) {
    const Vec3 piece = points[k] - points[k - 1];
    DELASSUS_EXPECT(piece.norm() > 1e-9 * total, who + ": segment #" + std::to_string(k - 1) + " is " +
                                                     text(piece.norm()) + " m long, shorter than 1e-9 of " +
                                                     text(total) + " m, the whole rod");
    if (k < 2) continue;
    const Vec3 before = points[k - 1] - points[k - 2];
    DELASSUS_EXPECT(before.dot(piece) > -0.999 * before.norm() * piece.norm(),
                    who + ": the line turns back on itself at point #" + std::to_string(k - 1));
  }
}

template <class T>
void check_rod(const Rod& rod, const std::string& who) {
  check_line(rod, who);
  check_section(rod.section, who);
  inner::expect_positive(who + ": Young's modulus", rod.young, "Pa");
  inner::expect_number(rod.poisson > -1 && rod.poisson <= 0.5, who + ": Poisson's ratio", rod.poisson,
                       "must lie in (-1, 0.5]");
  DELASSUS_EXPECT(is_finite(rod.up), who + ": up is not finite");
  check_place_of_nodes<T>(rod, who, "segments");
}

}  // namespace inner
}  // namespace delassus
