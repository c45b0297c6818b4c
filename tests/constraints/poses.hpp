/// Bodies of every kind at random poses, and the rows that a law writes there, as a dense matrix.
#pragma once

#include <delassus/bodies/particles.hpp>
#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/rows/anchor.hpp>
#include <delassus/rows/pool_rows.hpp>
#include <delassus/rows/writer.hpp>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include "catch.hpp"

namespace poses {

using namespace delassus;

using TwoSets = World<RigidBodies, Particles>;

/// Four movable bodies at random poses: two rigid bodies, two particles, and what an end can be.
struct Scene {
  TwoSets world{RigidBodies{}, Particles{}};
  std::mt19937 random;
  std::vector<RigidBodies::Handle> rigid;
  std::vector<Particles::Handle> points;

  explicit Scene(unsigned seed) : random(seed) {
    for (int i = 0; i < 2; ++i) {
      rigid.push_back(set<RigidBodies>().add(
          {.position = vector(), .orientation = turn(), .mass = 1.0, .shape = Box{1, 2, 3}}));
      points.push_back(set<Particles>().add({.position = vector(), .mass = 1.0}));
    }
  }
  template <class S>
  S& set() {
    return bodies<S>(world);
  }
  double draw() { return std::uniform_real_distribution<double>(-1, 1)(random); }
  Vec3 vector() { return {draw(), draw(), draw()}; }
  Quat turn() { return Quat{draw(), draw(), draw(), draw()}.normalized(); }

  /// 0, 1: the rigid bodies · 2, 3: the particles · 4: the world.
  Anchor end(int kind, const Quat& frame = Quat::Identity()) {
    Anchor a = kind < 2   ? anchor(set<RigidBodies>(), rigid[kind], vector(), frame)
               : kind < 4 ? anchor(set<Particles>(), points[kind - 2])
                          : world_anchor(vector(), frame);
    world.resolve(a, "end");
    return a;
  }
  /// An end of that kind that is at `point` now.
  Anchor end_at(int kind, const Vec3& point) {
    Anchor a = end(kind);
    if (kind < 2)
      a.local = set<RigidBodies>().pose(a.block).to_local(point);
    else if (kind < 4)
      set<Particles>().place(points[kind - 2], point);
    else
      a.local = point;
    return a;
  }

  /// Moves coordinate c: 0–5, 6–11 of the rigid bodies, 12–14, 15–17 of the particles; m or rad.
  void move(int c, double by) {
    if (c < 12)
      set<RigidBodies>().displace(c / 6, Vec<6>::Unit(c % 6) * by);
    else
      set<Particles>().displace((c - 12) / 3, Vec3::Unit(c % 3) * by);
  }
};
inline constexpr int coordinates = 18;

/// The rows of one item of a law, H dense in the coordinates of `move`.
template <class Law>
struct Written {
  Mat<Law::rows, coordinates> H = Mat<Law::rows, coordinates>::Zero();
  Vec<Law::rows> phi;

  Written(const Law& law, const typename Law::Item& item, const TwoSets& world) {
    PoolRows<Law::rows, double, 6, 3> rows;
    const ArraysOf arrays(rows);
    const ViewOf view(world);
    arrays.reset(1);
    law.linearize(item, view, RowWriter<double>(view, arrays, 0));
    arrays.close();
    phi = rows.phi[0];
    const auto& rigid = inner::part<0>(rows.sets);
    const auto& points = inner::part<1>(rows.sets);
    for (std::size_t e = 0; e < rigid.block.size(); ++e)
      H.template middleCols<6>(6 * rigid.block[e]) += rigid.H[e];
    for (std::size_t e = 0; e < points.block.size(); ++e)
      H.template middleCols<3>(12 + 3 * points.block[e]) += points.H[e];
  }
};

/// Largest |H − Δ value/2ε|; value(): rows as a function of the configuration. ε = 1e-6: the third derivative
/// of coordinates below 4 m adds ε² · 4, rounding 4 · 2^-53/ε ~ 4e-10.
template <int R, class Value>
double difference(Scene& scene, const Mat<R, coordinates>& H, const Value& value) {
  const double step = 1e-6;
  double worst = 0;
  for (int c = 0; c < coordinates; ++c) {
    scene.move(c, step);
    const Vec<R> up = value();
    scene.move(c, -2 * step);
    const Vec<R> down = value();
    scene.move(c, step);
    worst = std::max(worst, (H.col(c) - (up - down) / (2 * step)).cwiseAbs().maxCoeff());
  }
  return worst;
}

/// f(first kind, second kind, scene) for rigid–rigid, rigid–particle, rigid–world, particle–particle,
/// particle–world, and the other way round, ten poses each.
template <class F>
void each_pair(F&& f) {
  for (const auto& [a, b] : {std::pair{0, 1}, {0, 2}, {0, 4}, {2, 3}, {2, 4}, {2, 0}, {4, 0}, {4, 2}})
    for (unsigned seed = 1; seed <= 10; ++seed) {
      Scene scene(seed);
      CAPTURE(a, b, seed);
      f(a, b, scene);
    }
}

}  // namespace poses
