/// What the tests of the direct path share: chains, and a problem from cold.
#pragma once

#include <delassus/delassus.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace direct_tests {

using namespace delassus;

/// Links of 0.2 m and 1 kg on ball joints, 20° from the vertical; the last has `ratio` kg more.
template <class... Policies>
auto chain(int links, double ratio, Policies... policies) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, policies...};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const double length = 0.2, angle = EIGEN_PI / 9;
  const Vec3 way(std::sin(angle), 0, -std::cos(angle));
  const Quat turned = exponential<double>({0, -angle, 0});
  Anchor end = world_anchor(Vec3::Zero());
  for (int k = 0; k < links; ++k) {
    const double mass = k == links - 1 ? 1 + ratio : 1;
    const auto link =
        rigid.add({.position = (length * (k + 0.5)) * way,
                   .orientation = turned,
                   .mass = mass,
                   .inertia = Mat3(mass * length * length / 12 * Vec3(1, 1, 0.15).asDiagonal())});
    loop.add(BallJoint::Item{end, anchor(rigid, link, {0, 0, 0.5 * length})});
    end = anchor(rigid, link, {0, 0, -0.5 * length});
  }
  return loop;
}

/// Where the last body's centre is.
template <class Loop>
Vec3 end_of(const Loop& loop) {
  const auto& rigid = loop.world().template set<0>();
  return rigid.pose(rigid.blocks() - 1).position;
}

/// The problem of the first step, from cold.
template <class Loop>
auto problem_of(Loop& loop) {
  loop.step(1.0 / 60);
  auto p = loop.problem();
  for_each_index<decltype(p)::Rows::pool_count>([&](auto pool) {
    for (auto& x : p.rows.template pool<pool>().lambda) x.setZero();
  });
  return p;
}

/// The largest |u_i − v_i|, m/s, of the velocities d + W λ of two problems that differ in λ.
template <class Problem>
double apart(const Problem& a, const Problem& b) {
  double most = 0;
  for_each_index<Problem::Rows::pool_count>([&](auto p) {
    for (Index i = 0; i < a.rows.template pool<p>().items(); ++i)
      most = std::max(
          most, double((a.W.template residual<p>(a.rows, i) - b.W.template residual<p>(b.rows, i)).norm()));
  });
  return most;
}

}  // namespace direct_tests
