/// Inverse dynamics and forward dynamics of its forces; poses and velocities, and the q and v that are read
/// of them.
#pragma once

#include "model/random_tree.hpp"

namespace delassus {

struct ThereAndBack {
  double acceleration = 0;  ///< what is lost of it, over its size
  double q = 0, v = 0, gap = 0;
};

/// The worst of ten random states, up to `turn` (m, rad) from the reference.
inline ThereAndBack there_and_back(const Model& m, double turn, Base base = Base::as_file) {
  JointSpace space(m, base);
  Dice dice{std::mt19937(1)};
  ThereAndBack worst;
  std::vector<double> reference(std::size_t(space.q_size()));
  space.reference(reference);
  for (int k = 0; k < 10; ++k) {
    const std::vector<double> q = random_q(space, dice, turn), v = random_numbers(dice, space.v_size(), 3),
                              a = random_numbers(dice, space.v_size(), 10);
    std::vector<double> tau(a.size()), back(a.size());
    space.inverse_dynamics(q, v, a, tau);
    space.forward_dynamics(q, v, tau, back);
    worst.acceleration = std::max(worst.acceleration, difference(back, a) / std::max(1.0, largest(a)));

    std::vector<Pose> poses(m.bodies.size());
    std::vector<Vec<6>> velocities(m.bodies.size());
    space.poses(q, poses);
    space.velocities(q, v, velocities);
    std::vector<double> q_read = reference, v_read(v.size());
    for (std::size_t b = 0; b < poses.size(); ++b) {
      const Index parent = m.bodies[b].parent;
      const Pose above = parent < 0 ? Pose{} : poses[std::size_t(parent)];
      const JointGap gap = space.read_q(Index(b), above, poses[b], q_read);
      worst.gap = std::max({worst.gap, gap.distance, gap.angle});
      space.read_v(Index(b), q_read, above, poses[b],
                   parent < 0 ? zero<Vec<6>>() : velocities[std::size_t(parent)], velocities[b], v_read);
    }
    worst.q = std::max(worst.q, difference(q_read, q));
    worst.v = std::max(worst.v, difference(v_read, v));
  }
  return worst;
}

}  // namespace delassus
