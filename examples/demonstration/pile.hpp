/// The pile for any collision backend.
#pragma once

#include "measure.hpp"
#include "pile_of_shapes.hpp"

namespace demonstration {

template <class Collision>
Scene drop_pile(Collision collision, const std::string& backend, bool is_quick, const Watch& watch) {
  const double h = 1.0 / 240, seconds = is_quick ? 0.25 : 6;
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Contact{Coulomb{.friction = 0.4}}},
                     std::move(collision),
                     AcceleratedGaussSeidel{.tolerance = 1e-4},
                     StepTime{},
                     Stopwatch{},
                     Recorder{"Pile of 200",
                              "Spheres, boxes, capsules, cylinders and convex hulls, dropped into a box "
                              "of half-spaces; collision detection: " +
                                  backend + "."}};
  add_pile_of_shapes(bodies<RigidBodies>(loop.world()));
  Scene scene = measure(loop, backend, h, seconds, watch);
  for (RecordedBody& body : scene.recording.bodies)
    if (!body.is_static) body.colour = int(body.shape.kind) % 8;

  // Between the corners of the octagon that stands for a cylinder's rim, the rim may sink in unseen by 11 mm.
  scene.expect_below(1e3 * scene.max_penetration, 25, "the largest penetration", "mm");
  scene.expect_below(scene.energy_rise(), 1, "the largest rise of the energy", "J");
  if (!is_quick) scene.expect_below(scene.kinetic_energy, 1, "the kinetic energy at the end", "J");
  return scene;
}

}  // namespace demonstration
