// Scenes of limits, motors and drives on free axes, without contact; the midpoint rule, positions projected.
#include "scene.hpp"

#include <delassus/constraints/joints/drive.hpp>
#include <delassus/constraints/joints/limit.hpp>
#include <delassus/constraints/joints/motor.hpp>
#include <delassus/integrators/implicit_midpoint.hpp>
#include <delassus/stabilisation/position_projection.hpp>

using namespace delassus;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Limit<Turn>{}, Motor<Slide>{}, Drive<Turn>{}},
                     AcceleratedGaussSeidel{.tolerance = 1e-6, .max_iterations = 60}, ImplicitMidpoint{},
                     PositionProjection{}};
  const auto add = [](auto& to, auto& bytes, const Anchor& a, const Anchor& b) {
    const double one = fuzz::amount(bytes), other = fuzz::amount(bytes);
    switch (bytes.below(3)) {
      case 0:
        to.add(Limit<Turn>::Item{.a = a, .b = b, .lower = -one, .upper = other});
        break;
      case 1:
        to.add(Motor<Slide>::Item{.a = a, .b = b, .speed = one, .max_force = other});
        break;
      default:
        to.add(Drive<Turn>::Item{.a = a, .b = b, .stiffness = one, .damping = other});
    }
  };
  return fuzz::play(loop, add, data, size);
}
