/// What every element of a deformable body must pass, whatever its shape: for the tests of the sets of FEM.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "catch.hpp"
#include "soft_scenes.hpp"

namespace fem_tests {

using namespace delassus;
using namespace soft_scenes;

inline const Mat3 stretch = columns<double>({1.1, 0.02, -0.03}, {0.05, 0.93, 0.04}, {-0.02, 0.01, 1.06});

/// Moves every node by up to `size` in each direction.
void scatter(auto& set, double size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> draw(-size, size);
  for (Index b = 0; b < set.blocks(); ++b) {
    Vec3 by;
    for (int k = 0; k < 3; ++k) by[k] = draw(random);
    set.displace(b, by);
  }
}

/// Patch test: of a unit cube whose surface is stretched the nodes inside follow.
template <class Set, class Material>
void check_patch(const auto& mesh, int nodes_inside) {
  Set set;
  set.gravity.setZero();
  const Material material{.young = 1000, .poisson = 0.4};
  const auto body = set.add({.mesh = mesh, .elasticity = material});
  const auto rest = set.mesh(body).points;
  set.fix(body, [](const Vec3& x) { return x.minCoeff() < 1e-9 || x.maxCoeff() > 1 - 1e-9; });
  for (Index k = 0; k < set.node_count(body); ++k)
    if (!set.moves(k)) set.place(set.node(body, k), stretch * rest[k]);
  settle(set, 12);  // from rest; Newton's method doubles its digits
  double worst = 0;
  int inside = 0;
  for (Index k = 0; k < set.node_count(body); ++k) {
    if (!set.moves(k)) continue;
    worst = std::fmax(worst, (set.position(set.node(body, k)) - stretch * rest[k]).norm());
    ++inside;
  }
  CHECK(inside == nodes_inside);
  CHECK(worst < 1e-12);
  // Constant stress: no force inside, and the energy of the material times the volume.
  const auto f = elastic_forces(set);
  for (Index k = 0; k < set.blocks(); ++k)
    if (set.moves(k))
      CHECK(f[k].norm() < 1e-11);  // E times the area of a face, times ε and some tens of terms
  CHECK(std::abs(set.elastic_energy() - material.at(stretch).energy()) < 1e-11);
}

/// Turned and moved as a whole: no force, no energy.
template <class Set>
void check_rigid_motion(const auto& mesh) {
  for (const double angle : {0.3, 179 * M_PI / 180}) {
    Set set;
    const auto body = set.add({.mesh = mesh, .elasticity = {.young = 1}});
    const Quat turn = exponential(Vec3(angle * Vec3(1, 2, -2) / 3));
    for (Index k = 0; k < set.node_count(body); ++k) {
      const auto node = set.node(body, k);
      set.place(node, Vec3(3, -1, 2) + turn * set.position(node));
    }
    for (const Vec3& f : elastic_forces(set)) CHECK(f.norm() < 1e-14);
    CHECK(std::abs(set.elastic_energy()) < 1e-15);
  }
}

/// The elastic forces sum to nothing, and so do their moments, while together they are larger than `size`
/// (N).
void check_balance(auto& set, double size) {
  const auto f = elastic_forces(set);
  Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
  double together = 0;
  for (Index b = 0; b < set.blocks(); ++b) {
    sum += f[b];
    moment += set.position(set.handle(b)).cross(f[b]);
    together += f[b].norm();
  }
  CHECK(together > size);
  CHECK(sum.norm() < 1e-14 * together);
  CHECK(moment.norm() < 1e-14 * together);
}

/// f = −∂Ψ/∂x by central differences of the fourth order. `bound`: step⁴ of the fifth derivative, ε Ψ/step.
void check_derivative(auto& set, double bound) {
  const auto f = elastic_forces(set);
  const double step = 1e-4;
  for (Index b = 0; b < set.blocks(); ++b)
    for (int k = 0; k < 3; ++k) {
      const auto energy_at = [&](double by) {
        set.displace(b, by * unit_axis(k));
        const double energy = set.elastic_energy();
        set.displace(b, -by * unit_axis(k));
        return energy;
      };
      const double near = energy_at(step) - energy_at(-step),
                   far = energy_at(2 * step) - energy_at(-2 * step);
      CHECK(std::abs(f[b][k] + (8 * near - far) / (12 * step)) < bound);
    }
}

/// Stretches a body in every direction, where nothing of K is cut, and bends it by a wave of `bend` m.
void stretch_all(auto& set, const auto& body, double bend) {
  const auto rest = set.mesh(body).points;
  for (Index k = 0; k < set.node_count(body); ++k)
    set.place(set.node(body, k), 1.15 * (stretch * rest[k]) +
                                     bend * Vec3(std::sin(9 * rest[k][1]), std::cos(7 * rest[k][0]), 0));
}

/// A = M + h² K is the derivative of the forces. `bound`: step² of the third derivative.
void check_tangent(auto& set, double bound) {
  const double worst = error_of_stiffness(set);
  CHECK(worst > 0);
  CHECK(worst < bound);
}

/// An anchor at (1.3, 0.6, 0.2) m moves with the point of the unit cube at (1, 0, 0) it was put on, to
/// `bound` (m); the shares of its nodes are one in all, to `share_bound`.
void check_anchor(auto& set, const auto& body, double bound, double share_bound) {
  const Vec3 place(1.3, 0.6, 0.2);
  const auto rest = set.mesh(body).points;
  const Anchor a = set.anchor_at(body, place);
  CHECK((set.point(a) - place).norm() < bound);
  for (Index k = 0; k < set.blocks(); ++k) set.place(set.node(body, k), stretch * rest[k]);
  CHECK((set.point(a) - stretch * place).norm() < bound);
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < set.anchor_blocks(a); ++k) sum += set.along(a, k, set.point(a), {1, 2, 3});
  CHECK((sum - Vec3(1, 2, 3)).norm() < share_bound);
}

}  // namespace fem_tests
