// Actuators of a description: a servo lifts an arm against its weight.
// prints: asked for 0\.500 rad, at 0\.[0-9]+ rad with -?[0-9.]+ N m
#include <delassus/delassus.hpp>
#include <delassus/model/actuators.hpp>
#include <delassus/model/add.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

#include <cstdio>

using namespace delassus;

int main() {
  Model arm{.name = "arm"};  // or read_mjcf("arm.xml")
  arm.joints.push_back({.name = "hinge", .axis = {0, 1, 0}});
  arm.bodies.push_back({.name = "link", .mass = 2, .centre = {0.5, 0, 0}, .inertia = Mat3(Vec3(0.01, 0.2, 0.2).asDiagonal()), .joints = {0}});
  arm.actuators.push_back({.name = "elbow", .target = 0, .gain = 200, .bias = {0, -200, -20}});  // 200 (control - q) - 20 rate

  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, SpringDamper<Turn>{}}, DirectGaussSeidel{.tolerance = 1e-9}};
  Machine machine = add(loop, arm);
  set_control(machine, "elbow", 0.5);
  for (int n = 0; n < 2000; ++n) {
    actuate(loop, machine, 1e-3);
    loop.step(1e-3);
  }
  std::printf("asked for 0.500 rad, at %.4f rad with %.3f N m\n", position_of(loop.world(), machine, 0), actuator_force(loop.world(), machine, 0));
}
