// Eight links of a kilogram carry fifty: pulled aside and let go. No formula knows where it swings, so finer
// runs must.
#include "scene_study.hpp"

#include <delassus/delassus.hpp>

#include <cmath>

namespace study_program {

bool heavy_chain(const Options& options) {
  const auto scene = [](auto... policies) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, policies...};
    auto& rigid = bodies<RigidBodies>(loop.world());
    const double length = 0.25, angle = 0.5;
    const Vec3 along(std::sin(angle), 0, -std::cos(angle));
    const Quat turned(Eigen::AngleAxisd(-angle, Vec3::UnitY()));
    Anchor end = world_anchor({0, 0, 0});
    for (int k = 0; k < 8; ++k) {
      const auto link = rigid.add({.position = length * (k + 0.5) * along,
                                   .orientation = turned,
                                   .mass = 1.0,
                                   .shape = Capsule{0.04, 0.17}});
      loop.add(BallJoint::Item{end, anchor(rigid, link, {0, 0, length / 2})});
      end = anchor(rigid, link, {0, 0, -length / 2});
    }
    const auto weight = rigid.add(
        {.position = (8 * length + 0.2) * along, .orientation = turned, .mass = 50.0, .shape = Sphere{0.2}});
    loop.add(BallJoint::Item{end, anchor(rigid, weight, {0, 0, 0.2})});
    return loop;
  };
  const auto weight = [](const auto& loop) { return loop.world().template set<0>().pose(8).position; };
  const AcceleratedGaussSeidel exact_solver{.tolerance = 1e-9, .max_iterations = 20000};
  return run_study(options, "heavy_chain", 1e-3, scene,
                   Combinations{Choices{SymplecticEuler{}, ImplicitMidpoint{}},
                                Choices{Baumgarte{}, PositionProjection{.rate = 1}},
                                Choices{AcceleratedGaussSeidel{}, GaussSeidel{}}},
                   {.name = "Heavy chain",
                    .duration = 1,
                    .steps = {0.01, 0.005, 0.002, 0.001, 0.0005},
                    .tolerances = {1e-2, 1e-4, 1e-6},
                    .outputs = 10,
                    .repeats = 3},
                   Measures{Compared{"place of the weight", "m", weight}, energy_change(), joint_drift()},
                   References{refined(options.is_quick ? 1 : 5, ImplicitMidpoint{},
                                      PositionProjection{.rate = 1}, exact_solver),
                              refined(options.is_quick ? 1 : 10, SymplecticEuler{},
                                      PositionProjection{.rate = 1}, exact_solver)});
}

}  // namespace study_program
