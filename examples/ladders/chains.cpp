// HC-03, HC-35, HC-36: chains and grids of joints.
#include "rows.hpp"
#include "watch.hpp"

#include <delassus/schemes/substeps.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>
#include <delassus/solvers/proximal_newton.hpp>
#include <delassus/steppers/newton_midpoint.hpp>

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

/// J0(x) = Σ (−x²/4)^k / k!², of a hanging chain's first way to swing.
double bessel_j0(double x) {
  double sum = 0, term = 1;
  for (int k = 1; k < 60; ++k) sum += term, term *= -0.25 * x * x / (k * k);
  return sum;
}

}  // namespace

// A chain that hangs swings by a thousandth of its length in its first mode, J0(j √(z/L)) at a height z above
// its end, ω = j/2 √(g/L), j = 2.404826: the limit of ever more links. A quarter of a period is run, and what
// a step takes must grow as the links do. Source: D. Bernoulli's hanging chain.
void hanging_chain(Ladder& ladder) {
  double of_first = 0;
  for (const int links : {40, 100, 400, 1000})
    ladder.rung(format("%d links", links), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, NewtonMidpoint{}};
      auto& set = bodies<RigidBodies>(loop.world());
      const double j = 2.404825557695773, length = links,
                   quarter = 0.5 * M_PI / (0.5 * j * std::sqrt(g / length));
      const auto place = [&](double down) {
        const double x = 1e-3 * length * bessel_j0(j * std::sqrt(1 - down / length));
        return Vec3(x, 0, -down);
      };
      RigidBodies::Handle last;
      const Mat3 inertia = Vec3(1. / 12, 1. / 12, 0.01).asDiagonal();
      Vec3 from = place(0);
      for (int k = 0; k < links; ++k) {
        // Each link is as long as it is: its joints lie on the curve up to what the slope shortens, 1e-6.
        const Vec3 along = (place(k + 1) - from).normalized(), to = from + along;
        const auto link = set.add({.position = 0.5 * (from + to),
                                   .orientation = Quat::FromTwoVectors(Vec3(0, 0, -1), along),
                                   .mass = 1.0,
                                   .inertia = inertia});
        loop.add(BallJoint::Item{k ? anchor(set, last, {0, 0, -0.5}) : world_anchor(from),
                                 anchor(set, link, {0, 0, 0.5})});
        last = link, from = to;
      }
      double before = set.position(last).x(), passed = 0;
      const double until = ladder.is_quick() ? 0.5 : 1.05 * quarter;
      const std::clock_t start = std::clock();
      const Seen seen = run(ladder, loop, until, frame, [&](int n) {
        const double now = set.position(last).x();
        if (before > 0 && now <= 0) passed = (n + before / (before - now)) * frame;
        before = now;
      });
      const double cost = double(std::clock() - start) / double(std::lround(until / frame));
      if (links == 40) of_first = cost;
      return {
          {"period against Bernoulli's", ladder.is_quick() ? 0 : std::abs(passed / quarter - 1), 0.05, 5e-3},
          {"power of the links that a step's time grows by",
           links == 40 ? 1 : std::log(cost / of_first) / std::log(links / 40.), unbounded, 1.1},
          {"joint gap / link", seen.joint_gap, 1e-2, 1e-4},
          energy_mark(seen, 0.5 * links * g * 1e-6 * length)};
    });
}

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

// n × n small bodies in a square net, 0.5 m apart, held at two corners: it hangs in its own plane, with more
// joints than it needs, or is let go level and swings.
template <class... Policies>
void climb_grid(Ladder& ladder, const Vec3& down, const Policies&... policies) {
  for (const int n : {5, 10, 20, 40, 100})
    ladder.rung(format("%d × %d", n, n), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, policies...};
      auto& set = bodies<RigidBodies>(loop.world());
      std::vector<RigidBodies::Handle> knots;
      for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k)
          knots.push_back(set.add(
              {.position = {0.5 * k, 0, -0.5 * i}, .mass = 1.0, .inertia = Mat3(0.02 * Mat3::Identity())}));
      set.gravity = g * down;
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
  climb_grid(ladder, {0, 0, -1}, AcceleratedGaussSeidel{.tolerance = 1e-6}, WholeViolation{});
}
void joint_grid_direct(Ladder& ladder) {
  climb_grid(ladder, {0, 0, -1}, DirectGaussSeidel{}, WholeViolation{});
}
void joint_grid_level(Ladder& ladder) {
  climb_grid(ladder, {0, -1, 0}, DirectGaussSeidel{}, WholeViolation{}, Substeps{.count = 16});
}

}  // namespace ladders
