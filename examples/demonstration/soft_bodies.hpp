/// The soft bodies of the demonstration.
#pragma once

#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>

namespace demonstration {

using SoftBodies = delassus::TetrahedralFem<delassus::Corotational>;

}  // namespace demonstration
