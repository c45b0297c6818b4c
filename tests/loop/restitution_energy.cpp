#include "scenes.hpp"

#include "catch.hpp"
#include "stages.hpp"

namespace restitution_energy_tests {

using namespace scenes;

namespace {

/// ½ v·A v of velocities that are not yet the bodies' own.
template <class Set>
double energy(const Set& set, std::span<const typename Set::Velocity> v) {
  double sum = 0;
  for (Index b = 0; b < set.blocks(); ++b) {
    if (!set.moves(b)) continue;
    const Vec3 rate = set.pose(b).rotation.transpose() * v[b].template tail<3>();
    sum += 0.5 * set.mass(b) * v[b].template head<3>().squaredNorm() + 0.5 * rate.dot(set.inertia(b) * rate);
  }
  return sum;
}

struct Impact {
  double before, after;
  Status status;
};

/// One step of a random cluster without gravity and without overlap: v⁻ is the start, v⁺ = v_next.
template <class Solver>
Impact impact(unsigned seed, double restitution, double friction, Solver solver) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Coulomb{.friction = friction}, restitution}}},
                     GivenContacts{}, solver};
  auto& set = rigid_bodies(loop);
  const int bodies = 2 + int(seed % 7);
  loop.template get<GivenContacts>().points = add_cluster(set, bodies, bodies + int(seed % 11), seed, 0, seed % 2 == 0);
  solve_by_stages(loop, 0.01);
  return {energy(set, set.velocity()), energy(set, set.v_next), loop.report().status};
}

}  // namespace

// T⁺ − T⁻ = λ·(u⁻ + u⁺)/2. The guard bounds what restitution adds, and the rest is ≤ 0 up to the rounding of two sums:
// 1e-12 of T⁻. Sweeps that ran out leave impulses up to a hundred times too large, whose squares round 1e-9 of T⁻ off.
TEST_CASE("no impact adds energy: a thousand random problems, friction to 2, restitution to 1, any number of sweeps") {
  double largest = 0;
  int lossless = 0;
  for (unsigned seed = 1; seed <= 1000; ++seed) {
    const double friction = (seed % 21) * 0.1, restitution = seed % 3 == 0 ? 1.0 : (seed % 10) * 0.1;
    const int sweeps = seed % 5 == 0 ? 1 : seed % 5 == 1 ? 7 : 200;
    const Impact i = impact(seed, restitution, friction,
                            AcceleratedGaussSeidel{.tolerance = 1e-8, .max_iterations = sweeps});
    CAPTURE(seed, friction, restitution, sweeps, name(i.status));
    largest = std::max(largest, i.after / i.before - 1);
    lossless += i.after > 0.999 * i.before;
    CHECK(i.after <= i.before * (1 + (i.status == Status::converged ? 1e-12 : 1e-9)));
  }
  REQUIRE(lossless < 900);  // the problems do something
}

}  // namespace restitution_energy_tests
