// Random trees of all kinds of joints: what must hold between the answers of a joint space.
#include "catch.hpp"
#include "model/random_tree.hpp"

namespace model_joint_space_trees_tests {

using namespace delassus;

namespace {

constexpr int seeds = 20;

struct State {
  std::vector<double> q, v, a;
};

State random_state(const JointSpace& space, Dice& dice) {
  return {random_q(space, dice, 1), random_numbers(dice, space.v_size(), 2),
          random_numbers(dice, space.v_size(), 10)};
}

std::vector<double> scaled(const std::vector<double>& x, double by) {
  std::vector<double> y = x;
  for (double& number : y) number *= by;
  return y;
}

std::vector<Pose> poses_of(JointSpace& space, const Model& m, const std::vector<double>& q) {
  std::vector<Pose> poses(m.bodies.size());
  space.poses(q, poses);
  return poses;
}

/// What leads from a pose to another: of the origin and the turn, along the world's axes.
Vec<6> between(const Pose& a, const Pose& b) {
  return twist<double>(b.position - a.position, logarithm(Quat(times_transposed(b.rotation, a.rotation))));
}

}  // namespace

TEST_CASE("velocities are the rates of poses") {
  for (unsigned seed = 0; seed < seeds; ++seed) {
    const Model m = random_tree(seed);
    Dice dice{std::mt19937(100 + seed)};
    JointSpace space(m, Base::as_file, dice.pose(1));
    const State s = random_state(space, dice);
    const double h = 1e-5;
    std::vector<double> before = s.q, after = s.q;
    space.advance(before, scaled(s.v, -h));
    space.advance(after, scaled(s.v, h));
    const std::vector<Pose> earlier = poses_of(space, m, before), later = poses_of(space, m, after);
    std::vector<Vec<6>> velocities(m.bodies.size());
    space.velocities(s.q, s.v, velocities);
    for (std::size_t b = 0; b < m.bodies.size();
         ++b)  // the third derivative is of the order of |v|³ times lengths
      CHECK(norm(Vec<6>(between(earlier[b], later[b]) / (2 * h) - velocities[b])) <= 1e-6);
  }
}

TEST_CASE("a Jacobian times the rates is the velocity of its point") {
  for (unsigned seed = 0; seed < seeds; ++seed) {
    const Model m = random_tree(seed);
    JointSpace space(m);
    Dice dice{std::mt19937(200 + seed)};
    const State s = random_state(space, dice);
    std::vector<Vec<6>> velocities(m.bodies.size()), J(std::size_t(space.v_size()));
    space.velocities(s.q, s.v, velocities);
    const std::vector<Pose> poses = poses_of(space, m, s.q);
    for (std::size_t b = 0; b < m.bodies.size(); ++b) {
      const Vec3 point = dice.vector(1);
      space.jacobian(s.q, Index(b), point, J);
      Vec<6> of_point = zero<Vec<6>>();
      for (std::size_t k = 0; k < J.size(); ++k) of_point += J[k] * s.v[k];
      const Vec3 w = angular_part(velocities[b]);
      const Vec<6> expected =
          twist<double>(linear_part(velocities[b]) + cross(w, poses[b].rotation * point), w);
      CHECK(norm(Vec<6>(of_point - expected)) <= 1e-12 * (1 + norm(expected)));
    }
  }
}

TEST_CASE("forward dynamics of inverse dynamics gives the acceleration back") {
  for (unsigned seed = 0; seed < seeds; ++seed) {
    JointSpace space(random_tree(seed, 30));
    Dice dice{std::mt19937(300 + seed)};
    for (int k = 0; k < 5; ++k) {
      const State s = random_state(space, dice);
      std::vector<double> tau(s.a.size()), again(s.a.size());
      space.inverse_dynamics(s.q, s.v, s.a, tau);
      space.forward_dynamics(s.q, s.v, tau, again);
      CHECK(difference(again, s.a) <= 1e-9 * largest(s.a));
    }
  }
}

TEST_CASE("the mass matrix is what inverse dynamics adds for an acceleration") {
  for (unsigned seed = 0; seed < seeds; ++seed) {
    JointSpace space(random_tree(seed));
    Dice dice{std::mt19937(400 + seed)};
    const State s = random_state(space, dice);
    const std::size_t n = s.v.size();
    std::vector<double> H(n * n), at_rest(n), tau(n), none(n);
    space.mass_matrix(s.q, H);
    space.inverse_dynamics(s.q, s.v, none, at_rest);
    space.inverse_dynamics(s.q, s.v, s.a, tau);
    double twice = 0;
    for (std::size_t i = 0; i < n; ++i) {
      double sum = at_rest[i];
      for (std::size_t j = 0; j < n; ++j) {
        sum += H[i * n + j] * s.a[j];
        twice += s.v[i] * H[i * n + j] * s.v[j];
        CHECK(H[i * n + j] == H[j * n + i]);
      }
      CHECK(std::abs(sum - tau[i]) <= 1e-11 * largest(tau));
    }
    CHECK(space.kinetic_energy(s.q, s.v) == Approx(twice / 2).epsilon(1e-12));
  }
}

TEST_CASE("the energy of a tree grows by the power of its motors") {
  for (unsigned seed = 0; seed < seeds; ++seed) {
    JointSpace space(random_tree(seed));
    Dice dice{std::mt19937(500 + seed)};
    State s = random_state(space, dice);
    for (const double share : {0.0, 1.0}) {  // without and with dampers
      const TreeForces acting{.damping = share > 0};
      const std::vector<double> tau = random_numbers(dice, space.v_size(), 5);
      space.forward_dynamics(s.q, s.v, tau, s.a, acting);
      double power = 0;
      for (std::size_t k = 0; k < tau.size(); ++k) power += (tau[k] - share * 0.3 * s.v[k]) * s.v[k];
      const auto energy = [&](double h) {  // to the third order in h
        std::vector<double> q = s.q, v = s.v, step = s.v;
        for (std::size_t k = 0; k < v.size(); ++k) {
          step[k] = h * s.v[k] + h * h / 2 * s.a[k];
          v[k] += h * s.a[k];
        }
        space.advance(q, step);
        return space.kinetic_energy(q, v, acting) + space.potential_energy(q, acting);
      };
      const double h = 1e-4 / (1 + largest(s.a));
      const double rate = (8 * (energy(h) - energy(-h)) - (energy(2 * h) - energy(-2 * h))) / (12 * h);
      // Energies of some 1000 J, rounded to 1e-13 J, over 1e-6 s.
      CHECK(std::abs(rate - power) <= 1e-6 * (1 + std::abs(power)) * (1 + largest(s.a)));
    }
  }
}

TEST_CASE("forces without weight, springs, damping, armature are those of a model that has none") {
  for (unsigned seed = 0; seed < seeds; ++seed) {
    const Model m = random_tree(seed);
    Model bare = m;
    bare.gravity = zero<Vec3>();
    for (model::Body& body : bare.bodies) body.gravity_compensation = 0;
    for (model::Joint& joint : bare.joints) joint.stiffness = joint.damping = joint.armature = 0;
    JointSpace space(m), space_of_bare(bare);
    Dice dice{std::mt19937(600 + seed)};
    const State s = random_state(space, dice);
    std::vector<double> tau(s.v.size()), tau_of_bare(s.v.size());
    space.inverse_dynamics(s.q, s.v, s.a, tau,
                           {.gravity = false,
                            .gravity_compensation = false,
                            .springs = false,
                            .damping = false,
                            .armature = false});
    space_of_bare.inverse_dynamics(s.q, s.v, s.a, tau_of_bare);
    CHECK(difference(tau, tau_of_bare) == 0);
  }
}

TEST_CASE("under its gravity compensation a tree at rest stays so") {
  for (unsigned seed = 0; seed < seeds; ++seed) {
    JointSpace space(random_tree(seed));
    Dice dice{std::mt19937(700 + seed)};
    const State s = random_state(space, dice);
    std::vector<double> tau(s.v.size()), a(s.v.size()), none(s.v.size());
    space.gravity_compensation(s.q, tau);
    space.forward_dynamics(s.q, none, tau, a);
    CHECK(largest(a) <= 1e-10);
  }
}

}  // namespace model_joint_space_trees_tests
