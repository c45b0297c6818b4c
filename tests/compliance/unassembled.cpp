// W without its matrix, as loops have it that name DirectGaussSeidel.
#include <delassus/compliance/unassembled.hpp>

#include <delassus/bodies/anchor_at.hpp>
#include <delassus/bodies/particles.hpp>
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/constraints/joints/distance_joint.hpp>
#include <delassus/constraints/joints/hinge.hpp>
#include <delassus/constraints/joints/limit.hpp>
#include <delassus/constraints/joints/spring_damper.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/loop/animation_loop.hpp>
#include <delassus/math/rotation.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>
#include <delassus/stabilisation/position_projection.hpp>

#include "catch.hpp"
#include "worker_threads.hpp"

#include <type_traits>
#include <vector>

namespace unassembled_tests {

using namespace delassus;

namespace {

constexpr double tolerance = 1e-9;

/// Arms of four rods on hinges with springs, of which the first rods are held by one kinematic plate, above
/// the ground.
template <class... More>
auto arms(int count, More... more) {
  AnimationLoop loop{
      World{RigidBodies{}},
      Constraints{Contact{Coulomb{.friction = 0.5}}, Hinge{}, Limit<Turn>{}, SpringDamper<Turn>{}},
      DirectGaussSeidel{.tolerance = tolerance}, more...};
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(HalfSpace{});
  const auto plate = set.add({.position = {0, 0, 0.8}, .velocity = {0, 0.1, 0}, .motion = Motion::kinematic});
  const Quat axis = frame_along({0, -1, 0});
  for (int arm = 0; arm < count; ++arm) {
    Vec3 at(0, 2.0 * arm, 0.8);
    Anchor end = anchor_at(set, plate, at, axis);
    for (int k = 0; k < 4; ++k) {
      const auto rod = set.add({.position = at + Vec3(0.25, 0, 0),
                                .mass = 1.0 + k,
                                .shape = Box{0.5, 0.1, 0.1},
                                .group = 2,
                                .collides_with = 1});
      const Anchor begin = anchor_at(set, rod, at, axis);
      loop.add(Hinge::Item{end, begin});
      loop.add(Limit<Turn>::Item{.a = end, .b = begin, .lower = -0.6, .upper = 0.6});
      loop.add(SpringDamper<Turn>::Item{.a = end, .b = begin, .stiffness = 5, .damping = 0.1});
      at += Vec3(0.5, 0, 0);
      end = anchor_at(set, rod, at, axis);
    }
  }
  return loop;
}

template <class Loop>
std::vector<Vec<6>> velocities(Loop& loop, int steps) {
  std::vector<Vec<6>> out;
  auto& set = bodies<RigidBodies>(loop.world());
  for (int n = 0; n < steps; ++n) {
    REQUIRE(loop.step(5e-3).status == Status::converged);
    for (const Index b : set.active()) out.push_back(set.velocity()[b]);
  }
  return out;
}

template <class Loop>
using ComplianceOf =
    typename std::remove_cvref_t<decltype(std::declval<Loop&>().data())>::Policies::Compliance;

}  // namespace

TEST_CASE("a loop with DirectGaussSeidel that names no compliance has no matrix") {
  using Usual = decltype(arms(1));
  using Named = decltype(arms(1, AssembledCompliance{}));
  STATIC_REQUIRE(std::is_same_v<ComplianceOf<Usual>, UnassembledCompliance>);
  STATIC_REQUIRE(std::is_same_v<ComplianceOf<Named>, AssembledCompliance>);
}

// The same equations, solved to 1e-9 of the velocities at each step; until t = 1 s the arms hit their stops
// and the ground, and no error grows more than a thousandfold.
TEST_CASE("without the matrix of W a machine moves as with it") {
  auto one = arms(2);
  auto other = arms(2, AssembledCompliance{});
  const auto u = velocities(one, 200), v = velocities(other, 200);
  REQUIRE(one.contacts().size() > 0);
  double most = 0, apart = 0;
  for (std::size_t k = 0; k < u.size(); ++k)
    most = std::max(most, norm(v[k])), apart = std::max(apart, norm(Vec<6>(u[k] - v[k])));
  CHECK(most > 1);
  CHECK(apart <= 1e3 * tolerance * most);
}

TEST_CASE("a problem that is taken out of a loop without a matrix has it") {
  auto one = arms(2);
  auto other = arms(2, AssembledCompliance{});
  velocities(one, 1), velocities(other, 1);
  const auto p = one.problem();
  const auto q = other.problem();
  for_each_index<4>([&](auto a) {
    for (Index i = 0; i < p.rows.template pool<a>().items(); ++i)
      REQUIRE(p.W.template diagonal<a>(i) == q.W.template diagonal<a>(i));
    for_each_index<4>([&](auto b) {
      const auto mine = p.W.template blocks<a, b>(), theirs = q.W.template blocks<a, b>();
      REQUIRE(mine.start == theirs.start);
      REQUIRE(mine.column == theirs.column);
      for (std::size_t e = 0; e < theirs.column.size(); ++e) REQUIRE(mine.block[e] == theirs.block[e]);
    });
  });
  CHECK(p.W.template blocks<1, 1>().column.size() > 0);
}

TEST_CASE("W says the same of its rows with the matrix and without") {
  auto loop = arms(2);
  velocities(loop, 20);
  auto& data = loop.data();
  const auto p = loop.problem();
  data.W.reset(data.rows);
  for_each_index<4>([&](auto a) {
    for (Index i = 0; i < p.rows.template pool<a>().items(); ++i) {
      const auto u = data.W.template residual<a>(data.rows, i), v = p.W.template residual<a>(p.rows, i);
      // Sums of some ten products of impulses below 1 N·s with W below 1e3/kg.
      CHECK((u - v).norm() <= 1e-12 * (1 + p.rows.template pool<a>().d[i].norm()));
    }
  });
}

TEST_CASE("islands that share a kinematic body have the same bits on several workers") {
  auto one = arms(3, WorkerThreads{{}, 1}), three = arms(3, WorkerThreads{{}, 3});
  const auto u = velocities(one, 100), v = velocities(three, 100);
  REQUIRE(one.report().islands == 3);
  CHECK(u == v);
}

// The projection solves for displacements by the same W. What a constraint of the step misses is asked
// afterwards.
TEST_CASE("what constraints miss is that of the step after a position projection") {
  auto loop = arms(1, PositionProjection{});
  velocities(loop, 20);
  double most = 0, speed = 0;
  for (const Vec<6>& v : velocities(loop, 1)) speed = std::max(speed, norm(v));
  loop.each_constraint([&](int, Index, const auto&, double error, double) { most = std::max(most, error); });
  CHECK(most <= 1e-6 * speed);
}

TEST_CASE("where springs couple A the direct path's W is a matrix") {
  const auto path = [](auto... compliance) {
    AnimationLoop loop{World{Particles{}}, Constraints{DistanceJoint{}}, ImplicitEuler{}, DirectGaussSeidel{},
                       compliance...};
    auto& set = bodies<Particles>(loop.world());
    std::vector<Particles::Handle> p;
    for (int i = 0; i < 8; ++i) p.push_back(set.add({.position = {0.2 * i, 0, 0}, .mass = 0.1}));
    for (int i = 0; i + 1 < 8; ++i) set.add_spring(p[i], p[i + 1], 50, 0.5, 0.2);
    loop.add(DistanceJoint::Item{anchor(set, p[0]), world_anchor({0, 0, 0.5}), 0.5});
    loop.add(DistanceJoint::Item{anchor(set, p[7]), world_anchor({1.4, 0, 0.5}), 0.5});
    for (int n = 0; n < 50; ++n) loop.step(0.01);
    return set.position(p[4]);
  };
  const Vec3 x = path();
  CHECK(x[2] < -0.01);
  CHECK(x == path(AssembledCompliance{}));
}

}  // namespace unassembled_tests
