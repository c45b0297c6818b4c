#include "scenes.hpp"

#include <delassus/compliance/uncoupled.hpp>

#include "catch.hpp"

namespace predictive_scheme_tests {

using namespace scenes;

namespace {

constexpr double h = 1.0 / 60;

/// Boxes that fall on the ground and on each other, and a chain of two that hangs beside them and is hit.
template <class Scheme>
struct Crowd {
  AnimationLoop<World<RigidBodies>, Constraints<Contact<Coulomb>, BallJoint>, Scheme, AcceleratedGaussSeidel> loop;
  std::vector<RigidBodies::Handle> bodies;
  ConstraintHandle<BallJoint> hook;

  explicit Crowd(double tolerance)
      : loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.4}}, BallJoint{}}, Scheme{},
             AcceleratedGaussSeidel{.tolerance = tolerance}} {
    auto& set = rigid_bodies(loop);
    set.add_fixed(HalfSpace{});
    for (int k = 0; k < 4; ++k)
      bodies.push_back(set.add({.position = {0.15 * k, 0.05 * k, 0.6 + 1.1 * k}, .mass = 1.0 + k, .shape = Box{1, 1, 1}}));
    bodies.push_back(set.add({.position = {1.6, 0, 2}, .mass = 2.0, .shape = Box{0.2, 0.2, 1}}));
    bodies.push_back(set.add({.position = {1.6, 0, 1}, .velocity = {-2, 0, 0}, .mass = 2.0, .shape = Box{0.2, 0.2, 1}}));
    hook = loop.add(BallJoint::Item{anchor(set, bodies[4], {0, 0, 0.5}), world_anchor({1.6, 0, 2.5})});
    loop.add(BallJoint::Item{anchor(set, bodies[5], {0, 0, 0.5}), anchor(set, bodies[4], {0, 0, -0.5})});
  }
};

/// Particles on springs of stiffness k and two rods, under implicit Euler: A couples them. The motion of the last particle.
template <class Compliance, class Scheme>
double farthest_error(int sweeps, const std::vector<Vec3>* reference, std::vector<Vec3>* path) {
  AnimationLoop loop{World{Particles{}}, Constraints{DistanceJoint{}}, ImplicitEuler{}, Compliance{}, Scheme{},
                     GaussSeidel{.tolerance = 0, .max_iterations = sweeps}};
  auto& set = loop.world().template set<0>();
  std::vector<Particles::Handle> p;
  for (int i = 0; i < 8; ++i) p.push_back(set.add({.position = {0.2 * i, 0, 0}, .mass = 0.1}));
  for (int i = 0; i + 1 < 8; ++i) set.add_spring(p[i], p[i + 1], 50, 0.5, 0.2);
  loop.add(DistanceJoint::Item{anchor(set, p[0]), world_anchor({0, 0, 0.5}), 0.5});
  loop.add(DistanceJoint::Item{anchor(set, p[7]), world_anchor({1.4, 0, 0.5}), 0.5});
  double worst = 0;
  for (int n = 0; n < 200; ++n) {
    loop.step(0.01);
    const Vec3 x = set.position(p[7]);
    if (path) path->push_back(x);
    if (reference) worst = std::max(worst, (x - (*reference)[n]).norm());
  }
  return worst;
}

}  // namespace

TEST_CASE("at rest the predicted impulses are the weight, and stay it") {
  constexpr double tolerance = 1e-10;
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}},
                     PredictiveScheme{}, AcceleratedGaussSeidel{.tolerance = tolerance}};
  auto& set = rigid_bodies(loop);
  add_stack(set, 3, Box{1, 1, 1});
  const auto hung = set.add({.position = {5, 0, 3}, .mass = 2.0, .shape = Box{1, 1, 1}});
  const auto hook = loop.add(BallJoint::Item{anchor(set, hung, {0, 0, 0.5}), world_anchor({5, 0, 3.5})});
  std::vector<Vec3> before;
  for (int n = 0; n < 300; ++n) {
    loop.step(h);
    if (n < 100) continue;
    double weight = 0, change = 0, size = 0;
    const auto contacts = loop.contacts();
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      if (contacts[i].record.point().z() < 0.1) weight += contacts[i].impulse.z();
      if (before.size() == contacts.size()) change += (contacts[i].impulse - before[i]).squaredNorm();
      size += contacts[i].impulse.squaredNorm();
    }
    REQUIRE(weight == Approx(3 * g * h).epsilon(1e-9));
    REQUIRE(loop.impulse(hook).norm() == Approx(2 * g * h).epsilon(1e-9));
    REQUIRE(loop.predicted_force(hook).norm() == Approx(2 * g).epsilon(1e-9));
    REQUIRE(std::sqrt(change) <= 1e3 * tolerance * std::sqrt(size));
    before.clear();
    for (const ContactResult& c : contacts) before.push_back(c.impulse);
  }
}

// Both solve to the tolerance, relative to velocities below 10 m/s: 60 steps differ by 60 h 10 tolerance, and contacts pass a
// difference on a few times larger. From the step on in which one of the two says that it stayed away (1e-6, when the rods wedge a
// box in), nothing is promised.
TEST_CASE("with an exact W the motion is that of the plain order") {
  constexpr double tolerance = 1e-11;
  Crowd<PlainOrder> plain(tolerance);
  Crowd<PredictiveScheme> predictive(tolerance);
  int contacts = 0, steps = 0;
  for (; steps < 60; ++steps) {
    const StepReport a = plain.loop.step(h), b = predictive.loop.step(h);
    if (std::max(a.residual, b.residual) > 2 * tolerance) break;
    contacts = std::max(contacts, a.contacts);
    for (std::size_t k = 0; k < plain.bodies.size(); ++k)
      REQUIRE((rigid_bodies(plain.loop).position(plain.bodies[k]) -
               rigid_bodies(predictive.loop).position(predictive.bodies[k])).norm() <= 1e-9);
  }
  CAPTURE(steps);
  REQUIRE(steps >= 50);
  REQUIRE(contacts >= 8);
}

TEST_CASE("a prediction needs the sweeps of a warm start, to one, and fewer than a cold start") {
  const auto stack = [](auto scheme) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, scheme,
                       AcceleratedGaussSeidel{.tolerance = 1e-7}};
    add_stack(rigid_bodies(loop), 5, Box{1, 1, 1});
    return loop;
  };
  auto plain = stack(PlainOrder{});
  auto predictive = stack(PredictiveScheme{});
  for (int n = 0; n < 120; ++n) {
    const int warm = plain.step(h).sweeps, predicted = predictive.step(h).sweeps;
    auto cold = predictive.problem();
    for (auto& x : cold.rows.pool<0>().lambda) x.setZero();
    CAPTURE(n, warm, predicted);
    REQUIRE(std::abs(predicted - warm) <= 1);
    if (n > 0) REQUIRE(predicted < solve(cold, AcceleratedGaussSeidel{.tolerance = 1e-7}).sweeps);
  }
}

TEST_CASE("the uncoupled W is that of the masses alone") {
  AnimationLoop loop{World{Particles{}}, Constraints{DistanceJoint{}}, ImplicitEuler{}, UncoupledCompliance{}};
  auto& set = loop.world().set<0>();
  const auto a = set.add({.position = {0, 0, 0}, .mass = 0.5}), b = set.add({.position = {1, 0, 0}, .mass = 2.0});
  set.add_spring(a, b, 300, 2);
  loop.add(DistanceJoint::Item{anchor(set, a), anchor(set, b), 1.0});
  loop.step(0.02);
  REQUIRE(loop.problem().W.diagonal<0>(0)(0, 0) == Approx(1 / 0.5 + 1 / 2.0).epsilon(1e-15));
}

TEST_CASE("an inexact W errs less with a prediction than without, at the same number of sweeps") {
  for (const int sweeps : {1, 4, 20}) {
    std::vector<Vec3> exact;
    farthest_error<AssembledCompliance, PlainOrder>(200, nullptr, &exact);
    const double without = farthest_error<UncoupledCompliance, PlainOrder>(sweeps, &exact, nullptr);
    const double with = farthest_error<UncoupledCompliance, PredictiveScheme>(sweeps, &exact, nullptr);
    CAPTURE(sweeps, without, with);
    REQUIRE(without < 0.1);  // m: it errs, and does not run away
    REQUIRE(3 * with <= without);
  }
}

TEST_CASE("a contact that vanishes predicts nothing: what it held falls freely at once") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, PredictiveScheme{}};
  auto& set = rigid_bodies(loop);
  const auto floor = set.add({.position = {0, 0, -0.5}, .shape = Box{4, 4, 1}, .motion = Motion::fixed});
  const auto box = set.add({.position = {0, 0, 0.5}, .mass = 3.0, .shape = Box{1, 1, 1}});
  for (int n = 0; n < 50; ++n) loop.step(h);
  REQUIRE(std::abs(set.velocity(box).norm()) <= 1e-6);
  const Vec3 before = set.velocity(box).head<3>();
  loop.remove(floor);
  for (int n = 1; n <= 10; ++n) {
    loop.step(h);
    REQUIRE((set.velocity(box).head<3>() - before - Vec3(0, 0, -g * h * n)).norm() <= 1e-15 * 10);
  }
}

TEST_CASE("soft rows are predicted as stiff ones are: the spring of a joint sags by its load") {
  AnimationLoop loop{World{Particles{}}, Constraints{DistanceJoint{}}, PredictiveScheme{}};
  auto& set = loop.world().set<0>();
  const double k = 200, m = 0.5;
  const auto a = set.add({.position = {0, 0, -1}, .mass = m});
  loop.add(DistanceJoint::Item{anchor(set, a), world_anchor({0, 0, 0}), 1.0, k, 30});
  for (int n = 0; n < 2000; ++n) loop.step(0.01);
  REQUIRE(-set.position(a).z() - 1 == Approx(m * g / k).epsilon(1e-9));
}

}  // namespace predictive_scheme_tests
