/// The soft bodies of the demonstration.
#pragma once

#include <delassus/bodies/elasticity/corotational.hpp>
#include <delassus/bodies/tetrahedral_fem.hpp>

namespace demonstration {

using SoftBodies = delassus::TetrahedralFem<delassus::Corotational>;

}  // namespace demonstration
