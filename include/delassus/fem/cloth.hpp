/// Deformable sheets: cloth, membranes, thin shells that are flat at rest.
#pragma once

#include <delassus/fem/basic_fem.hpp>
#include <delassus/fem/elasticity/plane_stress.hpp>
#include <delassus/fem/inner/sheet_triangle.hpp>

namespace delassus {

/// Of triangles with one deformation gradient each, which resist stretch by M under plane stress, and bending
/// by how their neighbours lean.
template <ElasticMaterial M, class T = double>
using Cloth = BasicFem<inner::SheetTriangle, PlaneStress<M>, T>;

}  // namespace delassus
