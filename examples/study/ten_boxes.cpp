// Ten boxes stand on each other, each a little off centre. They stand well: whatever moves is an error.
#include "scene_study.hpp"

#include "../demonstration/stack_of_boxes.hpp"

#include <delassus/delassus.hpp>

namespace study_program {

bool ten_boxes(const Options& options) {
  const auto scene = [](auto... policies) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.6}}}, policies...};
    demonstration::add_stack_of_boxes(bodies<RigidBodies>(loop.world()));
    return loop;
  };
  const auto top = [](const auto& loop) { return loop.world().template set<0>().pose(10).position; };
  RigidBodies at_rest;
  demonstration::add_stack_of_boxes(at_rest);
  const Vec3 start = at_rest.pose(10).position;
  return run_study(options, "ten_boxes", 1e-3, scene,
                   Combinations{Choices{Baumgarte{}, SoftContact{}, PositionProjection{}},
                                Choices{AcceleratedGaussSeidel{}, GaussSeidel{}},
                                Choices{AssembledCompliance{}, MatrixFreeCompliance{}}},
                   {.name = "Stack of ten boxes",
                    .duration = 1,
                    .steps = {1. / 30, 1. / 60, 1. / 120},
                    .tolerances = {1e-1, 1e-2, 1e-3, 1e-4, 1e-6},
                    .outputs = 10,
                    .repeats = 3},
                   Measures{Compared{"place of the top box", "m", top, [start](double) { return start; }},
                            penetration(), energy_change(), solver_residual()});
}

}  // namespace study_program
