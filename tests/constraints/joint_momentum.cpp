// Impulses between bodies come in pairs at one point: no solver, however far from done, may change P or L.
#include <delassus/delassus.hpp>

#include <random>
#include <vector>

#include "catch.hpp"
#include "stages.hpp"

namespace joint_momentum_tests {

using namespace delassus;

namespace {

struct Momenta {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
  double linear_scale = 0, angular_scale = 0;

  void add(const Vec3& x, const Vec3& p, const Vec3& spin) {
    linear += p;
    angular += x.cross(p) + spin;
    linear_scale += p.norm();
    angular_scale += x.cross(p).norm() + spin.norm();
  }
};

/// P and L of the velocities that `member` picks, at the present positions.
template <class World, class Member>
Momenta momenta(const World& world, const Member& member) {
  Momenta sum;
  world.each([&](const auto& set, auto) {
    const auto& v = member(set);
    for (const Index b : set.active()) {
      const Pose pose = set.pose(b);
      const Vec3 p = set.mass(b) * v[b].template head<3>();
      Vec3 spin = Vec3::Zero();
      if constexpr (requires { set.inertia(b); })
        spin = pose.rotation * (set.inertia(b) * (pose.rotation.transpose() * v[b].template tail<3>()));
      sum.add(pose.position, p, spin);
    }
  });
  return sum;
}

/// Rigid bodies and particles at random, joined in a ring and across it, some joints far from closed.
template <class Solver, class Integrator>
auto ring(unsigned seed, Solver solver, Integrator integrator) {
  AnimationLoop loop{World{RigidBodies{}, Particles{}}, Constraints{BallJoint{}, DistanceJoint{}}, solver,
                     integrator};
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> draw(-1, 1);
  // One after the other: arguments of a function are drawn in an order that compilers choose.
  const auto vector = [&] {
    Vec3 v;
    for (double& x : v) x = draw(random);
    return v;
  };
  auto& rigid = bodies<RigidBodies>(loop.world());
  auto& points = bodies<Particles>(loop.world());
  rigid.gravity.setZero();
  points.gravity.setZero();
  std::vector<Anchor> ends;
  for (int i = 0; i < 6; ++i) {
    Quat turn;
    for (double& x : turn.coeffs()) x = draw(random);
    turn.normalize();
    const auto body = rigid.add({.position = 3 * vector(),
                                 .orientation = turn,
                                 .velocity = vector(),
                                 .angular_velocity = 3 * vector(),
                                 .mass = 1.5 + draw(random),
                                 .shape = Box{1, 0.5, 2}});
    ends.push_back(anchor(rigid, body, vector()));
    const auto point =
        points.add({.position = 3 * vector(), .velocity = vector(), .mass = 1.5 + draw(random)});
    ends.push_back(anchor(points, point));
  }
  // Ball joints between rigid bodies and to particles; distance joints between all.
  const int n = int(ends.size());
  for (int i = 0; i < n; ++i) {
    loop.add(BallJoint::Item{ends[i], ends[(i + 1) % n]});
    if (i % 4 == 0) loop.add(BallJoint::Item{ends[i], ends[(i + 2) % n]});
    loop.add(DistanceJoint::Item{ends[i], ends[(i + 5) % n], 1.0});
    loop.add(DistanceJoint::Item{ends[i], ends[(i + 3) % n], 1.0, 50.0, 1.0});
  }
  return loop;
}

template <class Solver, class Integrator>
void check_momentum(Solver solver, Integrator integrator) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    auto loop = ring(seed, solver, integrator);
    solve_by_stages(loop, 0.01);
    const auto before = momenta(
        loop.world(), [](const auto& set) -> const auto& { return set.v_free; });
    const auto after = momenta(
        loop.world(), [](const auto& set) -> const auto& { return set.v_next; });
    CAPTURE(seed, loop.report().sweeps);
    CHECK((after.linear - before.linear).norm() <= 1e-13 * after.linear_scale);
    CHECK((after.angular - before.angular).norm() <= 1e-13 * after.angular_scale);
  }
}

}  // namespace

// 12 bodies, 36 joints: each impulse is rounded once per end, 72 · 2^-53 ~ 8e-15 of the sums of magnitudes.
TEST_CASE("joints keep momentum and angular momentum, after any number of sweeps") {
  for (const int sweeps : {1, 2, 7, 100})
    check_momentum(GaussSeidel{.tolerance = 0, .max_iterations = sweeps}, SymplecticEuler{});
}

TEST_CASE("joints keep momentum and angular momentum when the accelerated sweeps are cut short") {
  for (const int sweeps : {1, 2, 7, 100})
    check_momentum(AcceleratedGaussSeidel{.tolerance = 0, .max_iterations = sweeps}, SymplecticEuler{});
}

namespace {

/// The largest drifts over a second of steps, relative to the largest sums of magnitudes.
std::pair<double, double> drift(int sweeps) {
  auto loop = ring(2, GaussSeidel{.tolerance = 0, .max_iterations = sweeps}, SymplecticEuler{});
  const auto now = [&] {
    return momenta(
        loop.world(), [](const auto& set) -> const auto& { return set.velocity(); });
  };
  const Momenta start = now();
  double linear = 0, angular = 0, linear_scale = 0, angular_scale = 0;
  for (int n = 0; n < 100; ++n) {
    loop.step(0.01);
    const Momenta m = now();
    linear_scale = std::max(linear_scale, m.linear_scale);
    angular_scale = std::max(angular_scale, m.angular_scale);
    linear = std::max(linear, (m.linear - start.linear).norm() / linear_scale);
    angular = std::max(angular, (m.angular - start.angular).norm() / angular_scale);
  }
  return {linear, angular};
}

}  // namespace

// 100 steps of the bound above, and of moving x along p, which keeps x × p. The ring is one that two sweeps a step do
// not throw apart: at 1e12 rad/s a rotation's Newton iteration has no digits left.
TEST_CASE("bodies in a ring of joints keep momentum and angular momentum for a second of unfinished solves") {
  for (const int sweeps : {2, 5, 10}) {
    const auto [linear, angular] = drift(sweeps);
    CHECK(linear <= 1e-12);
    CHECK(angular <= 1e-12);
  }
}

}  // namespace joint_momentum_tests
