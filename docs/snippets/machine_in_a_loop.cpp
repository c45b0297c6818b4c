// A machine of a description in a loop: an arm of two links is held against its weight, then let go.
// prints: held at 0\.500 and 0\.200 rad, let go at -?[0-9.]+ and -?[0-9.]+ rad
#include <delassus/delassus.hpp>
#include <delassus/model/add.hpp>
#include <delassus/model/joint_state.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

#include <cstdio>
#include <string>
#include <vector>

using namespace delassus;

int main() {
  Model arm{.name = "arm"};  // or read_urdf("arm.urdf"), read_mjcf("arm.xml")
  for (int k = 0; k < 2; ++k) {
    arm.joints.push_back({.name = "hinge " + std::to_string(k), .axis = {0, 1, 0}, .damping = 0.1});
    arm.bodies.push_back({.name = "link " + std::to_string(k), .parent = Index(k - 1), .pose = {Vec3(k, 0, 0), Mat3::Identity()},
                          .mass = 2, .centre = {0.5, 0, 0}, .inertia = Mat3(Vec3(0.01, 0.2, 0.2).asDiagonal()), .joints = {Index(k)}});
  }

  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, SpringDamper<Turn>{}}, DirectGaussSeidel{.tolerance = 1e-9}};
  const Machine machine = add(loop, arm);
  for (const std::string& sentence : machine.left_out) std::puts(sentence.c_str());

  JointSpace space(arm);
  std::vector<double> q{0.5, 0.2}, v{0, 0}, tau{0, 0};
  set_joint_state(loop, machine, space, q, v);

  for (int n = 0; n < 1000; ++n) {
    for (Index j = 0; j < 2; ++j) q[std::size_t(j)] = position_of(loop.world(), machine, j);
    space.gravity_compensation(q, tau);
    for (Index j = 0; j < 2; ++j) push_joint(loop, machine, j, tau[std::size_t(j)]);
    loop.step(1e-3);
  }
  const double first = position_of(loop.world(), machine, 0), second = position_of(loop.world(), machine, 1);
  for (int n = 0; n < 500; ++n) loop.step(1e-3);
  std::printf("held at %.3f and %.3f rad, let go at %.3f and %.3f rad\n", first, second, position_of(loop.world(), machine, 0),
              position_of(loop.world(), machine, 1));
}
