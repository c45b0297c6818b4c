/// Deformable bodies of hexahedra that bend and keep their volume without locking.
#pragma once

#include <delassus/fem/basic_fem.hpp>
#include <delassus/fem/inner/incompatible_hexahedron.hpp>

namespace delassus {

/// Of hexahedra with incompatible modes. The material acts on the mean deformation of each; bending and
/// twisting within an element follow Hooke's law in its turned axes.
template <ElasticMaterial M, class T = double>
using HexahedralFem = BasicFem<inner::IncompatibleHexahedron, M, T>;

}  // namespace delassus
