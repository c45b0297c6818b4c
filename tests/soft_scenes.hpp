/// Deformable bodies for the tests of several rooms: forces, static solves, beams.
#pragma once

#include <delassus/bodies/elasticity/corotational.hpp>
#include <delassus/bodies/elasticity/linear.hpp>
#include <delassus/bodies/elasticity/st_venant_kirchhoff.hpp>
#include <delassus/bodies/elasticity/stable_neo_hookean.hpp>
#include <delassus/bodies/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>
#include <delassus/math/rotation.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace soft_scenes {

using namespace delassus;

/// The elastic forces where the nodes are now, N, by block.
template <class Set>
std::vector<Vec3> elastic_forces(Set& set) {
  const Vec3 gravity = set.gravity;
  set.gravity.setZero();
  set.factor({.mass = 1});
  std::vector<Vec3> f(set.blocks(), Vec3::Zero());
  set.add_forces(f);
  set.gravity = gravity;
  return f;
}

/// Newton's method for the rest position under gravity, `iterations` steps.
template <class Set>
void settle(Set& set, int iterations) {
  for (int n = 0; n < iterations; ++n) {
    set.factor({.mass = 0, .stiffness = 1});
    std::vector<Vec3> x(set.blocks(), Vec3::Zero());
    set.add_forces(x);
    set.solve(x);
    for (Index b = 0; b < set.blocks(); ++b) set.displace(b, x[b]);
  }
}

/// The unit cube in n³ cells, inner points moved by up to `jitter` of a cell.
inline TetrahedralMesh cube(Index n, double jitter = 0, unsigned seed = 1) {
  TetrahedralMesh mesh = box_mesh({1, 1, 1}, {n, n, n});
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> draw(-jitter / double(n), jitter / double(n));
  for (Vec3& p : mesh.points)
    if (p.minCoeff() > 1e-9 && p.maxCoeff() < 1 - 1e-9) p += Vec3(draw(random), draw(random), draw(random));
  return mesh;
}

/// A beam of length L = 1 m and a square section of side 0.1 m in 10 s × s × s cells, clamped at x = 0: E =
/// 1e6 Pa, ν = 0.3.
template <class M>
struct Cantilever {
  static constexpr double E = 1e6, side = 0.1, second_moment = side * side * side * side / 12;
  TetrahedralFem<M> set;
  typename TetrahedralFem<M>::BodyHandle beam;

  explicit Cantilever(Index s, double density = 1000)
      : beam(set.add({.mesh = box_mesh({1, side, side}, {10 * s, s, s}),
                      .elasticity = {.young = E, .poisson = 0.3},
                      .density = density})) {
    set.gravity.setZero();
    set.fix(beam, [](const Vec3& x) { return x[0] < 1e-9; });
  }

  /// The force P (N) along −y spread evenly over the free end.
  std::vector<Vec3> end_load(double P) const {
    std::vector<Vec3> f(set.blocks(), Vec3::Zero());
    const TetrahedralMesh& mesh = set.mesh(beam);
    for (const auto& t : surface(mesh)) {
      const Vec3 a = mesh.points[t[0]], b = mesh.points[t[1]], c = mesh.points[t[2]];
      if (std::min({a[0], b[0], c[0]}) < 1 - 1e-9) continue;
      const double share = (b - a).cross(c - a).norm() / 2 / (side * side);
      for (const Index i : t) f[i][1] -= P * share / 3;
    }
    return f;
  }
  /// The mean of the vectors x of the free end's nodes.
  Vec3 at_end(const std::vector<Vec3>& x) const {
    Vec3 sum = Vec3::Zero();
    int count = 0;
    for (Index i = 0; i < Index(x.size()); ++i)
      if (set.mesh(beam).points[i][0] > 1 - 1e-9) sum += x[i], ++count;
    return sum / count;
  }
};

}  // namespace soft_scenes
