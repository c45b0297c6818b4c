/// Whether a description is sound: every index names something, every number will do, parents come first.
#pragma once

#include <delassus/model/inner/check_forces.hpp>
#include <delassus/model/inner/check_shapes.hpp>
#include <delassus/model/inner/check_tree.hpp>

namespace delassus {

/// Refuses (InvalidArgument) what no loop could take, in one sentence that names the model and the element:
///
/// - indices out of their lists, parents that stand after their bodies, joints of no body or of two
/// - numbers that are not finite or beyond 1e50, negative ones where there can be none, limits the wrong way
/// round
/// - axes that are no unit vectors, rotations that are no rotations, an inertia that is not symmetric
/// - bodies that a joint moves and that have no mass, neither they nor what is fixed to them
/// - two elements of a kind with one name
///
/// Whether an inertia belongs to a distribution of mass is asked where a body is added to a loop. Readers
/// call this at their end.
inline void check(const Model& model) {
  DELASSUS_EXPECT(inner::is_sane(model.gravity),
                  "model '" + model.name + "': gravity must be finite, and 1e50 m/s² at most");
  DELASSUS_EXPECT(
      inner::is_sane(model.time_step) && model.time_step >= 0,
      "model '" + model.name + "': its time step is " + inner::text(model.time_step) + " s and must be >= 0");
  inner::check_joints(model);
  inner::check_owners(model);
  inner::check_bodies(model);
  inner::check_surfaces(model);
  inner::check_geometries(model);
  inner::check_couplings(model);
  inner::check_tendons(model);
  inner::check_actuators(model);
  inner::check_keyframes(model);
}

}  // namespace delassus
