#include "scenes.hpp"

#include "catch.hpp"
#include "stages.hpp"

#include <delassus/schemes/collisions_first.hpp>

namespace momentum_tests {

using namespace scenes;

namespace {

/// What the corrective stage changed, Σ A (v_next − v_free), against what it moved, Σ |A (v_next − v_free)|.
struct Change {
  Vec3 momentum = Vec3::Zero(), angular = Vec3::Zero();
  double momentum_size = 0, angular_size = 0;
};

template <class Set>
Change change(const Set& set) {
  Change sum;
  for (Index b = 0; b < set.blocks(); ++b) {
    if (!set.moves(b)) continue;
    const Vec<6> v = (set.v_next[b] - set.v_free[b]).template cast<double>();
    const Pose pose = set.pose(b);
    const Vec3 p = double(set.mass(b)) * v.template head<3>();
    const Vec3 orbital = pose.position.cross(p);
    const Vec3 spin = pose.rotation * (set.inertia(b) * (pose.rotation.transpose() * v.template tail<3>()));
    sum.momentum += p;
    sum.angular += orbital + spin;
    sum.momentum_size += p.norm();
    sum.angular_size += orbital.norm() + spin.norm();
  }
  return sum;
}

}  // namespace

// Equal and opposite impulses at one common point: each pair cancels to the rounding of its own two terms, and thirty pairs
// on ten bodies leave a few ulp of the sum of sizes. Witness points apart would leave gap × friction impulse, 1e-2 here.
TEST_CASE("contacts and joints keep momentum and angular momentum after any number of sweeps") {
  for (unsigned seed = 1; seed <= 20; ++seed)
    for (const int sweeps : {1, 2, 10, 100}) {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.8}}, BallJoint{}},
                         GivenContacts{}, GaussSeidel{.tolerance = 0, .max_iterations = sweeps}};
      auto& set = rigid_bodies(loop);
      loop.get<GivenContacts>().points = add_cluster(set, 10, 30, seed, seed % 2 ? 0.01 : -0.01, false);
      for (int k = 0; k < 4; ++k)
        loop.add(BallJoint::Item{anchor(set, set.handle(k), Vec3(0.1, 0.2, k)),
                                 anchor(set, set.handle(k + 5), Vec3(1, 0, 0))});
      solve_by_stages(loop, 0.01);
      const Change c = change(set);
      CAPTURE(seed, sweeps);
      REQUIRE(c.momentum_size > 0.1);
      REQUIRE(c.momentum.norm() <= 1e-13 * c.momentum_size);
      REQUIRE(c.angular.norm() <= 1e-13 * c.angular_size);
    }
}

// Three hundred steps of kicks and turns: 1e-15 of the size each, added up. Bodies that meet elsewhere than at their nearest points
// are pushed each at its own, and what this adds to the angular momentum is taken back when they touch, but for 1e-4 of their size, 1 m,
// at which they count as touching. CollisionsFirst pushes at one point always.
template <class... P>
void keep_momentum_in_a_cluster(double share, const P&... policies) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, policies...};
  auto& set = rigid_bodies(loop);
  set.gravity.setZero();
  std::mt19937 random(2);
  std::uniform_real_distribution<double> draw(-1, 1);
  double size = 0;
  for (int i = 0; i < 12; ++i) {
    const Vec3 x(1.2 * (i % 3), 1.2 * (i / 3 % 2), 1.2 * (i / 6));
    const Vec3 v = -(x - Vec3(1.2, 0.6, 0.6)) + 0.1 * Vec3{draw(random), draw(random), draw(random)};
    set.add({.position = x, .velocity = v, .mass = 1.0 + i, .shape = Box{1, 1, 1}});
    size += (1.0 + i) * v.norm();
  }
  const Vec3 p = momentum(set), l = angular_momentum(set);
  Index contacts = 0;
  for (int n = 0; n < 300; ++n) contacts = std::max(contacts, loop.step(0.01).contacts);
  REQUIRE(contacts > 20);
  REQUIRE((momentum(set) - p).norm() <= 1e-13 * size);
  REQUIRE((angular_momentum(set) - l).norm() <= share * size);
}
TEST_CASE("a cluster of bodies that collide with real geometry keeps momentum over many steps") {
  keep_momentum_in_a_cluster(1e-4);
  keep_momentum_in_a_cluster(1e-12, CollisionsFirst{});
}

}  // namespace momentum_tests
