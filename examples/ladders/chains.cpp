// HC-03, HC-35, HC-36: chains and grids of joints.
#include "rows.hpp"
#include "watch.hpp"

#include <delassus/loop/newton_midpoint.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>
#include <delassus/solvers/proximal_newton.hpp>

#include <span>

namespace ladders {

namespace {

/// Links of 1 kg and 1 m, each a rod, with ball joints at their ends; the first hangs on the world at (0, 0,
/// 0).
template <class Loop>
std::vector<RigidBodies::Handle> add_chain(Loop& loop, int links, double spread = 1) {
  auto& set = bodies<RigidBodies>(loop.world());
  std::vector<RigidBodies::Handle> out;
  const Mat3 inertia = Vec3(0.01, 1. / 12, 1. / 12).asDiagonal();
  for (int k = 0; k < links; ++k)
    out.push_back(set.add({.position = {spread * (k + 0.5), 0, 0}, .mass = 1.0, .inertia = inertia}));
  for (int k = 0; k < links; ++k)
    loop.add(BallJoint::Item{k ? anchor(set, out[std::size_t(k - 1)], {0.5, 0, 0}) : world_anchor({0, 0, 0}),
                             anchor(set, out[std::size_t(k)], {-0.5, 0, 0})});
  return out;
}

struct HeavyChain {
  int links;
  double end;
};

constexpr HeavyChain chains[] = {{10, 1},    {10, 100},  {10, 1e4},  {40, 1},     {40, 100},
                                 {40, 1e4},  {100, 1},   {100, 100}, {100, 1e4},  {160, 1},
                                 {160, 100}, {160, 1e4}, {1000, 1},  {1000, 100}, {1000, 1e4}};

template <class... Policies>
void climb_chain(Ladder& ladder, double h, int count, const Policies&... policies) {
  for (const auto& [links, end] : std::span(chains).first(std::size_t(count)))
    ladder.rung(format("%d links, end %g ×", links, end), [&, links = links, end = end]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, policies...};
      auto& set = bodies<RigidBodies>(loop.world());
      const auto chain = add_chain(loop, links);
      const auto ball = set.add(
          {.position = {double(links), 0, 0}, .mass = end, .inertia = Mat3(0.1 * end * Mat3::Identity())});
      loop.add(BallJoint::Item{anchor(set, chain.back(), {0.5, 0, 0}), anchor(set, ball)});
      const Seen seen = run(ladder, loop, ladder.is_quick() ? 1 : 30, h);
      return {{"joint gap / link", seen.joint_gap, 1e-2, 1e-4},
              {"steps not converged", double(seen.unconverged), unbounded, 0},
              energy_mark(seen, (0.5 * links + end) * g * links)};
    });
}

}  // namespace

void heavy_chain(Ladder& ladder) { climb_chain(ladder, frame, 9, AcceleratedGaussSeidel{}); }
void heavy_chain_newton(Ladder& ladder) { climb_chain(ladder, frame, 9, ProximalNewton{}, WholeViolation{}); }
void heavy_chain_fine(Ladder& ladder) {
  climb_chain(ladder, frame / 16, 9, ProximalNewton{}, WholeViolation{});
}
void heavy_chain_midpoint(Ladder& ladder) { climb_chain(ladder, frame, 15, NewtonMidpoint{}); }

// Forty links that start twice as far apart as their joints allow: what the joints pull together must not
// become a shot.
void stretched_chain(Ladder& ladder) {
  for (const double stretch : {1.01, 1.1, 1.5, 2.})
    ladder.rung(format("%g × its length", stretch), [&]() -> Marks {
      const int links = 40;
      AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, PositionProjection{}};
      add_chain(loop, links, stretch);
      const Seen seen = run(ladder, loop, ladder.is_quick() ? 0.5 : 10, frame);
      return {{"speed / free fall of its length", seen.speed / std::sqrt(2 * g * links), 3, 1},
              energy_mark(seen, links * g * links, 1e-3)};
    });
}

namespace {

// n × n small bodies in a square net, 0.5 m apart, held at two corners.
template <class... Policies>
void climb_grid(Ladder& ladder, const Policies&... policies) {
  for (const int n : {5, 10, 20, 40, 100})
    ladder.rung(format("%d × %d", n, n), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, policies...};
      auto& set = bodies<RigidBodies>(loop.world());
      std::vector<RigidBodies::Handle> knots;
      for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k)
          knots.push_back(set.add(
              {.position = {0.5 * k, 0, -0.5 * i}, .mass = 1.0, .inertia = Mat3(0.02 * Mat3::Identity())}));
      const auto knot = [&](int i, int k) { return knots[std::size_t(i * n + k)]; };
      for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
          if (k + 1 < n)
            loop.add(BallJoint::Item{anchor(set, knot(i, k), {0.25, 0, 0}),
                                     anchor(set, knot(i, k + 1), {-0.25, 0, 0})});
          if (i + 1 < n)
            loop.add(BallJoint::Item{anchor(set, knot(i, k), {0, 0, -0.25}),
                                     anchor(set, knot(i + 1, k), {0, 0, 0.25})});
        }
      for (const int k : {0, n - 1})
        loop.add(BallJoint::Item{world_anchor({0.5 * k, 0, 0}), anchor(set, knot(0, k))});
      const Seen seen = run(ladder, loop, ladder.is_quick() ? 0.3 : 20, frame);
      return {{"joint gap / spacing", seen.joint_gap / 0.5, 1e-2, 1e-3},
              energy_mark(seen, n * n * g * 0.5 * n)};
    });
}

}  // namespace

void joint_grid(Ladder& ladder) {
  climb_grid(ladder, AcceleratedGaussSeidel{.tolerance = 1e-6}, WholeViolation{});
}
void joint_grid_direct(Ladder& ladder) { climb_grid(ladder, DirectGaussSeidel{}, WholeViolation{}); }

}  // namespace ladders
