/// Sheets for the tests of several rooms.
#pragma once

#include <delassus/fem/cloth.hpp>

#include "soft_scenes.hpp"

namespace soft_scenes {

/// The unit square in n² cells, inner points moved in the plane by up to `jitter` of a cell.
inline SheetMesh square(Index n, double thickness, double jitter = 0, unsigned seed = 1) {
  SheetMesh mesh = sheet(1, 1, {n, n}, thickness);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> draw(-jitter / double(n), jitter / double(n));
  for (Vec3& p : mesh.points)
    if (std::min(p[0], p[1]) > 1e-9 && std::max(p[0], p[1]) < 1 - 1e-9)
      p += Vec3{draw(random), draw(random), 0};
  return mesh;
}

/// Lays a flat sheet around a cylinder of radius R, curved in the direction `angle` (rad) of its plane.
void roll(auto& set, const auto& body, double R, double angle) {
  const auto rest = set.mesh(body).points;
  const Vec3 d(std::cos(angle), std::sin(angle), 0), e(-std::sin(angle), std::cos(angle), 0);
  for (Index k = 0; k < set.node_count(body); ++k) {
    const double s = d.dot(rest[k]) / R;
    set.place(set.node(body, k),
              R * std::sin(s) * d + e.dot(rest[k]) * e + R * (1 - std::cos(s)) * Vec3(0, 0, 1));
  }
}

}  // namespace soft_scenes
