#include "allocations/count_allocations.hpp"

#include "catch.hpp"
#include "model/random_tree.hpp"

using namespace delassus;

TEST_CASE("no question to a joint space allocates") {
  const Model m = random_tree(1);
  JointSpace space(m);
  Dice dice{std::mt19937(2)};
  std::vector<double> q = random_q(space, dice, 1), v = random_numbers(dice, space.v_size(), 1), a = v,
                      tau = v;
  std::vector<double> H(v.size() * v.size());
  std::vector<Pose> poses(m.bodies.size());
  std::vector<Vec<6>> velocities(m.bodies.size()), J(v.size());
  const long before = allocations;
  space.poses(q, poses);
  space.velocities(q, v, velocities);
  space.jacobian(q, Index(m.bodies.size()) - 1, zero<Vec3>(), J);
  space.inverse_dynamics(q, v, a, tau);
  space.forward_dynamics(q, v, tau, a);
  space.gravity_compensation(q, tau);
  space.mass_matrix(q, H);
  space.kinetic_energy(q, v);
  space.potential_energy(q);
  space.advance(q, v);
  space.poses(q, poses);
  for (std::size_t b = 0; b < poses.size(); ++b) {
    const Pose parent = m.bodies[b].parent < 0 ? Pose{} : poses[std::size_t(m.bodies[b].parent)];
    space.read_q(Index(b), parent, poses[b], q);
    space.read_v(Index(b), q, parent, poses[b], zero<Vec<6>>(), velocities[b], v);
  }
  CHECK(allocations == before);
}
