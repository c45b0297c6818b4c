/// Deformable bodies for the tests of several rooms: forces, static solves, beams.
#pragma once

#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/elasticity/linear.hpp>
#include <delassus/fem/elasticity/st_venant_kirchhoff.hpp>
#include <delassus/fem/elasticity/stable_neo_hookean.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
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

/// How far A⁻¹ (M d − h² ∂f/∂x d) is from d, ∂f/∂x by differences of forces 1e-5 m apart: of the order of
/// their square where A = M + h² K and K is the whole derivative.
template <class Set>
double error_of_stiffness(Set& set) {
  const double h2 = 1e-3, step = 1e-5;
  std::vector<Vec3> direction(set.blocks(), Vec3::Zero());
  for (Index k = 0; k < set.blocks(); ++k)
    if (set.moves(k)) direction[k] = Vec3(std::cos(3 * k), std::sin(5 * k), std::cos(7 * k));
  const auto moved = [&](double s) {
    for (Index k = 0; k < set.blocks(); ++k) set.displace(k, s * direction[k]);
    return elastic_forces(set);
  };
  const auto up = moved(step), down = moved(-2 * step);
  moved(step);
  std::vector<Vec3> y(set.blocks());
  for (Index k = 0; k < set.blocks(); ++k)
    y[k] = double(set.mass(k)) * direction[k] - h2 / (2 * step) * (up[k] - down[k]);
  set.factor({.mass = 1, .stiffness = h2});
  set.solve(y);
  double worst = 0;
  for (Index k = 0; k < set.blocks(); ++k) worst = std::max(worst, (y[k] - direction[k]).norm());
  return worst;
}

/// The lowest frequency (rad/s) that v holds a part of, by inverse iteration, v ← K⁻¹ M v, ω² =
/// v·Mv/(v·MK⁻¹Mv). K is factored.
template <class Set, class Velocity>
double lowest_frequency(const Set& set, std::vector<Velocity> v, int iterations) {
  double omega2 = 0;
  for (int n = 0; n < iterations; ++n) {
    auto z = v;
    for (Index b = 0; b < set.blocks(); ++b) z[b] *= set.moves(b) ? set.mass(b) : 0.0;
    auto y = z;
    set.solve(y);
    double before = 0, after = 0, size = 0;
    for (Index b = 0; b < set.blocks(); ++b) {
      before += v[b].dot(z[b]);
      after += y[b].dot(z[b]);
      size = std::max(size, y[b].norm());
    }
    omega2 = before / after;
    for (Index b = 0; b < set.blocks(); ++b) v[b] = y[b] / size;
  }
  return std::sqrt(omega2);
}

/// The unit cube in n³ cells, inner points moved by up to `jitter` of a cell.
inline TetrahedralMesh cube(Index n, double jitter = 0, unsigned seed = 1) {
  TetrahedralMesh mesh = box_mesh({1, 1, 1}, {n, n, n});
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> draw(-jitter / double(n), jitter / double(n));
  for (Vec3& p : mesh.points)
    if (p.minCoeff() > 1e-9 && p.maxCoeff() < 1 - 1e-9) p += Vec3{draw(random), draw(random), draw(random)};
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
