/// Deformable bodies of linear tetrahedra.
#pragma once

#include <delassus/fem/basic_fem.hpp>
#include <delassus/fem/inner/linear_tetrahedron.hpp>

namespace delassus {

/// Of tetrahedra with one deformation gradient each: any shape is meshed, but bending is too stiff.
template <ElasticMaterial M, class T = double>
using TetrahedralFem = BasicFem<inner::LinearTetrahedron, M, T>;

}  // namespace delassus
