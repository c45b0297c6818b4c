/// Deformable bodies of tetrahedra that bend.
#pragma once

#include <delassus/fem/basic_fem.hpp>
#include <delassus/fem/inner/quadratic_tetrahedron.hpp>

namespace delassus {

/// Of tetrahedra with a node on each edge and four deformation gradients each: any shape is meshed, edges may
/// be bent, and bending is as it should be. As ν goes to 0.5 they are too stiff, less than linear ones.
template <ElasticMaterial M, class T = double>
using QuadraticTetrahedralFem = BasicFem<inner::QuadraticTetrahedron, M, T>;

}  // namespace delassus
