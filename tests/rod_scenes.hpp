/// Rods for the tests of several rooms.
#pragma once

#include <delassus/fem/rods.hpp>

#include <random>
#include <vector>

namespace rod_scenes {

using namespace delassus;

/// A random vector with entries in (−size, size), one drawn after the other.
inline Vec3 draw_vector(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> draw(-size, size);
  Vec3 x;
  for (int k = 0; k < 3; ++k) x[k] = draw(random);
  return x;
}

/// Half a helix with a section whose sides differ.
inline Rod bent_rod(Index segments = 6) {
  Rod rod{.section = rectangular_section(0.02, 0.01), .young = 1e6, .density = 800, .up = {0, 0, 1}};
  for (Index k = 0; k <= segments; ++k) {
    const double t = M_PI * double(k) / double(segments);
    rod.points.push_back({0.3 * std::cos(t), 0.3 * std::sin(t), 0.1 * t});
  }
  return rod;
}

/// Every node moved and turned by up to these sizes.
template <class T>
void shake(BasicRods<T>& set, double size, double turn, unsigned seed = 7) {
  std::mt19937 random(seed);
  for (const Index b : set.active()) {
    const Vec3 step = draw_vector(random, size), by = draw_vector(random, turn);
    set.displace(b, twist<T>(step.template cast<T>(), by.template cast<T>()));
  }
}

/// Elastic forces and moments where the nodes are now, by block.
template <class T>
std::vector<Vec<6, T>> elastic_forces(BasicRods<T>& set) {
  const Vec3 gravity = set.gravity;
  set.gravity.setZero();
  set.factor({.mass = 1});
  std::vector<Vec<6, T>> f(set.blocks(), Vec<6, T>::Zero());
  set.add_forces(f);
  set.gravity = gravity;
  return f;
}

/// A straight round rod of 1 m along x, clamped at x = 0: E = 1e9 Pa, radius 1 cm, no weight.
struct Needle {
  static constexpr double length = 1, radius = 0.01, young = 1e9;
  const RodSection section = round_section(radius);
  const double EI = young * section.second_y;
  Rods set;
  Rods::BodyHandle rod;

  explicit Needle(Index segments, double density = 1000)
      : rod(set.add({.points = straight_line({0, 0, 0}, {length, 0, 0}, segments),
                     .section = section,
                     .young = young,
                     .density = density})) {
    set.gravity.setZero();
    set.fix(set.node(rod, 0));
  }
  Rods::Handle tip() const { return set.node(rod, set.node_count(rod) - 1); }
};

}  // namespace rod_scenes
