// An arm of two links in the numbers of its joints: where its hand is, how it moves, and the torques for that.
// prints: hand at \(1\.88, 0\.00, 0\.48\), moves up at 1\.88 m/s, held by -17\.82 and -4\.91 N·m, lifted by -20\.20 N·m; -1\.00 rad/s² again
#include <delassus/model/joint_space.hpp>

#include <cstdio>
#include <vector>

using namespace delassus;

int main() {
  Model arm{.name = "arm"};
  for (const Index b : {0, 1}) {
    arm.bodies.push_back({.name = b == 0 ? "upper" : "lower", .parent = b - 1, .mass = 1, .centre = {0.5, 0, 0}, .joints = {b}});
    arm.joints.push_back({.name = b == 0 ? "shoulder" : "elbow", .axis = {0, 1, 0}});  // turns z to x: down for an arm along x
  }
  arm.bodies[1].pose.position = {1, 0, 0};

  JointSpace space(arm);
  const std::size_t bodies = arm.bodies.size(), n = std::size_t(space.v_size());
  std::vector<double> q(std::size_t(space.q_size())), v(n), a(n), tau(n);
  space.reference(q);
  q[0] = -0.5, q[1] = 0.5;  // in the order of arm.joints; space.q_of(joint) says where those of a joint begin
  v[0] = -1;

  std::vector<Pose> poses(bodies);
  std::vector<Vec<6>> J(n);
  const Vec3 hand{1, 0, 0};  // in the frame of body 1
  space.poses(q, poses);
  space.jacobian(q, 1, hand, J);
  const Vec<6> motion = J[0] * v[0] + J[1] * v[1];  // linear, then angular
  const Vec3 at = poses[1].to_world(hand);
  std::printf("hand at (%.2f, %.2f, %.2f), moves up at %.2f m/s, ", at[0], at[1], at[2], motion[2]);

  space.gravity_compensation(q, tau);
  std::printf("held by %.2f and %.2f N·m, ", tau[0], tau[1]);
  a[0] = -1;
  space.inverse_dynamics(q, v, a, tau);  // the torques that give this acceleration
  std::printf("lifted by %.2f N·m; ", tau[0]);
  space.forward_dynamics(q, v, tau, a);  // and back
  std::printf("%.2f rad/s² again\n", a[0]);
}
