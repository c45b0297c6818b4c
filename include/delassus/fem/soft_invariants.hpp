/// Energy and momentum of deformable bodies.
#pragma once

#include <delassus/bodies/inner/point_invariants.hpp>
#include <delassus/fem/basic_fem.hpp>
